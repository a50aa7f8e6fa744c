"""An analysis after any edit is that of the whole text afresh."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from itertools import pairwise
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import Analysis, analyse, analyse_again
from mlmg_lang.ide.folding import folds
from mlmg_lang.ide.symbols import document_symbols
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[1]
STORED = [
    path.read_bytes().decode("utf-8", "replace")
    for folder in ("invalid", "golden/scripts")
    for path in sorted((FOLDER / folder).glob("*.ms"))
]
STAGES = ("source", "tokens", "script", "expanded", "definitions", "plan", "resolved", "diagnostics")


def edited(text: str, edit: tuple[int, int, str]) -> str:
    at, n_removed, added = edit
    at %= len(text) + 1
    return text[:at] + added + text[at + n_removed :]


def with_other_lines(text: str, edit: tuple[int, int, str]) -> str:
    at, n_removed, added = edit
    lines = text.splitlines(keepends=True)
    at %= len(lines) + 1
    return "".join((*lines[:at], added, *lines[at + n_removed :]))


def before_line(text: str, edit: tuple[int, int, str]) -> str:
    """Put a sign before a line, in place of some of its beginning."""
    at, n_removed, added = edit
    lines = text.splitlines(keepends=True) or [""]
    at %= len(lines)
    return "".join((*lines[:at], added, lines[at][n_removed:], *lines[at + 1 :]))


LINES = (
    *("WALK for 10 sec\n", "WALK with Sub TALK for 10 sec\n", "IDLE\n", "IDLE for 3 sec\n", "WALK or IDLE\n"),
    *("Upper-Body TALK\n", "Upper-Body SWING_HAND\n", "Upper-Body Talk_02\n", "Upper-Body IDLE\n", "Walk_01\n"),
    *("end Upper-Body\n", "wait 2 sec\n", "# c\n", "\n", "repeat 2 { IDLE; Upper-Body Talk_02 }\n", "Talk_02 once\n"),
    *("repeat 3 {\nUpper-Body TALK\nWALK or IDLE\n}\n", "choose { | Upper-Body TALK\n}\n"),
)
DEFINING = (
    *(
        "let x = WALK\n",
        "let x = IDLE\n",
        "let y = x or TALK\n",
        "let G(p, t = 2 sec) = p with Upper-Body TALK for t\n",
    ),
    *(
        "let H(p) = p and not x\n",
        "let z = WLAK\n",
        "let 😀 = WALK\n",
        "let WALK = IDLE\n",
        'use "a.ms"\n',
        'use "b.ms"\n',
        'use "no.ms"\n',
    ),
    *(
        "x\n",
        "x for 2 sec\n",
        "y with Upper-Body SWING_HAND\n",
        "G(x)\n",
        "G(IDLE, 3 sec)\n",
        "H(y) for 1 sec\n",
        "z\n",
    ),
    *(
        "xx\n",
        "Upper-Body x\n",
        "H(1 sec)\n",
        "G(x) 3 sec\n",
        "x 3 sec\n",
        "let x = 5 sec\n",
        "WALK for x\n",
        "WALK for x sec\n",
        "let x = WALK for 2 sec\n",
        "let\n",
        "let (\n",
        "use\n",
        "Upper-Body (TALK with IDLE)\n",
        "WALK with Upper-Body (nobody)\n",
        "nobody(WALK) for\n",
        "of_a for 1 sec\n",
        "of_b\n",
        "repeat 2 {\n x\n let q = IDLE\n}\n",
        "q\n",
    ),
)
USED = {
    "a.ms": 'let of_a = TALK or IDLE\nlet unlike = of_b\nuse "b.ms"\n',
    "b.ms": "let of_b = WALK\nlet y = WLAK # mlmg: ignore[MS070]\n",
}
BRACES = (
    *("repeat 2 {\n", "repeat 3 { WALK for 2 sec\n", "repeat 0 {\n", "choose {\n", "choose { 2: IDLE\n", "}\n"),
    *("} }\n", "} | {\n", "| 3: WALK for 1 sec\n", "| 0:\n", "2: WALK\n", "|\n", "{\n", "WALK {\n", "loop 2 {\n"),
    *("let q = WALK\n", "q for 2 sec\n", "# mlmg: ignore[MS047]\n", "WALK for 0 sec\n", "WALK || IDLE\n"),
    *("} # mlmg: ignore[MS045, MS047]\n", "repeat 200000 {\n", "repeat 1 {\n", "} repeat 2 {\n", "WALK with\n"),
    *("choos {\n", "}; IDLE\n", "WLAK\n"),
)
BITS = (
    *LINES,
    *DEFINING,
    *(" ", "\n", "\r", "\r\n", "{", "}", "(", ")", "|", ";", ":", '"', "# x", "W", "_", "1", "”", "-", "\\", "=", ","),
    *("/*", "*/", "// ", " -- ", "\uff08", "\uff09", "\uff5b", "\uff5d", "\uff1b", "\uff03", "\uff12", "loop 2 {\n"),
    *("repeat 2 {\n", "choose {\n", "with TALK\n", "WLAK\n", "walk01\n", "let x = WALK\n", "# mlmg: ignore[MS047]\n"),
    *(
        "WALK with Upper Body TALK\n",
        "Upper Body x\n",
        "let x = WALK with upper body wave hand\n",
        "let x = Upper body\n",
        "let n = Upper-Body IDLE\n",
        "let n = Upper-Body IDLE # c\n",
        "WALK with Upper-Body TALK with n\n",
        "n with n\n",
    ),
)
JOINED = (
    *("WALK\n", "WALK\n", "IDLE for 1 sec\n", "with Upper-Body TALK\n", "    or IDLE\n", "  for 2 sec\n", "(\n", ")\n"),
    *("(WALK\n", "IDLE)\n", "let x = WALK\n", "    let f(p) = p\n", "let y = (IDLE\n", "x\n", "repeat 2\n", "{\n"),
    *(
        "    repeat 2 {\n",
        "choose {\n",
        "| IDLE\n",
        "}\n",
        "} # c\n",
        "x } y\n",
        "x } with (TALK\n",
        "} }\n",
        "wait 1 sec)\n",
    ),
    *(
        "# c\n",
        "    # repeat 2 {\n",
        "// WALK\n",
        "-- )\n",
        "/* a\n",
        "b */\n",
        "\n",
        "\t\n",
        "\r\n",
        '"WALK\n',
        "f(WALK;\n",
    ),
)
"""Lines that go on with others, or end what could."""
SIGNS = (
    *(
        "#",
        "# ",
        "//",
        "// ",
        "-- ",
        "/* ",
        " */",
        "\uff03",
        "\uff0f\uff0f ",
        "\uff0f\uff0a ",
        " \uff0a\uff0f",
        '"',
        '" /* "',
    ),
    *("    ", "\n", "\r", "(", ")", "{", "}", "} ", "repeat 2 {", "let ", "with ", ";", "\uff08", "\uff5d"),
)
"""What joins lines, parts them, or takes them away, put into the midst of others."""
EDITS = st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 9), st.sampled_from(("", *BITS))), max_size=8)
JOINING_EDITS = st.lists(
    st.one_of(
        st.tuples(st.just(edited), st.tuples(st.integers(0, 500), st.integers(0, 4), st.sampled_from(("", *SIGNS)))),
        st.tuples(st.just(before_line), st.tuples(st.integers(0, 30), st.integers(0, 4), st.sampled_from(SIGNS))),
        st.tuples(
            st.just(with_other_lines), st.tuples(st.integers(0, 30), st.integers(0, 2), st.sampled_from(("", *JOINED)))
        ),
    ),
    max_size=8,
)
LINE_EDITS = st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 2), st.sampled_from(LINES)), max_size=6)
DEFINING_EDITS = st.lists(
    st.tuples(st.integers(0, 10_000), st.integers(0, 2), st.sampled_from(("", *LINES, *DEFINING))), max_size=6
)
BRACED_EDITS = st.lists(
    st.tuples(st.integers(0, 10_000), st.integers(0, 2), st.sampled_from(("", *LINES, *BRACES))), max_size=8
)
BRACED = st.lists(st.sampled_from((*LINES, *BRACES)), max_size=30).map("".join)
GENERATED = run_path(str(Path(__file__).parent / "scripts_strategy.py"))["scripts"]()
DEFINED = st.lists(st.sampled_from((*LINES, *DEFINING, *DEFINING)), max_size=30).map("".join)
PLAYABLE = st.lists(st.sampled_from(LINES), max_size=30).map("".join)
LIBRARIES = st.sampled_from(("none", "reference", "left-hand", "hands", "cut", "far"))
many = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


class Used:
    """The files of `USED`."""

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        return (Source(USED[path], path), ()) if path in USED else "it does not exist"


FILES = Used()


def check(before: Analysis, text: str, library: Any, start: str | None = None) -> Analysis:
    """Return the analysis after an edit, when it has been compared with a fresh one."""
    again, fresh = analyse_again(before, Source(text)), analyse(Source(text), library, start, FILES)
    assert extents(again) == extents(fresh)
    for stage in STAGES:
        assert getattr(again, stage) == getattr(fresh, stage), stage
    assert folds(again) == folds(fresh)
    assert document_symbols(again) == document_symbols(fresh)
    return again


def extents(analysis: Analysis) -> tuple[list[str], list[int]]:
    """Return the texts of the pieces, and where those begin that stand in no block."""
    made = analysis.made
    ends = pairwise(made.places.logical_line_starts)
    return [made.source.text[start:end] for start, end in ends], list(made.places.starts)


@many
@given(text=st.one_of(GENERATED, st.sampled_from(STORED), PLAYABLE, st.text(max_size=80)), edits=EDITS, name=LIBRARIES)
def test_after_any_edits_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str
) -> None:
    analysis = analyse(Source(text), libraries[name], None, FILES)
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


@many
@given(text=BRACED, edits=BRACED_EDITS, name=LIBRARIES)
def test_after_other_braces_and_what_is_in_them_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str
) -> None:
    analysis = analyse(Source(text), libraries[name], None, FILES)
    for edit in edits:
        text = with_other_lines(text, edit)
        analysis = check(analysis, text, libraries[name])


@many
@given(text=st.one_of(BRACED, GENERATED), edits=EDITS, name=LIBRARIES)
def test_after_any_edits_in_blocks_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str
) -> None:
    analysis = analyse(Source(text), libraries[name], None, FILES)
    for edit in edits:
        text = edited(text, edit)
        analysis = check(analysis, text, libraries[name])


@many
@given(text=DEFINED, edits=DEFINING_EDITS, name=LIBRARIES)
def test_after_other_definitions_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], text: str, edits: list[tuple[int, int, str]], name: str
) -> None:
    analysis = analyse(Source(text), libraries[name], None, FILES)
    for edit in edits:
        text = with_other_lines(text, edit)
        analysis = check(analysis, text, libraries[name])


@many
@given(lines=st.lists(st.sampled_from(JOINED), max_size=20), edits=JOINING_EDITS)
def test_after_any_edits_lines_are_joined_and_parted_as_afresh(
    lines: list[str], edits: list[tuple[Callable[[str, tuple[int, int, str]], str], tuple[int, int, str]]]
) -> None:
    text = "".join(lines)
    analysis = analyse(Source(text))
    for way, edit in edits:
        text = way(text, edit)
        analysis = check(analysis, text, None)


MISNAMED = (
    *("WLAK\n", "Upper-Body WLAK for 1 sec\n", "Upper WALK\n", "walk01 for 2 sec\n", "Left-Hand WALK\n", "xx\n"),
    *("G()\n", "WLAK WLAK\n", "IDLE and WALK\n", "end Uper-Body\n", "repeat 2 { WLAK; WALK; xx }\n", "let x = WLAK\n"),
)
MISWRITTEN = (
    *("WALK for\n", "WALK for for 2 sec\n", "WALK or\n", "“WALK” IDLE\n", "WALK } IDLE\n", "WALK)\n", "WLAK for\n"),
    *("repeat 2 { WLAK; IDLE for\n", "repeat { WALK; wlk }\n", "let y = x for\n", "let = \n", "}\n"),
    *("WALK; WALK for\n", "WALK\nWALK\nWALK\nWALK\nWALK for\n"),
)


def line_edits(*lines: str) -> st.SearchStrategy[list[tuple[int, int, str]]]:
    return st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 3), st.sampled_from(("", *lines))), max_size=8)


@pytest.mark.parametrize("mistaken", [MISNAMED, MISWRITTEN, (*MISNAMED, *MISWRITTEN, *BRACES)])
@many
@given(data=st.data(), name=LIBRARIES, most=st.integers(1, 6))
def test_of_too_many_mistakes_the_same_are_told_as_afresh(
    libraries: Mapping[str, Any], mistaken: tuple[str, ...], data: st.DataObject, name: str, most: int
) -> None:
    lines = (*LINES, *mistaken, *mistaken, *DEFINING)
    text = "".join(data.draw(st.lists(st.sampled_from(lines), max_size=20)))
    with pytest.MonkeyPatch.context() as patch:
        for module in ("parsing.parse", "planning.plan", "pieces", "rereading", "understanding"):
            patch.setattr(f"mlmg_lang.{module}.MAX_MISTAKES", most)
        analysis = analyse(Source(text), libraries[name], None, FILES)
        for edit in data.draw(line_edits(*lines)):
            text = with_other_lines(text, edit)
            analysis = check(analysis, text, libraries[name])


@pytest.mark.parametrize(("mistaken", "n_lines"), [(MISNAMED, 450), (MISWRITTEN, 500)])
def test_around_as_many_mistakes_as_are_told_all_is_as_if_analysed_afresh(
    libraries: Mapping[str, Any], mistaken: tuple[str, ...], n_lines: int
) -> None:
    library, draw = libraries["reference"], random.Random(0)
    text = "".join(draw.choice(mistaken if draw.random() < 0.4 else LINES) for _ in range(n_lines))
    analysis = analyse(Source(text), library, None, FILES)
    are_too_many = set()
    for at in range(6):
        n_new = draw.choice((60, 90))
        added = draw.choices(mistaken if at % 2 else LINES, k=n_new)
        text = with_other_lines(text, (draw.randrange(60), n_new, "".join(added)))
        analysis = check(analysis, text, library)
        text = with_other_lines(text, (draw.randrange(400), 1, draw.choice(mistaken)))
        analysis = check(analysis, text, library)
        are_too_many.add(any(one.code == "MS006" for one in analysis.diagnostics))
    assert are_too_many == {False, True}


def test_an_edit_of_a_script_with_too_many_mistakes_leaves_all_else_as_it_was(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\nWLAK for 2 sec\n" * 300
    before = analyse(Source(text), library)
    assert [one.code for one in before.diagnostics if one.code != "MS021"] == ["MS006"]
    assert len(before.diagnostics) == 202
    again = check(before, text.replace("2", "3", 1), library)
    assert n_kept(before, again) == len(before.ready.pieces) - 1
    mended = check(again, text.replace("WLAK", "WALK", 1), library)
    assert n_kept(again, mended) == len(before.ready.pieces) - 3
    check(mended, text, library)


def test_hints_are_no_mistakes_however_many_there_are(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "walk01 for 2 sec\n" * 260
    before = analyse(Source(text), library)
    assert [one.code for one in before.diagnostics] == 260 * ["MS020"]
    again = check(before, text.replace("2", "3", 1), library)
    assert n_kept(before, again) == len(before.ready.pieces) - 1
    behind = check(again, "WLAK for 2 sec\n" * 202 + text, library)
    assert [one.code for one in behind.diagnostics] == 201 * ["MS021"] + ["MS006"] + 260 * ["MS020"]
    check(behind, text, library)


@pytest.mark.parametrize(
    "text",
    [
        "; ".join(260 * ["walk01 for 2 sec"]),
        f"repeat 2 {{ {'; '.join(260 * ['walk01 for 2 sec'])} }}",
        "".join(f"let X_{n} = walk01\n" for n in range(260)),
    ],
    ids=["line", "block", "definitions"],
)
def test_hints_of_one_line_or_of_definitions_are_no_mistakes(libraries: Mapping[str, Any], text: str) -> None:
    analysis = analyse(Source(text), libraries["reference"])
    assert analysis.resolved is not None
    assert sum(one.code == "MS020" for one in analysis.diagnostics) == 260


def test_a_mistake_less_in_a_script_of_which_the_rest_is_not_read_has_some_more_of_it_read(
    libraries: Mapping[str, Any],
) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\nIDLE for\n" * 300
    before = analyse(Source(text), library)
    assert [one.code for one in before.diagnostics] == 200 * ["MS017"] + ["MS006"]
    mended = check(before, text.replace("for\n", "once\n", 1), library)
    assert n_kept(before, mended) == len(before.ready.pieces) - 5
    check(mended, text, library)


STRAY = "WALK\nIDLE\n(WALK\nx } y\nIDLE)\nWALK\n"
"""The brace parts the lines in the parentheses where it can close a block, and is only a mistake elsewhere."""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("WALK\n    repeat 2 {\n  x\n", "WALK\n//    repeat 2 {\n  x\n"),
        ("WALK\n    repeat 2 {\n  x\n", "WALK\n#    repeat 2 {\n  x\n"),
        ("WALK\nIDLE\nTALK\n", "# WALK\nIDLE\nTALK\n"),
        ("WALK\nIDLE\nTALK\n", "WALK\n\nTALK\n"),
        ("WALK\n/ \uff0a\nTALK\n\uff0a\uff0f\nIDLE\n", "WALK\n\uff0f\uff0a\nTALK\n\uff0a\uff0f\nIDLE\n"),
        ('WALK\n" /* "x\nIDLE\n */ \n', 'WALK\n" /* "x "\nIDLE\n */ \n'),
        (f"# repeat 2 {{\n{STRAY}", f"repeat 2 {{\n{STRAY}"),
        (f"repeat 2 {{\n{STRAY}", f"# repeat 2 {{\n{STRAY}"),
        ('use "no"\n let x = IDLE\n', 'use "no"\n)et x = IDLE\n'),
    ],
)
def test_a_line_goes_with_those_that_it_goes_with_afresh(old: str, new: str) -> None:
    check(check(analyse(Source(old), None, None, FILES), new, None), old, None)


@pytest.mark.parametrize("text", STORED)
def test_line_ends_may_change_all_at_once(libraries: Mapping[str, Any], text: str) -> None:
    library = libraries["reference"]
    analysis = analyse(Source(text), library, None, FILES)
    analysis = check(analysis, text.replace("\n", "\r\n"), library)
    check(analysis, text, library)


def test_only_what_an_edit_touches_is_read_again(libraries: Mapping[str, Any]) -> None:
    text = "WALK for 2 sec\nIDLE for 2 sec\n" * 50
    before = analyse(Source(text), libraries["reference"])
    again = check(before, text[:700] + text[700:].replace("2", "3", 1), libraries["reference"])
    assert n_kept(before, again) == len(before.ready.pieces) - 1


def n_kept(before: Analysis, again: Analysis) -> int:
    """Return how many pieces are the very same."""
    kept = {id(piece) for piece in before.ready.pieces}
    return sum(id(piece) in kept for piece in again.ready.pieces)


def test_an_edit_in_a_script_with_definitions_leaves_all_else_as_it_was(libraries: Mapping[str, Any]) -> None:
    text = 'use "a.ms"\nlet x = WALK\nlet y = TALK\n' + "x for 2 sec\ny for 2 sec\nof_a for 2 sec\n" * 30
    before = analyse(Source(text), libraries["reference"], None, FILES)
    again = check(before, text[:900] + text[900:].replace("2", "3", 1), libraries["reference"])
    assert n_kept(before, again) == len(before.ready.pieces) - 1


def test_while_the_use_of_a_file_is_typed_only_what_uses_that_is_understood_again(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "TALK for 2 sec\n" * 20 + "of_b for 1 sec\n"
    analysis = analyse(Source(text), library, None, FILES)
    for use in ("use\n", 'use "\n', 'use "a"\n', 'use "a.ms"\n', 'use "b.ms"\n', "\n"):
        again = check(analysis, use + text, library)
        assert n_kept(analysis, again) >= 19
        analysis = again


def test_the_edit_of_a_definition_changes_what_uses_it_and_no_more(libraries: Mapping[str, Any]) -> None:
    text = (
        "let x = WALK\nlet z = not x\n"
        + "TALK for 2 sec\n" * 20
        + "x for 2 sec\nz for 1 sec\n"
        + "TALK for 2 sec\n" * 20
    )
    before = analyse(Source(text), libraries["reference"])
    again = check(before, text.replace("WALK", "IDLE", 1), libraries["reference"])
    assert n_kept(before, again) == len(before.ready.pieces) - 3


def test_a_line_before_a_definition_leaves_that_and_what_uses_it_as_they_were(libraries: Mapping[str, Any]) -> None:
    text = "let x = WALK\n" + "x for 2 sec\n" * 20
    before = analyse(Source(text), libraries["reference"])
    again = check(before, f"TALK for 1 sec\n{text}", libraries["reference"])
    assert n_kept(before, again) == len(before.ready.pieces)


def test_behind_an_open_parenthesis_lines_stay_as_they_are_until_it_is_closed(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\n" * 20
    before = analyse(Source(text), library)
    again = check(before, text.replace("WALK", "(WALK", 1), library)
    assert n_kept(before, again) == len(before.ready.pieces) - 1
    third = check(again, again.source.text + "IDLE\n", library)
    assert n_kept(again, third) == len(again.ready.pieces)
    closed = check(third, third.source.text + ")\n", library)
    assert len(closed.ready.pieces) == 1


def test_what_a_later_line_asks_is_told_with_its_line_as_it_is_now(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\n" * 3 + "IDLE\nUpper-Body TALK for 1 sec\n"
    again = check(analyse(Source(text), library), "\n\n" + text, library)
    assert again.resolved is not None
    told = [one.because for layer in again.resolved.statements[3].layers for one in layer.left_out]
    assert told == ["what line 7 asks of `Upper-Body` cannot begin in it"]


def test_a_line_typed_again_and_again_in_the_same_place_is_still_kept_apart(libraries: Mapping[str, Any]) -> None:
    library, text = libraries["reference"], "WALK for 2 sec\nIDLE for 2 sec\n"
    analysis = analyse(Source(text), library, None, FILES)
    for _ in range(60):
        text = text.replace("IDLE", "Upper-Body TALK\nIDLE", 1)
        analysis = check(analysis, text, library)
        text = text.replace("WALK for 2 sec\n", "WALK for 2 sec\nTALK for 1 sec\n", 1)
        analysis = check(analysis, text, library)


def test_a_definition_that_has_no_sound_name_is_no_statement_however_its_script_came_about(
    libraries: Mapping[str, Any],
) -> None:
    library = libraries["reference"]
    before = analyse(Source("let A😀 = WALK\nlet B = IDLE\nTALK\n"), library)
    plan = check(before, "let A😀 = WALK\nlet B = =\nTALK\n", library).plan
    assert plan is not None
    assert [statement.span.start for statement in plan.statements] == [14, 24]


@pytest.mark.parametrize(
    "line", ["nobody for 1 sec", "nobody(WALK)", "Upper-Body (TALK with IDLE)", "nobody( for 1 sec"]
)
@pytest.mark.parametrize("name", ["none", "reference"])
def test_while_a_definition_is_typed_only_what_may_be_meant_for_it_is_understood_again(
    libraries: Mapping[str, Any], line: str, name: str
) -> None:
    text = f"WALK for 2 sec\n{line}\n" + "TALK for 2 sec\n" * 20
    begun = check(analyse(Source(text), libraries[name]), f"{text}let", libraries[name])
    assert n_kept(begun, check(begun, f"{text}let x = WALK", libraries[name])) >= 21


def test_a_name_that_stands_for_a_graph_by_mistake_is_told_of_as_soon_as_it_is_defined(
    libraries: Mapping[str, Any],
) -> None:
    library = libraries["reference"]
    before = analyse(Source('let WALKS = IDLE\nWALK " for 2 sec\n'), library)
    check(before, 'let WALK = IDLE\nWALK " for 2 sec\n', library)


def test_a_slip_of_a_name_that_is_defined_now_is_told_of_in_a_line_with_another_mistake_too(
    libraries: Mapping[str, Any],
) -> None:
    library = libraries["reference"]
    text = "Wuppe\uff03(IDLE, 3 sec)\nIDLE for 1 sec\nTALK for 1 sec\n"
    again = check(analyse(Source(text), library), f"{text}let Wuppy = WALK\n", library)
    assert "MS021" in {one.code for one in again.diagnostics}


def test_where_a_duration_belongs_is_told_as_soon_as_the_definition_before_it_says_how_long(
    libraries: Mapping[str, Any],
) -> None:
    library = libraries["reference"]
    before = analyse(Source("let GO = WALK\nGO 3 sec\n"), library)
    again = check(before, "let GO(t = 2 sec) = WALK for t\nGO 3 sec\n", library)
    assert [one.code for one in (*before.diagnostics, *again.diagnostics)] == ["MS010", "MS057"]
    assert [one.code for one in check(again, "let GO = WALK\nGO 3 sec\n", library).diagnostics] == ["MS010"]


LONG_BODY = "WALK for 2 sec\nIDLE for 2 sec\n" * 50


def n_lines_kept(before: Analysis, again: Analysis) -> int:
    """Return how many lines are the very same."""
    kept = {id(line) for line in before.ready.lines}
    return sum(id(line) in kept for line in again.ready.lines)


def test_in_a_block_only_what_an_edit_touches_is_read_again(libraries: Mapping[str, Any]) -> None:
    text = f"repeat 2 {{\n{LONG_BODY}}}\n"
    before = analyse(Source(text), libraries["reference"])
    again = check(before, text[:800] + text[800:].replace("for 2", "for 3", 1), libraries["reference"])
    assert n_lines_kept(before, again) == len(before.ready.lines) - 1


def test_a_brace_that_is_opened_and_closed_leaves_all_lines_as_they_were(
    libraries: Mapping[str, Any],
) -> None:
    library = libraries["reference"]
    before = analyse(Source(LONG_BODY), library)
    opened = check(before, f"repeat 2 {{\n{LONG_BODY}", library)
    assert n_lines_kept(before, opened) == len(before.ready.lines)
    closed = check(opened, f"{opened.source.text}}}\n", library)
    assert n_lines_kept(opened, closed) == len(opened.ready.lines)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Walk_02 for 2 sec", "Idle_02 for 2 sec"),
        ("2: IDLE", "0: IDLE"),
        ("repeat 3", "repeat 1"),
        ("}\n|", "}\n\n|"),
    ],
)
def test_in_a_block_a_command_does_something_else_where_something_else_comes_before_it(
    libraries: Mapping[str, Any], old: str, new: str
) -> None:
    inner = "choose { 2: IDLE for 1 sec\nrepeat 3 {\nWALK or IDLE\n}\n| 1: end Upper-Body\n}\n"
    text = f"repeat 2 {{\nWalk_02 for 2 sec\nUpper-Body SWING_HAND\n{inner}Upper-Body TALK\n}}\n"
    check(analyse(Source(text), libraries["reference"]), text.replace(old, new, 1), libraries["reference"])
