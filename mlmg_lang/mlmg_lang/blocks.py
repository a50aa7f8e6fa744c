"""Pieces -> the blocks that lie across them: what each says as a whole, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress, pairwise
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import Close
from mlmg_lang.parsing.nesting import NO_STATEMENT, SYNTAX, Make, Nest, Opened
from mlmg_lang.parsing.parse import end_of
from mlmg_lang.parsing.structure import check_blocks, nested_definition
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece

if TYPE_CHECKING:
    from mlmg_lang.planning import typed

T = TypeVar("T")


@dataclass(frozen=True)
class WholeBlock:
    """Pieces from where a block begins that stands in no other to where it ends, or to the end of the script.

    Its tokens and items have addresses of its own if something in it has been read again; all else has those of its
    pieces.

    Attributes
    ----------
    lines : its pieces.
    address : of its beginning.
    """

    lines: tuple[Piece, ...]
    address: int

    solid = True

    @property
    def n_logical_lines(self) -> int:
        """Return how many pieces it is."""
        return len(self.lines)

    @cached_property
    def size(self) -> int:
        """Return how long it is, in code points."""
        return sum(map(attrgetter("size"), self.lines))

    @cached_property
    def has_own_address(self) -> bool:
        """Return whether its pieces do not have the addresses that it would give them."""
        return self.address != self.lines[0].address

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Return its tokens."""
        return tuple(all_of(self._together, "tokens"))

    @cached_property
    def items(self) -> tuple[syntax.Item, ...]:
        """Return its items, the first of which is the block."""
        return _nest(self._together, SYNTAX, "items").found

    @cached_property
    def _together(self) -> Sequence[Piece]:
        """Return its pieces as if they had been read together."""
        return tuple(_readdressed(self.lines, self.address)) if self.has_own_address else self.lines

    @cached_property
    def expanded(self) -> tuple[syntax.Item, ...]:
        """Return its items with what is defined put in."""
        return _nest(self.lines, SYNTAX, "expanded").found

    @cached_property
    def statements(self) -> tuple[typed.Statement, ...]:
        """Return its items with their types."""
        from mlmg_lang.planning.plan import TYPED

        return _nest(self.lines, TYPED, "statements").found

    @cached_property
    def _definitions(self) -> tuple[tuple[syntax.Let | syntax.Use, bool], ...]:
        """Return its definitions, each with whether it stands in a block, as none may."""
        return tuple(_definitions(self.lines)) if any(map(attrgetter("defining"), self.lines)) else ()

    @cached_property
    def defining(self) -> tuple[syntax.Item, ...]:
        """Return the definitions that only stand in braces that nothing takes."""
        return tuple(item for item, is_nested in self._definitions if not is_nested)

    @cached_property
    def told(self) -> tuple[Diagnostic, ...]:
        """Return all that is wrong with it."""
        return (*all_of(self.lines, "told"), *self.told_as_whole)

    @cached_property
    def told_as_whole(self) -> tuple[Diagnostic, ...]:
        """Return what is wrong with it as a whole."""
        nested = (nested_definition(item) for item, is_nested in self._definitions if is_nested)
        braces = _nest(self.lines, SYNTAX, "items").diagnostics
        return (*braces, *nested, *check_blocks(self.expanded))

    @cached_property
    def broken(self) -> bool:
        """Return whether some of it could not be read."""
        return any(map(attrgetter("broken"), self.lines))


Statement: TypeAlias = Piece | WholeBlock
"""What stands in no block."""


def grouped(lines: Chunks[Piece]) -> Chunks[Statement]:
    """Return pieces that stand in no block, and the blocks that lie across the others, of a script read as a whole."""
    found: list[Statement] = []
    done = 0
    for first, end in blocks(lines, 0):
        found += (*lines[done:first], WholeBlock(lines[first:end], lines[first].address))
        done = end
    return Chunks((*found, *lines[done:])) if found else lines


def block_of(lines: tuple[Piece, ...], room: int) -> tuple[WholeBlock, int]:
    """Return a block, and the first address that nothing has had; before it was made, that was `room`."""
    if all(one.address + one.size == other.address for one, other in pairwise(lines)):
        return WholeBlock(lines, lines[0].address), room
    block = WholeBlock(lines, room)
    return block, room + block.size + 1


def blocks(lines: Chunks[Piece], first: int) -> Iterator[tuple[int, int]]:
    """Yield the first piece of each block that stands in no other, and the one behind its last.

    Parameters
    ----------
    first : the piece to begin with, which stands in no block, or begins one.
    """
    depth = 0
    for at in lines.where("marks", first):
        first = first if depth else at
        depth += lines[at].deeper
        if not depth:
            yield first, at + 1
    if depth:
        yield first, len(lines)


def _stretches(lines: Sequence[Piece]) -> Iterator[tuple[Sequence[Piece], Piece | None]]:
    """Yield pieces that no block lies across, as many as stand together, each time with the one behind them."""
    done = 0
    for at in compress(range(len(lines)), map(attrgetter("marks"), lines)):
        yield lines[done:at], lines[at]
        done = at + 1
    yield lines[done:], None


def _nest(lines: Sequence[Piece], make: Make[T, Any], name: str) -> Nest[T]:
    """Return what pieces have in their tuples of a name, in the blocks that it stands in."""
    nest = Nest(make)
    for plain, line in _stretches(lines):
        filled = list(compress(plain, map(attrgetter("items"), plain)))
        if filled:
            nest.add((filled[0].items[0], filled[-1].items[-1]), all_of(filled, name))
        own = iter(getattr(line, name)) if line is not None else iter(())
        for mark in line.marks if line is not None else ():
            if isinstance(mark, NO_STATEMENT):
                nest.take(mark)
            else:
                left_out = name != "items" and isinstance(mark, syntax.Let | syntax.Use)
                nest.add((mark,), () if left_out else (next(own),))
    nest.finish(_end(lines))
    return nest


def _end(lines: Sequence[Piece]) -> int:
    """Return where the last token is that is neither comment nor line end."""
    return next(end_of(line.tokens) for line in reversed(lines) if line.solid)


def _definitions(lines: Sequence[Piece]) -> Iterator[tuple[syntax.Let | syntax.Use, bool]]:
    """Yield definitions, each with whether it stands in a block that has an end: else that was to be before it."""
    opened: list[Opened] = []
    found: list[tuple[syntax.Let | syntax.Use, tuple[Opened, ...]]] = []
    for plain, line in _stretches(lines):
        for mark in (*all_of(plain, "items"), *(() if line is None else line.marks)):
            if isinstance(mark, Opened):
                opened.append(mark)
            elif isinstance(mark, Close):
                opened.pop()
            elif isinstance(mark, syntax.Let | syntax.Use):
                found.append((mark, tuple(opened)))
    endless = set(map(id, opened))
    for item, around in found:
        yield item, any(one.head is not None and id(one) not in endless for one in around)


def _readdressed(lines: Iterable[Piece], address: int) -> Iterator[Piece]:
    """Yield pieces with addresses that follow each other."""
    for line in lines:
        place = by(address - line.address)
        tokens, items, marks = moved((line.tokens, line.items, line.marks), place)
        yield replace(line, address=address, tokens=tokens, items=items, marks=marks)
        address += line.size
