"""The addresses of a script in pieces -> where they are now."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, chain

from mlmg_lang.blocks import Statement
from mlmg_lang.chunks import Chunks, Sums
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Source, Span


@dataclass(frozen=True)
class Places:
    """Where addresses are now.

    Attributes
    ----------
    pieces : statements that stand in no block, and blocks whole.
    lines : the logical lines: the pieces one after the other, those in blocks too.
    files : the addresses of the files that are behind it.
    """

    pieces: Chunks[Statement]
    lines: Chunks[Piece]
    files: range

    @cached_property
    def starts(self) -> Sums:
        """Return where the pieces begin; last, where the script ends."""
        return self.pieces.sums("size")

    @cached_property
    def logical_line_starts(self) -> Sums:
        """Return where `lines` begin, each of which may be several lines of the text; last, where the script ends."""
        return self.lines.sums("size")

    @cached_property
    def first_lines(self) -> Sums:
        """Return the number of the first line of each piece; last, how many lines there are."""
        return self.pieces.sums("n_logical_lines")

    @cached_property
    def rows(self) -> Sums:
        """Return how many line ends of the text there are before each of `lines`; last, in all."""
        return self.lines.sums("n_ends")

    def piece_at(self, offset: int) -> int:
        """Return the number of the piece that an offset is in; the end of the script is in its last."""
        return min(self.starts.last_to(offset), len(self.pieces) - 1)

    def line_at(self, offset: int) -> int:
        """Return the number of the line that an offset is in; the end of the script is in its last."""
        return min(self.logical_line_starts.last_to(offset), len(self.lines) - 1)

    def row(self, number: int) -> int:
        """Return how many line ends there are before a piece."""
        return self.rows[self.first_lines[number]]

    def __call__(self, span: Span) -> Span:
        """Return where a span is now that may begin in one piece, and end in another."""
        if span.start in self.files:
            further = self.starts[-1] + 1 - self.files.start
            return span.shifted(further)
        at = bisect_right(self._addresses, span.start) - 1
        begin, size, start = self._stretches[at]
        further = start - begin
        if span.start <= span.end <= begin + size:
            return span.shifted(further)
        return Span(span.start + further, self(Span(span.end - 1, span.end)).end)

    @cached_property
    def _stretches(self) -> list[tuple[int, int, int]]:
        """Return address, size and place of stretches that stand together, in the order of the addresses."""
        lines = _placed(self.logical_line_starts, self.lines.each(_together, "address"))
        if self.pieces is self.lines:
            return sorted(lines)
        return sorted(chain(lines, _placed(self.starts, self.pieces.each(_own, "address"))))

    @cached_property
    def _addresses(self) -> list[int]:
        return [address for address, _, _ in self._stretches]


def _placed(starts: Sums, stretches: Sequence[Sequence[tuple[int, int, int]]]) -> Iterator[tuple[int, int, int]]:
    """Yield stretches of a script, from those of each chunk with places in that."""
    for start, own in zip(starts.by_chunk, stretches, strict=False):
        yield from ((address, size, start + place) for address, size, place in own)


def _together(pieces: Sequence[Statement], _: str) -> list[tuple[int, int, int]]:
    """Return the stretches of some pieces in a row, each as far as addresses follow each other."""
    found: list[tuple[int, int, int]] = []
    place = 0
    for piece in pieces:
        address, size, start = found[-1] if found else (piece.address, 0, 0)
        if address + size == piece.address:
            found[-1:] = [(address, size + piece.size, start)]
        else:
            found.append((piece.address, piece.size, place))
        place += piece.size
    return found


def _own(pieces: Sequence[Statement], _: str) -> list[tuple[int, int, int]]:
    """Return the stretches of the pieces that have addresses besides those of their lines."""
    starts = accumulate((piece.size for piece in pieces), initial=0)
    found = zip(pieces, starts, strict=False)
    return [(piece.address, piece.size, start) for piece, start in found if piece.has_own_address]


@dataclass(frozen=True)
class Addressed(Source):
    """A source that is asked for addresses in place of offsets."""

    places: Places = field(kw_only=True, compare=False)

    def slice(self, span: Span) -> str:
        """Return the text of a span."""
        return super().slice(self.places(span))

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column of an address."""
        offset = self.places(Span(offset, offset)).start
        if offset > len(self.text):
            return super().position(offset)
        starts, number = self.places.logical_line_starts, self.places.line_at(offset)
        piece = Source(self.text[starts[number] : starts[number + 1]])
        line, column = piece.position(offset - starts[number])
        return self.places.rows[number] + line, column
