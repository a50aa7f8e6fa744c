"""What the formatter promises of any script, and the canonical form of each construct."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from mlmg_lang.formatting.format_script import format_script
from mlmg_lang.front_end import analyse
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source

Formatted = Callable[[str], str]
TESTS = Path(__file__).parents[2]
WRITTEN = sorted((TESTS / "golden" / "formatted").glob("*.ms"))
INVALID = sorted((TESTS / "invalid").glob("*.ms"))
PIECES = [
    *("WALK", "Upper-Body", "with", "and", "or", "not", "for", "once", "10", "sec", "2:", "let", "use", "wait", "end"),
    *("repeat 2 {", "choose {", "repeat", "{", "}", "}", "(", ")", "|", ";", ";", ",", "=", ":", "$", "."),
    *("FOR", '"', '"a b"', '"WALK"', "\n", "\n", "\r\n", "\n\n\n", "# c\n", "\n  # own\n", "\ufeff", "走"),
]


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: path.stem)
def test_each_construct_has_its_form(path: Path, formatted: Formatted, golden: Callable[[Path, str], None]) -> None:
    golden(path.with_suffix(".txt"), formatted(path.read_text(encoding="utf-8")))


def test_no_form_is_left_without_its_script() -> None:
    folder = TESTS / "golden" / "formatted"
    assert {path.stem for path in folder.glob("*.txt")} == {path.stem for path in WRITTEN}


@pytest.mark.parametrize("path", INVALID, ids=lambda path: path.stem)
def test_a_wrong_script_is_told_the_same_when_it_is_formatted(
    path: Path, formatted: Formatted, libraries: Mapping[str, Any]
) -> None:
    text = path.read_bytes().decode("utf-8")
    library = libraries[text.split("\n", 1)[0].removeprefix("# library: ")]
    before, after = (analyse(Source(one), library).diagnostics for one in (text, formatted(text)))
    assert [one.code for one in after] == [one.code for one in before]


def test_a_script_that_is_too_long_to_be_read_stays_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("parsing.tokenize", "formatting.format_script"):
        monkeypatch.setattr(f"mlmg_lang.{module}.MAX_TOKENS", 4)
    kept = format_script(Source("A\n  B\n   C"))
    assert (kept.text, kept.whole) == ("A\n  B\n   C", False)


@settings(max_examples=2 * settings().max_examples)
@given(data=st.data())
def test_a_valid_script_keeps_its_meaning_and_comments(
    data: st.DataObject, scripts: SearchStrategy[str], formatted: Formatted
) -> None:
    text = data.draw(scripts)
    source = Source(text)
    assert parse(source, tokenize(source)).diagnostics == ()
    assert format_script(source).whole
    formatted(text)


@settings(max_examples=4 * settings().max_examples)
@example('WALK } " WALK')
@example('WALK ; " with')
@example("2: { with")
@given(st.lists(st.sampled_from(PIECES), max_size=30).map(" ".join))
def test_any_words_keep_their_mistakes_and_comments(formatted: Formatted, text: str) -> None:
    formatted(text)


@given(st.text())
def test_any_text_is_formatted_once_and_for_all(formatted: Formatted, text: str) -> None:
    formatted(text)
