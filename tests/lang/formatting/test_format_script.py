"""What the formatter promises of any script, and the canonical form of each construct."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from mlmg_lang.formatting.format_script import format_script
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source

Formatted = Callable[[str], str]
PIECES = [
    *("WALK", "Upper-Body", "with", "and", "or", "not", "for", "once", "10", "sec", "2:", "let", "use", "wait", "end"),
    *("repeat 2 {", "choose {", "repeat", "{", "}", "}", "(", ")", "|", ";", ";", ",", "=", ":", "$", "."),
    *("FOR", '"', '"a b"', '"WALK"', "\n", "\n", "\r\n", "\n\n\n", "# c\n", "\n  # own\n", "\ufeff", "走"),
]


@settings(max_examples=300)
@given(data=st.data())
def test_a_valid_script_keeps_its_meaning_and_comments(
    data: st.DataObject, scripts: SearchStrategy[str], formatted: Formatted
) -> None:
    text = data.draw(scripts)
    source = Source(text)
    assert parse(source, tokenize(source)).diagnostics == ()
    assert format_script(source).whole
    formatted(text)


@settings(max_examples=300)
@given(st.lists(st.sampled_from(PIECES), max_size=30).map(" ".join))
def test_any_words_keep_their_mistakes_and_comments(formatted: Formatted, text: str) -> None:
    formatted(text)


@given(st.text())
def test_any_text_is_formatted_once_and_for_all(formatted: Formatted, text: str) -> None:
    formatted(text)
