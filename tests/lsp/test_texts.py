"""Texts that are edited line by line are what they would be as a whole."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.source import Source
from mlmg_lsp.positions import EditorPosition, offset_from_position, position_from_offset
from mlmg_lsp.texts import edited, lines_of

TEXTS = st.text(alphabet="ab走😀\t\r\n\u2028\x0c\x85", max_size=20)
ENCODINGS = st.sampled_from(("utf-8", "utf-16", "utf-32"))


@given(TEXTS)
def test_lines_are_those_of_a_source(text):
    lines = lines_of(text)
    assert "".join(lines) == text
    assert [sum(map(len, lines[:at])) for at in range(len(lines))] == list(Source(text).line_starts)


@given(TEXTS, TEXTS, st.data(), ENCODINGS)
def test_an_edit_is_that_of_the_whole_text(text, new, data, encoding):
    source = Source(text)
    offsets = sorted(data.draw(st.integers(0, len(text))) for _ in range(2))
    start, end = (position_from_offset(source, offset, encoding) for offset in offsets)
    first, last = (offset_from_position(source, place, encoding) for place in (start, end))
    lines = lines_of(text)
    edited(lines, start, end, new, encoding)
    assert lines == lines_of(text[:first] + new + text[last:])


@pytest.mark.parametrize("place", [EditorPosition(9, 0), EditorPosition(1, 99)])
def test_a_place_behind_the_text_is_its_end(place):
    lines = lines_of("a\nb")
    edited(lines, place, place, "c", "utf-16")
    assert lines == ["a\n", "bc"]
