"""What definitions take, told by how it is used; and which are in terms of themselves."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.definitions.parameters import references, signatures
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Source


def read(script: str) -> Analysis:
    return analyse(Source(script))


def kinds(script: str, name: str = "A") -> dict[str, str | None] | None:
    """Return the kinds of what a definition takes; None if it has a mistake."""
    signature = read(script).definitions.signatures.get(name)
    return None if signature is None else {name: kind and kind.value for name, kind in signature.kinds.items()}


# --- kinds ---


@pytest.mark.parametrize(
    ("lets", "expected"),
    [
        ("let A = WALK", {}),
        ("let A() = WALK", {}),
        ("let A(x) = x", {"x": "motion"}),
        ("let A(x) = not (WALK or Upper-Body x)", {"x": "motion"}),
        ("let A(t) = WALK for t", {"t": "duration"}),
        ("let A(x, t) = x for t", {"x": "motion", "t": "duration"}),
        ("let A(x) = WALK", {"x": None}),
        ("let A(x = TALK) = WALK", {"x": "motion"}),
        ("let A(t = 2 sec) = WALK", {"t": "duration"}),
        ("let A(x) = B(x)\nlet B(y) = y", {"x": "motion"}),
        ("let A(x) = B(x)\nlet B(t) = WALK for t", {"x": "duration"}),
        ("let A(x) = B(y = x)\nlet B(t = 1 sec, y = TALK) = y", {"x": "motion"}),
        ("let A(x) = B(C(x))\nlet B(y) = y\nlet C(z) = z", {"x": "motion"}),
        ("let A(x) = B((x))\nlet B(t) = WALK for t", {"x": "motion"}),
        ("let A(x) = B(x)\nlet B(y) = WALK", {"x": None}),
        ("let A(x) = B(x, x)\nlet B(y, z) = WALK with z", {"x": "motion"}),
        ("let A(x) = B(x, x)\nlet B(y) = WALK", {"x": None}),
        ("let A(x) = B(x)\nlet B(y) = C(y)\nlet C(t) = WALK for t", {"x": "duration"}),
        ("let A(x) = Upper-Body (x)", {"x": "motion"}),
        ("let A(caf\u00e9) = cafe\u0301", {"caf\u00e9": "motion"}),
        ("let A(s) = WALK for s", {"s": "duration"}),
    ],
)
def test_the_kind_of_a_parameter_is_told_by_how_it_is_used(lets: str, expected: Mapping[str, str | None]) -> None:
    assert kinds(lets) == expected


def test_what_says_how_long_is_a_whole_statement() -> None:
    found = read("let A = WALK\nlet B = WALK for 1 sec\nlet C = WALK once\nlet D(t) = WALK for t").definitions
    assert {name: signature.lasts for name, signature in found.signatures.items()} == {
        "A": False,
        "B": True,
        "C": True,
        "D": True,
    }


@pytest.mark.parametrize(
    ("lets", "codes", "places"),
    [
        ("let A(x) = WALK", ["MS054"], ["x"]),
        ("let A(x = TALK) = WALK", ["MS054"], ["x"]),
        ("let A(t = 2 sec) = WALK", ["MS054"], ["t"]),
        ("let A(x, y, z) = y", ["MS054", "MS054"], ["x", "z"]),
        ("let A(x) = x for x", ["MS056"], ["x"]),
        ("let A(x = 2 sec) = x", ["MS056"], ["x"]),
        ("let A(x = TALK) = WALK for x", ["MS056"], ["x"]),
        ("let A(x, y) = B(x, y) with x\nlet B(t, y) = y for t", ["MS056"], ["x"]),
        ("let A(x, x) = x", ["MS050"], ["x"]),
        ("let A(x, y, x, x) = x with y", ["MS050", "MS050"], ["x", "x"]),
        ("let A(\u00e9, e\u0301) = \u00e9", ["MS050"], ["e\u0301"]),
    ],
)
def test_what_is_wrong_with_parameters_is_told_where_they_stand(lets: str, codes: list[str], places: list[str]) -> None:
    analysis = read(lets + "\nA; B")
    found = [one for one in analysis.diagnostics if one.span and one.code in ("MS050", "MS054", "MS056")]
    assert [one.code for one in found] == codes
    assert [analysis.source.slice(one.span) for one in found if one.span] == places
    assert ("A" in analysis.definitions.signatures) == (set(codes) == {"MS054"})


def test_a_definition_with_a_mistake_is_not_blamed_where_it_is_used() -> None:
    script = "let A(x) = x for x\nA(WALK, TALK)\nWALK with A\nlet B = A(WALK)\nB"
    assert [one.code for one in read(script).diagnostics] == ["MS056"]


def test_what_one_uses_has_to_be_known_only_in_the_end() -> None:
    chain = "\n".join(f"let A{n}(x) = A{n + 1}(x)" for n in range(2_000))
    assert kinds(f"{chain}\nlet A2000(t) = WALK for t", "A0") == {"x": "duration"}


def test_the_names_in_a_definition_are_those_that_are_not_its_own() -> None:
    (let,) = read("let A(x, y = C) = B(x, D) with Upper-Body E for t").script.items
    assert isinstance(let, syntax.Let)
    assert [name.text for name in references(let)] == ["C", "B", "D", "E"]


# --- circles ---


LINKS = st.integers(1, 7).flatmap(
    lambda number: st.lists(st.sets(st.integers(0, number - 1), max_size=3), min_size=number, max_size=number)
)


def reached(start: int, links: list[set[int]]) -> set[int]:
    """Return what one comes to from somewhere, by one step or more."""
    found: set[int] = set()
    pending = list(links[start])
    while pending:
        one = pending.pop()
        if one not in found:
            found.add(one)
            pending += links[one]
    return found


@given(LINKS)
def test_a_definition_is_in_a_circle_if_it_leads_to_itself(links: list[set[int]]) -> None:
    lines = [f"let A{n} = {' or '.join(['WALK', *(f'A{other}' for other in to)])}" for n, to in enumerate(links)]
    analysis = read("\n".join([*lines, *(f"A{n} for 1 sec" for n in range(len(links)))]))
    circling = {n for n in range(len(links)) if n in reached(n, links)}
    assert set(analysis.definitions.signatures) == {f"A{n}" for n in range(len(links)) if n not in circling}
    assert {one.code for one in analysis.diagnostics} == ({"MS051"} if circling else set())
    ways = [[int(name) for name in re.findall(r"`A(\d+)`", one.message)] for one in analysis.diagnostics]
    for way in ways:
        named, *steps = way
        steps = steps or [named, named]  # one that leads to itself at once is named once
        assert steps[0] == steps[-1] == named
        assert all(after in links[before] for before, after in pairwise(steps))
    assert len({frozenset(way) for way in ways}) == len(ways)
    told = {one for way in ways for one in way}
    assert all(told & reached(n, links) for n in circling)


@pytest.mark.parametrize(
    ("lets", "messages"),
    [
        ("let A = A", ["`A` is defined in terms of itself"]),
        ("let A = B\nlet B = A", ["`A` is defined in terms of itself: `A` -> `B` -> `A`"]),
        ("let A = B\nlet B = B", ["`B` is defined in terms of itself"]),
        ("let A(x) = A(x)", ["`A` is defined in terms of itself"]),
        ("let A(x = A) = x", ["`A` is defined in terms of itself"]),
        ("let A(A) = A", []),
        ("let A(B) = B\nlet B(A) = A", []),
        ("let A(x) = B(x)\nlet B(x) = Upper-Body A(x)", ["`A` is defined in terms of itself: `A` -> `B` -> `A`"]),
    ],
)
def test_a_circle_is_told_with_its_way(lets: str, messages: list[str]) -> None:
    assert [one.message for one in read(lets).diagnostics if one.code == "MS051"] == messages


def test_a_circle_shows_where_the_others_are() -> None:
    analysis = read("A\nlet A = B\nlet B = C\nlet C = A")
    (one,) = analysis.diagnostics
    places = [analysis.source.position(note.span.start) for note in one.notes if note.span]
    assert [note.message for note in one.notes] == ["`B` is defined here", "`C` is defined here"]
    assert places == [(3, 5), (4, 5)]


@pytest.mark.parametrize(
    ("lets", "count"),
    [
        ("\n".join(f"let A{n} = A{(n + 1) % 2_000}" for n in range(2_000)), 1),
        ("\n".join(f"let A{n} = A{n + 1}" for n in range(2_000)) + "\nlet A2000 = A2000", 1),
        ("let A0 = A0\n" + "\n".join(f"let A{n + 1} = A{n}" for n in range(2_000)), 1),
        ("\n".join(f"let A{n} = " + " or ".join(f"A{m}" for m in range(60)) for n in range(60)), 60),
    ],
)
def test_circles_among_many_are_found(lets: str, count: int) -> None:
    assert sum(one.code == "MS051" for one in read(lets).diagnostics) == count


def test_signatures_say_nothing_of_no_definitions() -> None:
    assert signatures({}) == ({}, ())
