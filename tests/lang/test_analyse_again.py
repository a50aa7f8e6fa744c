"""An analysis after any edit is that of the whole text afresh."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mlmg_lang.analysis import InPieces
from mlmg_lang.front_end import Analysis, analyse, analyse_again
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[1]
STORED = [
    path.read_bytes().decode("utf-8", "replace")
    for folder in ("invalid", "golden/scripts")
    for path in sorted((FOLDER / folder).glob("*.ms"))
]
STAGES = ("source", "tokens", "script", "expanded", "definitions", "plan", "resolved", "diagnostics")
LINES = (
    *("WALK for 10 sec\n", "WALK with Sub TALK for 10 sec\n", "IDLE\n", "IDLE for 3 sec\n", "WALK or IDLE\n"),
    *("Upper-Body TALK\n", "Upper-Body SWING_HAND\n", "Upper-Body Talk_02\n", "Upper-Body IDLE\n", "Walk_01\n"),
    *("end Upper-Body\n", "wait 2 sec\n", "# c\n", "\n", "repeat 2 { IDLE; Upper-Body Talk_02 }\n", "Talk_02 once\n"),
    *("repeat 3 {\nUpper-Body TALK\nWALK or IDLE\n}\n", "choose { | Upper-Body TALK\n}\n"),
)
BITS = (
    *LINES,
    *(" ", "\n", "\r", "\r\n", "{", "}", "(", ")", "|", ";", ":", '"', "# x", "W", "_", "1", "”", "-", "\\", "=", ","),
    *("/*", "*/", "// ", " -- ", "\uff08", "\uff09", "\uff5b", "\uff5d", "\uff1b", "\uff03", "\uff12", "loop 2 {\n"),
    *("repeat 2 {\n", "choose {\n", "with TALK\n", "WLAK\n", "walk01\n", "let x = WALK\n", "# mlmg: ignore[MS047]\n"),
)
EDITS = st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 9), st.sampled_from(("", *BITS))), max_size=8)
LINE_EDITS = st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 2), st.sampled_from(LINES)), max_size=6)
GENERATED = run_path(str(Path(__file__).parent / "scripts_strategy.py"))["scripts"]()
PLAYABLE = st.lists(st.sampled_from(LINES), max_size=30).map("".join)
LIBRARIES = st.sampled_from(("none", "reference", "left-hand", "hands", "cut", "far"))
many = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def check(before: Analysis, text: str, library: Any, start: str | None = None) -> Analysis:
    """Return the analysis after an edit, when it has been compared with a fresh one."""
    again, fresh = analyse_again(before, Source(text)), analyse(Source(text), library, start)
    for stage in STAGES:
        assert getattr(again, stage) == getattr(fresh, stage), stage
    return again


def edited(text: str, edit: tuple[int, int, str]) -> str:
    at, n_removed, added = edit
    at %= len(text) + 1
    return text[:at] + added + text[at + n_removed :]


def with_other_lines(text: str, edit: tuple[int, int, str]) -> str:
    at, n_removed, added = edit
    lines = text.splitlines(keepends=True)
    at %= len(lines) + 1
    return "".join((*lines[:at], added, *lines[at + n_removed :]))


@many
@given(text=st.one_of(GENERATED, st.sampled_from(STORED), PLAYABLE, st.text(max_size=80)), edits=EDITS, name=LIBRARIES)
def test_after_any_edits_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str
) -> None:
    analysis = analyse(Source(text), libraries[name])
    for edit in edits:
        text = edited(text, edit)
        analysis = check(analysis, text, libraries[name])


@many
@given(text=PLAYABLE, edits=LINE_EDITS, name=LIBRARIES, start=st.sampled_from((None, "Walk_01", "nowhere")))
def test_after_other_commands_all_is_played_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str, start: str | None
) -> None:
    analysis = analyse(Source(text), libraries[name], start)
    for edit in edits:
        text = with_other_lines(text, edit)
        analysis = check(analysis, text, libraries[name], start)


@pytest.mark.parametrize("text", STORED)
def test_line_ends_may_change_all_at_once(libraries: Mapping[str, Any], text: str) -> None:
    library = libraries["reference"]
    analysis = analyse(Source(text), library)
    analysis = check(analysis, text.replace("\n", "\r\n"), library)
    check(analysis, text, library)


def test_only_what_an_edit_touches_is_read_again(libraries: Mapping[str, Any]) -> None:
    text = "WALK for 2 sec\nIDLE for 2 sec\n" * 50
    before = analyse(Source(text), libraries["reference"])
    again = check(before, text[:1500] + text[1500:].replace("2", "3", 1), libraries["reference"])
    assert isinstance(again.made, InPieces)
    kept = {id(piece) for piece in before.pieces.pieces}
    assert sum(id(piece) not in kept for piece in again.made.pieces) == 1


def test_what_a_later_line_asks_is_told_with_its_line_as_it_is_now(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\n" * 3 + "IDLE\nUpper-Body TALK for 1 sec\n"
    again = check(analyse(Source(text), library), "\n\n" + text, library)
    assert again.resolved is not None
    told = [one.because for layer in again.resolved.statements[3].layers for one in layer.left_out]
    assert told == ["what line 7 asks of `Upper-Body` cannot begin in it"]


def test_a_line_typed_again_and_again_in_the_same_place_is_still_kept_apart(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\nIDLE for 2 sec\n"
    analysis = analyse(Source(text), library)
    for _ in range(60):
        text = text.replace("IDLE", "Upper-Body TALK\nIDLE", 1)
        analysis = check(analysis, text, library)
        text = text.replace("WALK for 2 sec\n", "WALK for 2 sec\nTALK for 1 sec\n", 1)
        analysis = check(analysis, text, library)
