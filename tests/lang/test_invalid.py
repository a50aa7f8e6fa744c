"""What is said of each wrong script in invalid/, drawn exactly; rewritten with --update-golden, and then read."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import CODES
from mlmg_lang.front_end import analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.script_files import UsedFiles
from mlmg_lang.source import Source

SCRIPTS = sorted((Path(__file__).parents[1] / "invalid").glob("*.ms"))


def library_of(text: str) -> str:
    """Return the library that a script's first line names."""
    first = text.split("\n", 1)[0]
    return first.removeprefix("# library: ")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_wrong_script_is_told_what_is_wrong_with_it(
    path: Path, libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    """Files that a script uses are those in the folder `used`, which is the script's own for the time."""
    text = path.read_bytes().decode("utf-8")
    files = UsedFiles(path.name, (path.parent / "used",))
    with contextlib.chdir(path.parent / "used"):
        analysis = analyse(Source(text, path.name), libraries[library_of(text)], files=files)
    assert analysis.diagnostics
    golden(path.with_suffix(".txt"), render_full(analysis.diagnostics, analysis.source))


def test_every_code_is_shown_by_a_wrong_script() -> None:
    drawn = "".join(path.with_suffix(".txt").read_text(encoding="utf-8") for path in SCRIPTS)
    elsewhere = {"MS001", "MS006", "MS044"}  # bytes that are no text, endless mistakes, an option of a command
    assert {code for code in CODES if f"[{code}]" not in drawn} == elsewhere


def test_no_drawing_is_left_without_its_script() -> None:
    drawings = {path.stem for path in (Path(__file__).parents[1] / "invalid").glob("*.txt")}
    assert drawings == {path.stem for path in SCRIPTS}
