"""Positions are counted as the client asked, on texts that break naive counting."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.source import Source, Span
from mlmg_lsp.positions import EditorPosition, offset_from_position, position_from_offset, range_from_span

TEXT = "IDLE\r\n😀 走路\u2028TALK\tx\rlast"


@pytest.mark.parametrize(("encoding", "character"), [("utf-8", 4 + 1 + 3), ("utf-16", 2 + 1 + 1), ("utf-32", 3)])
def test_a_place_behind_an_emoji_is_counted_in_the_units_agreed_on(encoding, character):
    offset = TEXT.index("路")
    assert position_from_offset(Source(TEXT), offset, encoding) == EditorPosition(1, character)


def test_a_unicode_line_separator_ends_no_line():
    assert position_from_offset(Source(TEXT), TEXT.index("x"), "utf-32") == EditorPosition(1, 10)


def test_a_position_past_a_lines_end_means_its_end_and_past_the_text_the_texts():
    source = Source(TEXT)
    assert offset_from_position(source, EditorPosition(0, 99), "utf-16") == len("IDLE")
    assert offset_from_position(source, EditorPosition(99, 0), "utf-16") == len(TEXT)


def test_a_position_inside_a_character_means_its_beginning():
    assert offset_from_position(Source(TEXT), EditorPosition(1, 1), "utf-16") == TEXT.index("😀")


def test_an_empty_text_has_one_position():
    assert range_from_span(Source(""), Span(0, 0), "utf-16") == (EditorPosition(0, 0), EditorPosition(0, 0))


@given(st.text(alphabet="aé走😀\t\r\n\u2028\x0c\x85", max_size=30), st.data())
def test_there_and_back_is_the_same_offset(text, data):
    source = Source(text)
    offset = data.draw(st.integers(0, len(text)))
    for encoding in ("utf-8", "utf-16", "utf-32"):
        there = position_from_offset(source, offset, encoding)
        back = offset_from_position(source, there, encoding)
        # Between the CR and the LF of a line end there is no position of an editor's.
        assert back == offset or text[offset - 1 : offset + 1] == "\r\n"
