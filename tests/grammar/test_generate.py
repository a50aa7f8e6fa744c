"""What is made from the grammar and kept in files is what would be made now."""

from __future__ import annotations

from pathlib import Path

import pytest

import mlmg_grammar
from mlmg_grammar.generate import main, package_files, write
from mlmg_grammar.page import PICTURES, pages

PACKAGE = Path(mlmg_grammar.__file__).parent
DOCS = Path(__file__).parents[2] / "docs"
PAGES = pages(mlmg_grammar.grammar_text())


@pytest.mark.parametrize("name", package_files())
def test_a_file_of_the_package_is_made_from_the_grammar(name: str) -> None:
    assert (PACKAGE / name).read_text(encoding="utf-8") == package_files()[name], "run make grammars"


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_made_from_the_grammar(name: str) -> None:
    assert (DOCS / name).read_text(encoding="utf-8") == PAGES[name], "run make grammars"


def test_there_is_no_picture_of_a_rule_that_is_gone() -> None:
    kept = {f"{PICTURES}/{path.name}" for path in (DOCS / PICTURES).iterdir()}
    assert kept == {name for name in PAGES if name.endswith(".svg")}


def test_every_picture_is_on_the_page() -> None:
    assert all(f"]({name})" in PAGES["grammar.md"] for name in PAGES if name.endswith(".svg"))


def test_all_is_written_by_one_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written: dict[str, set[str]] = {}
    monkeypatch.setattr("mlmg_grammar.generate.write", lambda folder, files: written.update({folder.name: set(files)}))
    main(["--docs", str(tmp_path / "docs")])
    assert written == {PACKAGE.name: set(package_files()), "docs": set(PAGES)}


def test_files_are_written_into_folders_that_are_made(tmp_path: Path) -> None:
    write(tmp_path, {"a/b.txt": "c\n"})
    assert (tmp_path / "a" / "b.txt").read_bytes() == b"c\n"
