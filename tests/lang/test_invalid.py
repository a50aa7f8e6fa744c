"""What is said of each wrong script in invalid/, drawn exactly; rewritten with --update-golden, and then read.

The first line of a script names its library. In the folder `special`, where scripts may be no text at all, it may also
name the start (`start: Idel_01`) and the one code of which the drawings are kept (`only: MS006`). Files that a script
uses are those in the folder `used`.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import CODES, Diagnostic, Severity
from mlmg_lang.front_end import analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.script_files import UsedFiles, source_from_bytes
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[1] / "invalid"
SCRIPTS = sorted([*FOLDER.glob("*.ms"), *FOLDER.glob("special/*.ms")])


def options_of(data: bytes) -> dict[str, str]:
    first = data.split(b"\n", 1)[0].decode("ascii").removeprefix("# ")
    pairs = (option.partition(": ") for option in first.split("; "))
    return {key: value for key, _, value in pairs}


def told(data: bytes, name: str, libraries: Mapping[str, Any]) -> tuple[Source, tuple[Diagnostic, ...]]:
    """Return the source of a wrong script, and what is said of it."""
    source, unreadable = source_from_bytes(data, name)
    if unreadable:
        return source, unreadable
    options, used = options_of(data), FOLDER / "used"
    with contextlib.chdir(used):
        library, files = libraries[options["library"]], UsedFiles(name, (used,))
        analysis = analyse(source, library, options.get("start"), files)
    return analysis.source, analysis.diagnostics


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_wrong_script_is_told_what_is_wrong_with_it(
    path: Path, libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    data = path.read_bytes()
    source, diagnostics = told(data, path.name, libraries)
    assert diagnostics
    only = options_of(data).get("only")
    kept = [one for one in diagnostics if only in (None, one.code)]
    golden(path.with_suffix(".txt"), render_full(kept, source))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_every_edit_mends_what_it_is_offered_for(path: Path, libraries: Mapping[str, Any]) -> None:
    """A safe one leaves no more errors and warnings than there were."""
    source, before = told(path.read_bytes(), path.name, libraries)
    for one in before:
        for fix in one.fixes:
            if fix.span.end > len(source.text):  # in a file that the script uses
                continue
            mended = source.text[: fix.span.start] + fix.replacement + source.text[fix.span.end :]
            _, after = told(mended.encode(), path.name, libraries)
            assert n_alike(one, after) < n_alike(one, before), (one.message, mended)
            if fix.safe:
                assert n_serious(after) <= n_serious(before), mended


def n_alike(one: Diagnostic, diagnostics: tuple[Diagnostic, ...]) -> int:
    return sum((other.code, other.message) == (one.code, one.message) for other in diagnostics)


def n_serious(diagnostics: tuple[Diagnostic, ...]) -> int:
    return sum(one.severity is not Severity.HINT for one in diagnostics)


def test_every_code_is_shown_by_a_wrong_script() -> None:
    drawn = "".join(path.with_suffix(".txt").read_text(encoding="utf-8") for path in SCRIPTS)
    assert [code for code in CODES if f"[{code}]" not in drawn] == []


def test_no_drawing_is_left_without_its_script() -> None:
    drawings = {path.with_suffix("") for path in FOLDER.rglob("*.txt")}
    assert drawings == {path.with_suffix("") for path in SCRIPTS}


def test_there_are_enough_of_them() -> None:
    assert len(SCRIPTS) >= 120
