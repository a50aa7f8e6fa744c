from __future__ import annotations

import math

import pytest

from mlmg_lang.parsing.amounts import SECONDS, UNITS, seconds_from_quantity, spelled, unit_of
from mlmg_lang.parsing.syntax import Quantity
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source, Span


def quantity(number: str, unit: str) -> Quantity:
    return Quantity(number, unit, Span(0, 0))


@pytest.mark.parametrize("unit", UNITS)
def test_every_unit_of_the_table_is_one_of_the_grammar(unit: str) -> None:
    assert [token.type for token in tokenize(Source(f"1 {unit}"))] == ["INTEGER", "UNIT"]


@pytest.mark.parametrize("word", ["secs", "mins", "h", "hour", "Sec", "SEC", "msec", "framess"])
def test_no_other_word_is_a_unit_of_the_grammar(word: str) -> None:
    assert [token.type for token in tokenize(Source(f"1 {word}"))] == ["INTEGER", "NAME"]


@pytest.mark.parametrize(
    ("number", "unit", "seconds"),
    [("10", "sec", 10.0), ("1.5", "minutes", 90.0), ("250", "ms", 0.25), ("45", "frame", 1.5), ("2", "s", 2.0)],
)
def test_a_quantity_lasts_as_long_as_it_says(number: str, unit: str, seconds: float) -> None:
    assert seconds_from_quantity(quantity(number, unit), 30.0) == pytest.approx(seconds)


def test_what_depends_on_the_motion_or_the_library_has_no_length_without_it() -> None:
    assert seconds_from_quantity(quantity("2", "cycles"), 30.0) is None
    assert seconds_from_quantity(quantity("2", "frames"), None) is None


def test_a_number_too_large_is_endless() -> None:
    assert seconds_from_quantity(quantity("9" * 5000, "sec"), None) == math.inf


def test_every_unit_of_seconds_is_the_spelling_that_is_formatted_to() -> None:
    assert {UNITS[unit] for unit in SECONDS} == set(SECONDS)
    assert unit_of(quantity("1", "second")) == "sec"


def test_seconds_are_spelled_without_needless_zeros() -> None:
    assert [spelled(90.0), spelled(1.75), spelled(100.0)] == ["90", "1.75", "100"]
