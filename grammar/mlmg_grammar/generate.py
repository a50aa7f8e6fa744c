"""`python -m mlmg_grammar.generate --docs docs`: write all that is made from the grammar."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from mlmg_grammar import grammar_text, make
from mlmg_grammar.page import pages
from mlmg_grammar.tables import FILE, tables_text
from mlmg_grammar.textmate import as_json, language_configuration, textmate_grammar


def package_files() -> dict[str, str]:
    """Return the parser's tables and the files for editors, by their names from the folder of this package."""
    return {
        FILE: tables_text(make(), grammar_text()),
        "motion_script.tmLanguage.json": as_json(textmate_grammar()),
        "motion_script.language-configuration.json": as_json(language_configuration()),
    }


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the tables and the editors' grammars into this package, and the documentation's pages into a folder."""
    parser = argparse.ArgumentParser(prog="mlmg_grammar.generate", description=__doc__)
    parser.add_argument("--docs", type=Path, help="the folder of the documentation; without it, no pages are written")
    docs: Path | None = parser.parse_args(arguments).docs
    write(Path(__file__).parent, package_files())
    if docs is not None:
        write(docs, pages(grammar_text()))


def write(folder: Path, files: dict[str, str]) -> None:
    """Write files into a folder."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
