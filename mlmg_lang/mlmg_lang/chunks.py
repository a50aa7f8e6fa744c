"""A long sequence of which an edit changes little: what is found out of its values is kept by chunk.

Sequences that come of each other have most chunks in common. So after an edit only the chunks are gone through again
that it touches, and of the others only what has been found out of each as a whole.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, chain, compress, pairwise
from operator import attrgetter
from typing import Any, Final, Generic, TypeVar, overload

T_co = TypeVar("T_co", covariant=True)
S = TypeVar("S")
R = TypeVar("R")
_SIZE: Final = 128
"""So many values a chunk has at first; it has up to twice as many."""


def all_of(values: Iterable[object], attribute: str) -> Iterator[Any]:
    """Chain the tuples that values have as an attribute; most are empty, so that no loop of Python's goes over them."""
    return chain.from_iterable(map(attrgetter(attribute), values))


@dataclass(frozen=True, slots=True)
class _Chunk(Generic[T_co]):
    """Some values in a row. `_kept`: what has been found out of them, by who found it out and of which attribute."""

    values: tuple[T_co, ...]
    _kept: dict[tuple[Callable[..., Any], str], Any] = field(default_factory=dict)

    def find(self, asked: tuple[Callable[[Sequence[T_co], str], R], str]) -> R:
        """Return what a function says of an attribute of the values."""
        kept = self._kept
        if asked not in kept:
            kept[asked] = asked[0](self.values, asked[1])
        found: R = kept[asked]
        return found


class Chunks(Sequence[T_co]):
    """A sequence that never changes; others are made of it, in time that goes by the change and the chunks."""

    def __init__(self, values: Iterable[T_co] = ()) -> None:
        """Take the values."""
        self._chunks = _parted(tuple(values))

    @cached_property
    def _starts(self) -> list[int]:
        """Return the number of the first value of each chunk; last, how many there are."""
        return list(accumulate([len(chunk.values) for chunk in self._chunks], initial=0))

    def __len__(self) -> int:
        """Return how many values there are."""
        return self._starts[-1]

    def __iter__(self) -> Iterator[T_co]:
        """Yield the values."""
        return chain.from_iterable([chunk.values for chunk in self._chunks])

    @overload
    def __getitem__(self, at: int) -> T_co: ...

    @overload
    def __getitem__(self, at: slice) -> tuple[T_co, ...]: ...

    def __getitem__(self, at: int | slice) -> T_co | tuple[T_co, ...]:
        """Return a value, or some in a row."""
        if isinstance(at, slice):
            first, end, _ = at.indices(len(self))
            return tuple(chain.from_iterable(self._stretches(first, end)))
        starts = self._starts
        number = at if at >= 0 else starts[-1] + at
        if not 0 <= number < starts[-1]:
            raise IndexError(f"there is no {at} in {starts[-1]} values")
        chunk = bisect_right(starts, number) - 1
        return self._chunks[chunk].values[number - starts[chunk]]

    def _chunk_of(self, number: int) -> int:
        return bisect_right(self._starts, number) - 1

    def _stretches(self, first: int, end: int) -> Iterator[tuple[T_co, ...]]:
        while first < end:
            chunk = self._chunk_of(first)
            start = self._starts[chunk]
            yield self._chunks[chunk].values[first - start : end - start]
            first = self._starts[chunk + 1]

    # --- others ---

    def spliced(self, first: int, end: int, new: Sequence[S]) -> Chunks[T_co | S]:
        """Return a sequence with other values in place of those from `first` to before `end`."""
        last = max(len(self._chunks) - 1, 0)
        low = min(self._chunk_of(first), last)
        high = min(max(self._chunk_of(end - 1), low), last) + 1
        behind = self._starts[min(high, len(self._chunks))]
        values: tuple[T_co | S, ...] = (*self[self._starts[low] : first], *new, *self[end:behind])
        return _joined((*self._chunks[:low], *_parted(values), *self._chunks[high:]))

    def replaced(self, new: Mapping[int, S]) -> Chunks[T_co | S]:
        """Return a sequence with other values in place of those with these numbers."""
        if not new:
            return self
        chunks: list[_Chunk[T_co | S]] = list(self._chunks)
        changed: dict[int, list[T_co | S]] = {}
        for number, value in new.items():
            chunk = self._chunk_of(number)
            if chunk not in changed:
                changed[chunk] = list(chunks[chunk].values)
            changed[chunk][number - self._starts[chunk]] = value
        for chunk, values in changed.items():
            chunks[chunk] = _Chunk(tuple(values))
        return _joined(tuple(chunks))

    # --- what is found out of the values ---

    # An attribute may also be one of an attribute: `balance.parts`.

    def each(self, work: Callable[[Sequence[T_co], str], R], attribute: str) -> list[R]:
        """Return, by chunk, what a pure function of values and the name of an attribute gives; kept with the chunk."""
        asked = (work, attribute)
        return [chunk.find(asked) for chunk in self._chunks]

    def each_before(self, number: int, work: Callable[[Sequence[T_co], str], R], attribute: str) -> Iterator[R]:
        """Yield what `each` has of the chunks before a value, then what is to be said of those before it in its own."""
        chunk = self._chunk_of(number)
        for whole in self._chunks[:chunk]:
            yield whole.find((work, attribute))
        if number > self._starts[chunk]:
            yield work(self[self._starts[chunk] : number], attribute)

    def all(self, attribute: str) -> Iterator[Any]:
        """Chain the tuples that values have as an attribute: yield all that is in them."""
        return chain.from_iterable(self.each(_all, attribute))

    def sums(self, attribute: str) -> Sums:
        """Return the sums of an attribute, a number, over the values before each; last, over all."""
        return Sums(self._starts, self.each(_sums, attribute))

    def has(self, attribute: str) -> bool:
        """Return whether an attribute is true of any value, as `if` would take it."""
        return any(self.each(_where, attribute))

    def where(self, attribute: str, first: int = 0) -> Iterator[int]:
        """Yield the numbers, from one on, of the values that an attribute is true of."""
        asked = (_where, attribute)
        for chunk in range(self._chunk_of(first), len(self._chunks)):
            start, found = self._starts[chunk], self._chunks[chunk].find(asked)
            yield from (start + at for at in found[bisect_left(found, first - start) :])

    def where_back(self, attribute: str, end: int) -> Iterator[int]:
        """Yield the numbers, before one, of the values that an attribute is true of, the last first."""
        asked = (_where, attribute)
        for chunk in reversed(range(min(self._chunk_of(end) + 1, len(self._chunks)))):
            start, found = self._starts[chunk], self._chunks[chunk].find(asked)
            yield from (start + at for at in reversed(found[: bisect_left(found, end - start)]))

    def where_among(self, attribute: str, wanted: frozenset[str]) -> Iterator[int]:
        """Yield the numbers of the values of which an attribute, a set of words, has one of those that are wanted."""
        for start, chunk, words in zip(self._starts, self._chunks, self.each(_words, attribute), strict=False):
            if not wanted.isdisjoint(words):
                has = attrgetter(attribute)
                yield from (start + at for at, value in enumerate(chunk.values) if not wanted.isdisjoint(has(value)))

    def words(self, attribute: str) -> frozenset[str]:
        """Return the union of an attribute, a set of words, over all values."""
        return frozenset[str]().union(*self.each(_words, attribute))


class Sums(Sequence[int]):
    """The sums of numbers up to before each, that never become less; last, that of all."""

    def __init__(self, starts: Sequence[int], sums: Sequence[Sequence[int]]) -> None:
        """Take the number of the first of each chunk, last how many there are, and the sums in each chunk."""
        self._starts = starts
        self._sums = sums
        self._before = list(accumulate((own[-1] for own in sums), initial=0))

    def __len__(self) -> int:
        """Return how many sums there are."""
        return self._starts[-1] + 1

    def __iter__(self) -> Iterator[int]:
        """Yield the sums."""
        return iter(self[:])

    @overload
    def __getitem__(self, at: int) -> int: ...

    @overload
    def __getitem__(self, at: slice) -> list[int]: ...

    def __getitem__(self, at: int | slice) -> int | list[int]:
        """Return a sum, or some in a row."""
        if isinstance(at, slice):
            first, end, _ = at.indices(len(self))
            return list(chain.from_iterable(self._stretches(first, end)))
        starts = self._starts
        number = at if at >= 0 else starts[-1] + 1 + at
        if not 0 <= number <= starts[-1]:
            raise IndexError(f"there is no {at} in {starts[-1] + 1} sums")
        chunk = bisect_right(starts, number) - 1
        if chunk == len(self._sums):
            return self._before[-1]
        return self._before[chunk] + self._sums[chunk][number - starts[chunk]]

    def _stretches(self, first: int, end: int) -> Iterator[Iterable[int]]:
        while first < min(end, self._starts[-1]):
            chunk = bisect_right(self._starts, first) - 1
            start, behind = self._starts[chunk : chunk + 2]
            own = self._sums[chunk][first - start : min(end, behind) - start]
            yield map(self._before[chunk].__add__, own)
            first = behind
        if first < end:
            yield (self._before[-1],)

    def last_to(self, bound: int) -> int:
        """Return the number of the last sum that is not more than a bound; -1 if there is none."""
        chunk = bisect_right(self._before, bound) - 1
        if chunk == len(self._sums):
            return self._starts[-1]
        if chunk < 0:
            return -1
        return self._starts[chunk] + bisect_right(self._sums[chunk], bound - self._before[chunk]) - 1

    @property
    def by_chunk(self) -> Sequence[int]:
        """Return the sum up to before each chunk; last, that of all."""
        return self._before


def _joined(chunks: tuple[_Chunk[S], ...]) -> Chunks[S]:
    whole = Chunks[S]()
    whole._chunks = chunks
    return whole


def _parted(values: tuple[S, ...]) -> tuple[_Chunk[S], ...]:
    """Return values in chunks of about the same size; no chunk is empty."""
    n_chunks = min(len(values), 1) if len(values) <= 2 * _SIZE else len(values) // _SIZE
    bounds = (len(values) * at // max(n_chunks, 1) for at in range(n_chunks + 1))
    return tuple(_Chunk(values[first:end]) for first, end in pairwise(bounds))


def _all(values: Sequence[object], attribute: str) -> tuple[Any, ...]:
    return tuple(all_of(values, attribute))


def _sums(values: Sequence[object], attribute: str) -> tuple[int, ...]:
    return tuple(accumulate(map(attrgetter(attribute), values), initial=0))


def _where(values: Sequence[object], attribute: str) -> tuple[int, ...]:
    return tuple(compress(range(len(values)), map(attrgetter(attribute), values)))


def _words(values: Sequence[object], attribute: str) -> frozenset[str]:
    return frozenset[str]().union(*map(attrgetter(attribute), values))
