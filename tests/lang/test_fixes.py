"""The edits that diagnostics offer, held against what they promise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source

SCRIPTS = sorted((Path(__file__).parents[1] / "invalid").glob("*.ms"))
Fixed = Callable[..., str]


def analysed(text: str, libraries: Mapping[str, Any]) -> tuple[Diagnostic, ...]:
    library = text.split("\n", 1)[0].removeprefix("# library: ")
    return analyse(Source(text), libraries[library]).diagnostics


def counted(diagnostics: tuple[Diagnostic, ...]) -> int:
    return sum(one.severity is not Severity.HINT for one in diagnostics)


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_every_fix_mends_what_it_is_offered_for(path: Path, libraries: Mapping[str, Any]) -> None:
    text = path.read_bytes().decode("utf-8")
    before = analysed(text, libraries)
    for one in before:
        for fix in one.fixes:
            mended = text[: fix.span.start] + fix.replacement + text[fix.span.end :]
            after = analysed(mended, libraries)
            left = [other for other in after if (other.code, other.message) == (one.code, one.message)]
            same = [other for other in before if (other.code, other.message) == (one.code, one.message)]
            assert len(left) < len(same), (one.message, mended)
            if fix.safe:
                assert counted(after) <= counted(before), mended


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK FOR 10 SEC", "WALK for 10 sec"),
        ("WALK WITH Upper-Body TALK For 2 sec", "WALK with Upper-Body TALK for 2 sec"),
        ("END with TALK FOR 10 sec", "END with TALK for 10 sec"),
        ("WALK 10 sec", "WALK for 10 sec"),
        ("WALK for .5 sec", "WALK for 0.5 sec"),
        ("WALK for 1,5 sec", "WALK for 1.5 sec"),
        ("WALK for 1 min 30 sec", "WALK for 90 sec"),
        ("WALK for 1.5 sec 250 ms", "WALK for 1.75 sec"),
        ("WALK for 10", "WALK for 10 sec"),
        ("WALK for 10 secs", "WALK for 10 sec"),
        ("wait for 10 sec", "wait 10 sec"),
        ("WALK for 10 sec with Upper-Body TALK", "WALK with Upper-Body TALK for 10 sec"),
        ("WALK whit Upper-Body TALK", "WALK with Upper-Body TALK"),
        ("WALK & TALK", "WALK and TALK"),
        ("!WALK", "not WALK"),
        ("WALK with (Upper-Body TALK", "WALK with (Upper-Body TALK)"),
        ("WALK)", "WALK"),
        ("Upper-Body not TALK", "not Upper-Body TALK"),
        ("Upper--Body", '"Upper--Body"'),
        ("3d_walk", '"3d_walk"'),
        ("hand😀", '"hand😀"'),
        ("（WALK）", "(WALK)"),
        ('"hand on hip', '"hand on hip"'),
        ('"hand on hip for 3 sec', '"hand on hip" for 3 sec'),
        ('"Walk_01  # a comment', '"Walk_01"  # a comment'),
        ('"standing forward', '"standing forward"'),
        ('"C:\\new"', '"C:\\\\new"'),
        ("TALK with to", 'TALK with "to"'),
        ("repeat 2\n{ WALK }", "repeat 2 { WALK }"),
        ("WALK for 0 sec", "WALK"),
    ],
)
def test_a_script_is_mended_as_its_writer_would(script: str, right: str, fixed: Fixed) -> None:
    assert fixed(script) == right


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK ONCE", "WALK once"),
        ("END Upper-Body", "end Upper-Body"),
        ("walk01 with upper_body talk", "Walk_01 with Upper-Body TALK"),
        ("WLAK with Uper-Body TLAK", "WALK with Upper-Body TALK"),
        ("TALK Upper-Body", "Upper-Body TALK"),
        ("WALK with sub talk", "WALK with Sub TALK"),
    ],
)
def test_names_are_mended_as_the_library_spells_them(script: str, right: str, fixed: Fixed, reference: Any) -> None:
    assert fixed(script, reference) == right


def test_a_name_that_needs_quotes_is_offered_in_quotes(catalog: Any, fixed: Fixed) -> None:
    library = catalog({"Body": {'hand on "hip"': (), "with": ()}}, {}, start="with")
    assert fixed('"hand_on_hip"', library) == '"hand on \\"hip\\""'
    assert fixed("WITH", library) == '"with"'
