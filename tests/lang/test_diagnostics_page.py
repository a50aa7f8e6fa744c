"""docs/diagnostics.md shows what is really printed, and all codes; rewritten with --update-golden, and then read."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from mlmg_lang.commands import mlmg
from mlmg_lang.diagnostics import CODES

PAGE = Path(__file__).parents[2] / "docs" / "diagnostics.md"
CONSOLE = re.compile(r"```console\n(.*?)```", re.DOTALL)
TABLE = re.compile(r"(?<=\| code \| severity \| what it is about \|\n\| --- \| --- \| --- \|\n)(?:\|.*\|\n)*")


def session(match: re.Match[str]) -> str:
    """Return a block of commands, each with what it prints: first on standard output, then on standard error."""
    shown = []
    for command in re.findall(r"^\$ (.*)$", match[1], re.MULTILINE):
        program, *words = command.split()
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            if program == "cat":
                out.write(Path(words[0]).read_text(encoding="utf-8"))
            else:
                mlmg.main(words)
        shown.append(f"$ {command}\n{out.getvalue()}{err.getvalue()}")
    return f"```console\n{''.join(shown)}```"


def row(code: str) -> str:
    return f"| [{code}](../mlmg_lang/mlmg_lang/rules/{code}.md) | {CODES[code].severity} | {CODES[code].title} |\n"


def test_the_page_shows_what_is_printed_and_all_codes(
    golden: Callable[[Path, str], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MLMG_LIBRARY", raising=False)
    monkeypatch.chdir(tmp_path)
    Path("stroll.ms").write_text("WALK FOR 10 SEC\nTALK for 10\n", encoding="utf-8")
    page = PAGE.read_text(encoding="utf-8")
    assert len(CONSOLE.findall(page)) == 3
    golden(PAGE, TABLE.sub("".join(map(row, CODES)), CONSOLE.sub(session, page)))


def test_the_table_links_to_the_texts() -> None:
    links = re.findall(r"\]\((\.\./.*?\.md)\)", PAGE.read_text(encoding="utf-8"))
    assert len(links) == len(CODES)
    assert all((PAGE.parent / link).is_file() for link in links)
