"""What differs between two texts is told line by line, and makes one of the other."""

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.line_diff import changed_lines
from mlmg_lang.source import Edit, Source

TEXTS = st.lists(st.sampled_from(["a\n", " a\n", "b\r\n", "c\r", "\n", "d e\n", "d  e\n"]), max_size=12).map("".join)


def edited(text: str, edits: Iterable[Edit]) -> str:
    for edit in reversed(list(edits)):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("a\nb\nc\n", "a\nb\nc\n", []),
        ("a\nb\nc\n", "a\nB\nc\n", [("b\n", "B\n")]),
        ("a\nb\nc\n", "A\nB\nc\n", [("a\n", "A\n"), ("b\n", "B\n")]),
        ("a\nb\nc\n", "a\nc\n", [("b\n", "")]),
        ("a\nc\n", "a\nb\nc\n", [("", "b\n")]),
        ("a\nx  y\nb\n", "a\nx y\nnew\nb\n", [("x  y\n", "x y\n"), ("", "new\n")]),
        ("a\nx\nb", "a\ny\nz\nb", [("x\n", "y\nz\n")]),
        ("a", "a\n", [("a", "a\n")]),
    ],
)
def test_lines_that_are_the_same_stay(before, after, expected):
    edits = list(changed_lines(Source(before), after))
    assert [(before[edit.span.start : edit.span.end], edit.replacement) for edit in edits] == expected


@given(TEXTS, TEXTS)
def test_the_edits_make_one_text_of_the_other(before, after):
    assert edited(before, changed_lines(Source(before), after)) == after


def test_of_very_many_lines_only_where_the_change_begins_and_ends_is_told():
    before = "".join(f"{number}\n" for number in range(6_000))
    after = before.replace("\n", "x\n").replace("0x\n", "0\n")
    edits = list(changed_lines(Source(before), after))
    assert edited(before, edits) == after
    assert edits[0].span.start == len("0\n")
