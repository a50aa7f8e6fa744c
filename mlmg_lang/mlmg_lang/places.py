"""The addresses of a script in pieces -> where they are now."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, chain, compress
from operator import attrgetter

from mlmg_lang.blocks import WholeBlock
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Source, Span


def places_of(lines: Sequence[Piece], pieces: Sequence[Piece | WholeBlock], files: range) -> Places:
    """Return where addresses are now; see `Places`."""
    starts = list(accumulate(map(attrgetter("size"), lines), initial=0))
    if len(pieces) == len(lines):
        return Places(pieces, starts, lines, starts, files)
    first_lines = accumulate(map(attrgetter("n_lines"), pieces), initial=0)
    return Places(pieces, [starts[line] for line in first_lines], lines, starts, files)


@dataclass(frozen=True)
class Places:
    """Where addresses are now.

    Attributes
    ----------
    pieces : statements that stand in no block, and blocks whole.
    starts : where they begin; last, where the script ends.
    lines : the pieces that no block lies across. line_starts : where they begin; last, where the script ends.
    files : the addresses of the files that are behind it.
    """

    pieces: Sequence[Piece | WholeBlock]
    starts: Sequence[int]
    lines: Sequence[Piece]
    line_starts: Sequence[int]
    files: range

    def __call__(self, span: Span) -> Span:
        """Return where a span is now that may begin in one piece, and end in another."""
        if span.start in self.files:
            further = self.starts[-1] + 1 - self.files.start
            return Span(span.start + further, span.end + further)
        at = bisect_right(self._addresses, span.start) - 1
        begin, size, start = self._stretches[at]
        further = start - begin
        if span.start <= span.end <= begin + size:
            return Span(span.start + further, span.end + further)
        return Span(span.start + further, self(Span(span.end - 1, span.end)).end)

    @cached_property
    def _stretches(self) -> list[tuple[int, int, int]]:
        """Return the address, the size and the beginning of each piece, in the order of the addresses."""
        lines = _stretches(self.lines, self.line_starts)
        if len(self.pieces) == len(self.lines):
            return sorted(lines)
        own = compress(_stretches(self.pieces, self.starts), map(attrgetter("has_own_address"), self.pieces))
        return sorted(chain(lines, own))

    @cached_property
    def _addresses(self) -> list[int]:
        return [address for address, _, _ in self._stretches]


def _stretches(pieces: Sequence[Piece | WholeBlock], starts: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    return zip(map(attrgetter("address"), pieces), map(attrgetter("size"), pieces), starts, strict=False)


@dataclass(frozen=True)
class Addressed(Source):
    """A source that is asked for addresses in place of offsets."""

    places: Callable[[Span], Span] = field(default=lambda span: span, compare=False)

    def slice(self, span: Span) -> str:
        """Return the text of a span."""
        return super().slice(self.places(span))

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column of an address."""
        return super().position(self.places(Span(offset, offset)).start)
