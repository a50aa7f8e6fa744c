"""A script in pieces: what each says, and what it plays; values that are kept while other pieces change.

The places in these values are addresses, which stay what they are wherever a piece comes to stand: those of a script
that is analysed afresh are its offsets, and what is read again later gets addresses that nothing has had. `Places`
says where an address is now.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, chain, pairwise
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

from mlmg_lang.definitions.expand import any_broken, used_names
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.planning import typed

T = TypeVar("T")
Placed = TypeVar("Placed", Token, syntax.Item)


@dataclass(frozen=True)
class Piece:
    """What a piece says.

    Attributes
    ----------
    size : in code points.
    address : of its beginning.
    misread : what is wrong with its text.
    expanded : its items with what is defined put in. n_nodes : how large that has made them.
    statements : none without a library.
    said : what is wrong with what it means.
    """

    size: int
    address: int
    tokens: tuple[Token, ...]
    items: tuple[syntax.Item, ...]
    misread: tuple[Diagnostic, ...]
    expanded: tuple[syntax.Item, ...] = ()
    n_nodes: int = 0
    statements: tuple[typed.Statement, ...] = ()
    said: tuple[Diagnostic, ...] = ()

    @cached_property
    def told(self) -> tuple[Diagnostic, ...]:
        """Return all that is wrong with it."""
        return (*self.misread, *self.said)

    @cached_property
    def solid(self) -> bool:
        """Return whether there is more in it than comments and line ends."""
        return any(token.type not in ("NEWLINE", "COMMENT") for token in self.tokens)

    @cached_property
    def balance(self) -> Balance:
        """Return its parentheses that may have their partners in other pieces."""
        return balance(self.tokens)

    @cached_property
    def speaks(self) -> bool:
        """Return whether one of its comments may be meant for the compiler."""
        return any(token.type == "COMMENT" and "mlmg" in token.text for token in self.tokens)

    @cached_property
    def defining(self) -> tuple[syntax.Item, ...]:
        """Return its items with definitions or the use of a file somewhere in them."""
        return tuple(item for item in self.items if _defines(item))

    @cached_property
    def used(self) -> frozenset[str]:
        """Return the names that its statements use; see `used_names`."""
        return used_names(self.items)

    @cached_property
    def broken(self) -> bool:
        """Return whether some of it could not be read."""
        return any_broken(self.items)


def _defines(item: syntax.Item) -> bool:
    nodes = syntax.walk(item) if isinstance(item, syntax.Repeat | syntax.Choose) else (item,)
    return any(isinstance(node, syntax.Let | syntax.Use) for node in nodes)


def starts_of(pieces: Sequence[Piece]) -> list[int]:
    """Return where pieces begin, and where the last ends."""
    return list(accumulate(map(attrgetter("size"), pieces), initial=0))


def all_of(pieces: Iterable[object], name: str) -> Iterator[Any]:
    """Yield what pieces have in their tuples of a name, as fast as Python can: there are many with nothing in them."""
    return chain.from_iterable(map(attrgetter(name), pieces))


def pieces_of(
    size: int,
    tokens: Sequence[Token],
    items: Sequence[syntax.Item],
    misread: Sequence[Diagnostic],
    address: int = 0,
) -> list[Piece]:
    """Return the pieces of a text, read but not understood.

    Parameters
    ----------
    size : of the text, in code points.
    address : of its beginning; in what is given, that is 0.
    """
    bounds = [0, *cut(tokens).starts, size]
    wrong: list[list[Diagnostic]] = [[] for _ in bounds[1:]]
    for one in misread:
        assert one.span is not None
        wrong[min(bisect_right(bounds, one.span.start), len(wrong)) - 1].append(one)
    parts = zip(pairwise(bounds), _split(tokens, bounds), _split(items, bounds), wrong, strict=True)
    return [
        Piece(end - start, start + address, *_put((own, said, tuple(told)), address))
        for (start, end), own, said, told in parts
    ]


def _put(values: T, address: int) -> T:
    return moved(values, by(address)) if address else values


def _split(values: Sequence[Placed], bounds: Sequence[int]) -> list[tuple[Placed, ...]]:
    """Return values, in the order of the text, by the stretches between bounds that they begin in."""
    places = [value.span.start for value in values]
    at = [bisect_left(places, bound) for bound in bounds]
    return [tuple(values[first:last]) for first, last in pairwise(at)]


@dataclass(frozen=True)
class Places:
    """Where addresses are now.

    Attributes
    ----------
    starts : where the pieces begin; last, where the script ends.
    files : the addresses of the files that are behind it.
    """

    pieces: Sequence[Piece]
    starts: Sequence[int]
    files: range

    def __call__(self, span: Span) -> Span:
        """Return where a span is now that may begin in one piece, and end in another."""
        if span.start in self.files:
            further = self.starts[-1] + 1 - self.files.start
            return Span(span.start + further, span.end + further)
        at = self._order[bisect_right(self._order, span.start, key=self._addresses.__getitem__) - 1]
        further, end = self.starts[at] - self._addresses[at], self._addresses[at] + self.pieces[at].size
        if span.end > end:
            return Span(span.start + further, self(Span(span.end - 1, span.end)).end)
        return Span(span.start + further, span.end + further)

    @cached_property
    def _addresses(self) -> list[int]:
        return list(map(attrgetter("address"), self.pieces))

    @cached_property
    def _order(self) -> list[int]:
        """Return the pieces in the order of their addresses."""
        return sorted(range(len(self.pieces)), key=self._addresses.__getitem__)


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
