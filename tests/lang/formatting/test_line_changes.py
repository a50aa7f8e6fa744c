"""What may be taken over of a canonical form by itself: lines, as few as can be at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.formatting.line_changes import changes_within_lines, line_changes, line_end_of, with_line_ends
from mlmg_lang.source import Edit, Source

PIECES = [
    *("WALK", "with", "for", "3 s", "2:", "repeat 2 {", "choose {", "{", "}", "}", "(", ")", "|", ";", ",", "05"),
    *('"', '"WALK"', "\n", "\n", "\n", "\r\n", "\n\n\n", "\n;\n", "# c\n", "\n  # own\n", "# mlmg: ignore[MS045]\n"),
]


def changes_of(text: str) -> list[Edit]:
    source = Source(text)
    return line_changes(source, with_line_ends(format_source(source), line_end_of(source)))


def changed(text: str, changes: Iterable[Edit]) -> str:
    for one in sorted(changes, key=lambda one: one.span, reverse=True):
        text = text[: one.span.start] + one.replacement + text[one.span.end :]
    return text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("repeat 2 {\n  WALK for 3s\n  }", ["    WALK for 3 sec\n", "}\n"]),
        ("repeat 2 {\nWALK\n\n\n\n IDLE\n}\n", ["    WALK\n", "", "", "    IDLE\n"]),
        ("\n\nWALK\n\n", ["", "", ""]),
        ("WALK; IDLE\nWALK", ["WALK\nIDLE\n", "WALK\n"]),
        ("WALK\n for  3 sec\nIDLE  once\n", ["WALK for 3 sec\n", "IDLE once\n"]),
        ("A\n;\nwith  B\n", ["A;\n"]),
        ("A\n ;\n\n\nB\n", ["", ""]),
        ("A; IDLE\n;\nTALK\n", ["A\nIDLE\n", ""]),
        (
            "IDLE\n # own\nrepeat 0 { A } # mlmg: ignore[MS045]\n",
            ["# own\n", "# mlmg: ignore[MS045]\nrepeat 0 {\n    A\n}\n"],
        ),
        ("IDLE\r \nIDLE\n", ["IDLE\n\n"]),
        ("repeat 2 {\r\nWALK\r\n}\r\n", ["    WALK\r\n"]),
        ("repeat 2 {\n\tWALK  FOR 3 s\n\tIDLE for 05 s\n}\n", ["    WALK  FOR 3 s\n", "    IDLE for 5 sec\n"]),
    ],
)
def test_each_line_changes_by_itself_where_that_can_be(text: str, expected: list[str]) -> None:
    assert [one.replacement for one in changes_of(text)] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("repeat  2{\n\n}\n", ["repeat 2 {"]),
        ("choose{3 :WALK\n |  IDLE  for 3s}\n", ["choose { 3: WALK", "| IDLE for 3 sec }"]),
        ("WALK  with A\n  with   B # so\n", ["WALK with A", "with B"]),
        ("choose{\nWALK|\nA;B}\n", ["choose {"]),
    ],
)
def test_within_lines_words_change_and_the_spaces_between_them(text: str, expected: list[str]) -> None:
    found = [changes_within_lines(Source(text), one) for one in changes_of(text)]
    assert [part.replacement for parts in found for part in parts] == expected


@given(data=st.data())
def test_a_script_says_the_same_whichever_changes_are_made(
    data: st.DataObject, scripts: SearchStrategy[str], facts: Callable[[str], object]
) -> None:
    text = data.draw(scripts)
    changes = changes_of(text)
    some = data.draw(st.lists(st.sampled_from(changes), unique=True)) if changes else []
    parts = [part for one in changes if one not in some for part in changes_within_lines(Source(text), one)]
    made = changed(text, [*some, *(data.draw(st.lists(st.sampled_from(parts), unique=True)) if parts else ())])
    assert facts(made) == facts(text)
    assert format_source(Source(made)) == format_source(Source(text))


@example('WALK } \n " WALK')
@given(st.lists(st.sampled_from(PIECES), max_size=30).map(" ".join))
def test_all_changes_come_to_the_canonical_form_whatever_the_text(text: str) -> None:
    changes = changes_of(text)
    assert changed(text, changes) == with_line_ends(format_source(Source(text)), line_end_of(Source(text)))
    assert all(one.span.end <= other.span.start for one, other in pairwise(changes))
