"""Whether a text is open: whether Enter should begin another line of it."""

import pytest

from mlmg_lang.ide.cursor import cursor_at, is_open
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


@pytest.mark.parametrize(
    "text",
    ["repeat 2 {", "repeat 2 {\nWALK", "WALK with (TALK", "(", "choose { WALK | IDLE", "repeat 2 { choose { A }"],
)
def test_braces_and_parentheses_that_are_not_closed_hold_a_text_open(text: str) -> None:
    assert is_open(tokenize(Source(text)))


@pytest.mark.parametrize("text", ["", "WALK", "repeat 2 { WALK }", "WALK )", "}", "(;", "# (", '"("', "(a) {}"])
def test_other_texts_are_not_open(text: str) -> None:
    assert not is_open(tokenize(Source(text)))


def test_the_statement_of_a_cursor_begins_after_what_ends_the_one_before() -> None:
    def before(text: str) -> list[str]:
        cursor = cursor_at(tokenize(Source(text)), len(text))
        assert cursor is not None
        return [token.text for token in cursor.before]

    assert before("IDLE; WALK with ") == ["WALK", "with"]
    assert before("IDLE\nWALK with\n") == []
    assert before("WALK\nwith ") == ["WALK", "with"]
    assert before("repeat 2 { IDLE } WALK ") == ["WALK"]
    assert before("choose { 2: IDLE | WALK ") == ["WALK"]
    assert before("WALK with (Upper-Body\n") == ["WALK", "with", "(", "Upper-Body"]
