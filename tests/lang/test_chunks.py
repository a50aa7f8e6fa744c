"""A sequence in chunks is what a list would be, and what is found out of it is found out once a chunk."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from operator import attrgetter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.chunks import Chunks


@dataclass(frozen=True)
class Value:
    size: int

    @property
    def odd(self) -> bool:
        return self.size % 2 == 1

    @property
    def words(self) -> frozenset[str]:
        return frozenset(str(self.size)[:1])

    @property
    def all(self) -> tuple[int, ...]:
        return (self.size, -self.size) if self.size % 3 == 0 else ()


def values(first: int, n: int) -> list[Value]:
    return [Value(at % 23) for at in range(first, first + n)]


CHANGES = st.lists(st.tuples(st.integers(0, 900), st.integers(0, 400), st.integers(0, 400)), max_size=5)
MANY = st.tuples(st.integers(0, 30), st.one_of(st.integers(0, 3), st.integers(0, 900))).map(lambda of: values(*of))


def after(whole: list[Value], changes: Sequence[tuple[int, int, int]]) -> tuple[list[Value], Chunks[Value]]:
    """Return values after some of them have become others, one time after the other, with what chunks make of that."""
    whole, chunks = list(whole), Chunks(whole)
    for at, n_gone, n_new in changes:
        first = at % (len(whole) + 1)
        end, new = min(first + n_gone, len(whole)), values(at, n_new)
        asked(chunks)
        whole[first:end] = new
        chunks = chunks.spliced(first, end, new)
    return whole, chunks


def asked(chunks: Chunks[Value]) -> tuple[list[int], list[int], list[int], frozenset[str]]:
    return list(chunks.sums("size")), list(chunks.where("odd")), list(chunks.all("all")), chunks.words("words")


@given(whole=MANY, changes=CHANGES, first=st.integers(-1000, 1000), end=st.integers(-1000, 1000))
def test_after_any_changes_there_is_what_a_list_would_have(
    whole: list[Value], changes: list[tuple[int, int, int]], first: int, end: int
) -> None:
    whole, chunks = after(whole, changes)
    assert (len(chunks), list(chunks), chunks[first:end]) == (len(whole), whole, tuple(whole[first:end]))
    assert [chunks[at] for at in range(-len(whole), len(whole))] == whole + whole
    for at in (len(whole), -len(whole) - 1):
        with pytest.raises(IndexError):
            chunks[at]


@given(whole=MANY, changes=CHANGES, numbers=st.sets(st.integers(0, 900)))
def test_single_values_become_others(
    whole: list[Value], changes: list[tuple[int, int, int]], numbers: set[int]
) -> None:
    whole, chunks = after(whole, changes)
    asked(chunks)
    new = {number: Value(number + 100) for number in numbers if number < len(whole)}
    replaced = chunks.replaced(new)
    expected = [new.get(at, value) for at, value in enumerate(whole)]
    assert (list(replaced), list(chunks)) == (expected, whole)
    assert asked(replaced) == asked(Chunks(expected))


@given(whole=MANY, changes=CHANGES, at=st.integers(0, 1500))
def test_after_any_changes_the_same_is_found_out(
    whole: list[Value], changes: list[tuple[int, int, int]], at: int
) -> None:
    whole, chunks = after(whole, changes)
    odd = [number for number, value in enumerate(whole) if value.odd]
    assert list(chunks.where("odd", at)) == [number for number in odd if number >= at]
    assert list(chunks.where_back("odd", at)) == [number for number in reversed(odd) if number < at]
    assert chunks.has("odd") == bool(odd)
    assert list(chunks.all("all")) == [one for value in whole for one in value.all]
    assert chunks.words("words") == {word for value in whole for word in value.words}
    wanted = frozenset({"1", "7"})
    assert list(chunks.where_among("words", wanted)) == [n for n, value in enumerate(whole) if value.words & wanted]
    before = chunks.each_before(min(at, len(whole)), total, "size")
    assert sum(before) == sum(value.size for value in whole[:at])


def total(some: Sequence[Value], name: str) -> int:
    return sum(map(attrgetter(name), some))


@given(whole=MANY, changes=CHANGES, bound=st.integers(-2, 12_000), at=st.integers(-1000, 1000))
def test_sums_are_those_of_a_list(whole: list[Value], changes: list[tuple[int, int, int]], bound: int, at: int) -> None:
    whole, chunks = after(whole, changes)
    sums, expected = chunks.sums("size"), list(accumulate((value.size for value in whole), initial=0))
    assert (len(sums), list(sums), sums[at:]) == (len(expected), expected, expected[at:])
    assert [sums[number] for number in range(-len(expected), len(expected))] == expected + expected
    assert sums.last_to(bound) == bisect_right(expected, bound) - 1


def test_after_a_change_only_what_is_around_it_is_gone_through_again() -> None:
    gone_through: list[int] = []

    def count(some: Sequence[Value], name: str) -> int:
        gone_through.append(len(some))
        return len(name)

    chunks = Chunks(values(0, 10_000))
    chunks.each(count, "size")
    assert sum(gone_through) == 10_000
    gone_through.clear()
    for other in (chunks.spliced(5_000, 5_001, values(1, 2)), chunks.replaced({7: Value(1)}), chunks):
        other.each(count, "size")
    assert sum(gone_through) < 600
