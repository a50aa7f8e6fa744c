"""What is said of a script without a library."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

Codes = Callable[..., list[str]]


@pytest.mark.parametrize(
    "script",
    [
        "WALK with Upper-Body TALK for 10 sec",
        "Anything with Something (other or else)",
        "END",
        "Upper-Body END",
        "WALK with ONCE",
        "WALK ONCE with TALK",
        "WALK with END TALK",
        "TO or LET",
        "wait 3 minutes; end Left-Hand",
        "WALK with Sub TALK with sub (WAVE and not POINT)",
        "WALK with (TALK and Sub WAVE)",
        "WALK for 24 minutes",
    ],
)
def test_without_a_library_names_may_mean_anything(script: str, codes: Codes) -> None:
    assert codes(script) == []


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("WALK for 0 sec", ["MS045"]),
        ("wait 0.000 frames", ["MS045"]),
        ("WALK for 86400 sec", []),
        ("WALK for 86401 sec", ["MS046"]),
        (f"WALK for {'9' * 400} sec", ["MS046"]),
        ("WALK for sec", ["MS017"]),
        ("WALK for t", ["MS027"]),
        ('wait "10 sec"', ["MS027"]),
        ("let A(t) = WALK for t", ["MS060"]),
        ("let A(t) = WALK for u", ["MS060", "MS027"]),
        ("WALK for 2 cycles", ["MS060"]),
        ("WALK once", ["MS060"]),
        ("repeat 2 { let A = B }", ["MS060", "MS015"]),
        ('choose { use "a" | B }', ["MS060", "MS015"]),
        ("GREET(A, B)", ["MS028"]),
        ("GREET()", ["MS028"]),
        ("GREET(x = A)", ["MS028"]),
        ("let GREET(a, b) = a\nGREET(A, B)", ["MS060"]),
        ('use "more"\nGREET(A, B)', ["MS060"]),
        ("Sub A", ["MS033"]),
        ("A and Sub B", ["MS033"]),
        ("sub (A or B)", ["MS033"]),
        ("end SUB", ["MS033"]),
        ('"Sub" A', []),
        ("not (A with B)", ["MS034"]),
        ("A or (B with C)", ["MS034"]),
        ("((A with B)) and C", ["MS034"]),
        ("G (A with B)", ["MS034"]),
        ("(A with B) with C", []),
        ("WALK ONCE", ["MS011"]),
        ("WALK with TALK ONCE", ["MS011"]),
        ("A and NOT B", ["MS011"]),
        ("End Upper-Body", ["MS011"]),
        ("Wait t", ["MS011"]),
    ],
)
def test_structure_is_checked_without_a_library(script: str, expected: list[str], codes: Codes) -> None:
    assert codes(script) == expected


def test_with_a_library_it_is_known_which_capitals_are_names(catalog: Any, codes: Codes) -> None:
    library = catalog({"WALK": {"a": ("ONCE", "END")}, "NOT": {"a": ("A",)}}, {"NOT": "WALK"}, start="a")
    assert codes("WALK ONCE", library) == []
    assert codes("NOT A", library) == []
    assert codes("END", library) == []
    assert codes("WALK FOR", library) == ["MS011"]


def test_less_than_half_a_frame_is_nothing(codes: Codes, reference: Any) -> None:
    assert codes("IDLE for 16 ms", reference) == ["MS045"]
    assert codes("IDLE for 17 ms", reference) == []
    assert codes("IDLE for 16 ms", replace(reference, frame_rate=60.0)) == []


@pytest.mark.parametrize(
    "script",
    ["let A = B", 'use "more"', "repeat 2 { WALK }", "choose { WALK | TALK }", "WALK once", "WALK for 2 cycles"],
)
def test_what_is_not_played_yet_is_said_once(script: str, codes: Codes, reference: Any) -> None:
    assert codes(script, reference) == ["MS060"]
    assert codes(script) == ["MS060"]


def test_names_of_definitions_are_not_looked_up_in_the_library(codes: Codes, reference: Any) -> None:
    assert codes("let GREET(x) = x\nGREET(Nobody) for 2 sec\nGREET with TALK", reference) == ["MS060"]
    assert codes('use "more"\nNobody with Upper-Body Knows(them)', reference) == ["MS060"]


def test_names_in_a_body_are_looked_up(codes: Codes, reference: Any) -> None:
    assert codes("repeat 2 { choose { WLAK | TALK } }", reference) == ["MS060", "MS060", "MS021"]
