from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.formatting.exact_names import with_exact_names
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source, Span


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ("walk01 with upper_body talk", "Walk_01 with Upper-Body TALK"),
        ("WALK with sub talk  # walk", "WALK with Sub TALK  # walk"),
        ("end upper-body\nwalk-01", "end Upper-Body\nWalk_01"),
        ("WALK", "WALK"),
        ("wlak; walk ONCE", "wlak; walk ONCE"),
    ],
)
def test_names_are_spelt_as_in_the_library(text: str, exact: str, reference: Any) -> None:
    source = Source(text, "a.ms")
    assert with_exact_names(source, analyse(source, reference).diagnostics) == Source(exact, "a.ms")


def inexact(start: int, end: int, name: str) -> Diagnostic:
    return Diagnostic("MS020", "", Span(start, end), fixes=(Fix(Span(start, end), name, safe=True),))


def test_a_name_that_is_offered_two_spellings_keeps_its_own() -> None:
    assert with_exact_names(Source("ab cd"), [inexact(0, 2, "AB"), inexact(0, 2, "Ab")]) == Source("ab cd")
    assert with_exact_names(Source("ab cd"), [inexact(3, 5, "CD"), inexact(0, 2, "AB")]) == Source("AB CD")


def test_names_in_other_files_and_other_mistakes_are_left() -> None:
    other = Diagnostic("MS021", "", Span(0, 2), fixes=(Fix(Span(0, 2), "AB", safe=True),))
    assert with_exact_names(Source("ab"), [other, inexact(3, 5, "CD")]) == Source("ab")


def test_formatting_after_it_finds_nothing_more_to_spell(formatted: Callable[[str], str], reference: Any) -> None:
    source = Source('"walk01" with upper_body(talk);repeat 2 { idle }')
    exact = with_exact_names(source, analyse(source, reference).diagnostics)
    text = formatted(exact.text)
    assert text == "Walk_01 with Upper-Body (TALK)\nrepeat 2 {\n    IDLE\n}\n"
    assert with_exact_names(Source(text), analyse(Source(text), reference).diagnostics).text == text
