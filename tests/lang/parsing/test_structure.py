"""What is said of a script without a library."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.parsing.structure import n_executed
from mlmg_lang.source import Source

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
        ("A\nlet A(t = 1 sec) = WALK for t", []),
        ("A\nlet A(t = 1 sec) = WALK for u", ["MS027"]),
        ("A\nlet A = WALK for 0 sec", ["MS045"]),
        ("A\nlet A = WALK for 86401 sec", ["MS046"]),
        ("let A(x) = not (x with B)", ["MS034"]),
        ("let A(x) = Sub x\nB with A(C)", []),
        ("let A(x) = Sub x\nA(C)", ["MS033"]),
        ("WALK for 2 cycles", []),
        ("WALK for 86400 cycles", []),
        ("WALK for 86401 cycles", ["MS046"]),
        ("WALK for 0 cycles", ["MS045"]),
        ("WALK once", []),
        ("repeat 2 { WALK; wait 1 sec; end A }", []),
        ("repeat 0 { WALK }", ["MS045"]),
        ("repeat 000 { WALK }", ["MS045"]),
        ("repeat 0 { WALK for 0 sec }", ["MS045", "MS045"]),
        ("repeat 2 { }", []),
        ("choose { A }", []),
        ("choose { A | }", []),
        ("choose { 0: A | 1: B }", []),
        ("choose { 0: A | 0: B }", ["MS049"]),
        ("choose { 0: A | B }", []),
        ("choose { 00: }", ["MS049"]),
        ("choose { 0: A for 0 sec }", ["MS049", "MS045"]),
        ("repeat 2 { let A = B }", ["MS015"]),
        ('choose { use "a" | B }', ["MS015"]),
        ("repeat 2 { choose { A | let C = B } }", ["MS015"]),
        ("GREET(A, B)", ["MS028"]),
        ("GREET()", ["MS028"]),
        ("GREET(x = A)", ["MS028"]),
        ("let GREET(a, b) = a with b\nGREET(A, B)", []),
        ('use "more"\nGREET(A, B)', ["MS058"]),
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


# --- how much a script does ---


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("repeat 100000 { A }", []),
        ("repeat 100001 { A }", ["MS048"]),
        ("repeat 50000 { A; B }", []),
        ("repeat 50001 { A; B }", ["MS048"]),
        ("repeat 1000 { repeat 100 { A } }", []),
        ("repeat 1001 { repeat 100 { A } }", ["MS048"]),
        ("repeat 50000 { choose { A; B | C } }", []),
        ("repeat 50001 { choose { C | A; B } }", ["MS048"]),
        ("repeat 1 { repeat 100001 { A } }", ["MS048"]),
        ("repeat 0 { repeat 100001 { A } }", ["MS045", "MS048"]),
        (f"repeat {'9' * 5000} {{ A }}", ["MS048"]),
        (f"repeat {'9' * 5000} {{ }}", []),
        ("repeat 1000000 { repeat 0 { A } }", ["MS045"]),
    ],
)
def test_what_comes_to_too_many_statements_is_told_once_where_it_does(
    script: str, expected: list[str], codes: Codes
) -> None:
    assert codes(script) == expected


def n_of(script: str) -> int:
    return n_executed(analyse(Source(script)).script.items)


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("", 0),
        ("A; wait 1 sec; end B", 3),
        ("repeat 3 { A; repeat 2 { B } }", 9),
        ("repeat 0 { A }; B", 1),
        ("choose { A | B; C | }", 2),
        ("repeat 4 { choose { A | repeat 3 { B } } }; C", 13),
        ("repeat 99999 { repeat 99999 { repeat 99999 { A } } }", 10**9),
    ],
)
def test_the_longest_way_through_a_script_is_counted(script: str, expected: int) -> None:
    assert n_of(script) == expected


def test_a_great_depth_of_loops_is_counted_at_once() -> None:
    assert n_of("repeat 9 { " * 60 + "A" + " }" * 60) == 10**9


# --- with a library ---


@pytest.mark.parametrize("script", ["repeat 2 { WALK }", "choose { WALK | TALK }", "WALK once", "WALK for 2 cycles"])
def test_the_whole_language_is_played(script: str, codes: Codes, reference: Any) -> None:
    assert codes(script, reference) == []
    assert codes(script) == []


def test_names_that_a_used_file_may_define_are_not_told_to_be_unknown(codes: Codes, reference: Any) -> None:
    assert codes('use "more"\nNobody with Upper-Body Knows(them)', reference) == ["MS058"]
    assert codes('use "more"\nNobody with Upper-Body Knows(them)') == ["MS058"]


def test_names_in_a_body_are_looked_up(codes: Codes, reference: Any) -> None:
    assert codes("repeat 2 { choose { WLAK | TALK } }", reference) == ["MS021"]


def test_the_frames_of_a_duration_are_those_of_the_library(codes: Codes, reference: Any) -> None:
    day = 24 * 3600 * 30
    assert codes(f"A\nlet A = IDLE for {day + 1} frames", reference) == ["MS046"]
    assert codes(f"A\nlet A = IDLE for {day} frames", reference) == []
    assert codes(f"IDLE for {day + 1} frames") == []
    assert codes("A\nlet A = IDLE for 0.4 frames", reference) == ["MS045"]
