"""What each stage makes of the scripts in golden/scripts; rewritten with --update-golden."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import has_errors
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.rendering import render_full, render_json
from mlmg_lang.script_files import used_files
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[1] / "golden"
SCRIPTS = sorted((FOLDER / "scripts").glob("*.ms"))
STAGES = ("tokens", "script", "expanded", "plan", "resolved")


def analysed(path: Path, libraries: Mapping[str, Any]) -> Analysis:
    """Return the analysis of a script; what it uses is named as from its own folder."""
    source = Source(path.read_text(encoding="utf-8"), path.name)
    with contextlib.chdir(path.parent):
        return analyse(source, libraries["reference"], files=used_files(path.name))


@pytest.mark.parametrize("stage", STAGES)
@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_stage_makes_of_a_script_what_it_did_before(
    path: Path,
    stage: str,
    libraries: Mapping[str, Any],
    golden: Callable[[Path, str], None],
    tree: Callable[[Any, Source], str],
) -> None:
    analysis = analysed(path, libraries)
    golden(FOLDER / stage / f"{path.stem}.txt", tree(getattr(analysis, stage), analysis.source))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_the_diagnostics_of_a_script_are_drawn_as_before(
    path: Path, libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    analysis = analysed(path, libraries)
    golden(FOLDER / "diagnostics" / f"{path.stem}.txt", render_full(analysis.diagnostics, analysis.source))


def test_the_diagnostics_of_a_script_are_the_same_json_as_before(
    libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    analysis = analysed(FOLDER / "scripts" / "mistakes.ms", libraries)
    golden(FOLDER / "diagnostics" / "mistakes.json", render_json([(analysis.source, analysis.diagnostics)]))


def test_there_are_scripts() -> None:
    assert len(SCRIPTS) >= 10


def test_only_the_script_of_mistakes_and_that_of_types_have_any(libraries: Mapping[str, Any]) -> None:
    wrong = {path.stem for path in SCRIPTS if has_errors(analysed(path, libraries).diagnostics)}
    assert wrong == {"mistakes"}


def test_no_golden_file_is_left_without_its_script() -> None:
    stems = {path.stem for path in SCRIPTS}
    assert all(path.stem in stems for stage in (*STAGES, "diagnostics") for path in (FOLDER / stage).iterdir())
