"""A script in pieces: what each says, and what it plays; values that are kept while other pieces change.

The places in these values are addresses, which stay what they are wherever a piece comes to stand: those of a script
that is analysed afresh are its offsets, and what is read again later gets addresses that nothing has had. `Places`
says where an address is now.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, TypeVar

from mlmg_lang.definitions.expand import any_broken, names_in, used_names
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.following import INSTEAD
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.nesting import NO_STATEMENT, Around, Mark, after, folded
from mlmg_lang.parsing.parse import MAX_MISTAKES, Read, counted, read_marks
from mlmg_lang.parsing.structure import check_structure
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.planning import typed

T = TypeVar("T")
Placed = TypeVar("Placed", Token, Mark)
_STATEMENT = frozenset({""})
"""What a block uses by itself; see `used_names`."""


@dataclass(frozen=True)
class Piece:
    """What a piece says that no block lies across: a statement, or a line with braces that have partners in others.

    It is read first; what it means, from `expanded` on, is found out by `understanding`.

    Attributes
    ----------
    size : in code points.
    address : of its first character.
    items : its statements and the blocks that are whole in it; nothing of a block that goes on in other pieces.
    marks : if there is such a block, `items` with its braces, bars and weights between them; else empty.
    around : the braces around it when it was read. If they do not matter (see `depends`), it is not read again when
        there are others, so these may be those of some text long ago.
    misread : the mistakes in its text.
    counted : from how many mistakes are told in texts before it, to how many with its own, when it was read.
    expanded : `items` with what is defined put in. n_nodes : how many nodes that has put in.
    statements : `expanded` with types; empty without a library.
    said : the mistakes in what it means.
    retold : if names of the library are written with spaces in them, what is told in place of `misread` and `said`;
        else None.
    is_faulty : whether names in it may be used wrongly; how they are spelt does not count.
    n_named : how many mistakes in names are told of it; -1 if they were not looked for, as too many are told before it.
    """

    size: int
    address: int
    tokens: tuple[Token, ...]
    items: tuple[syntax.Item, ...]
    marks: tuple[Mark, ...]
    around: Around
    misread: tuple[Diagnostic, ...]
    counted: range
    expanded: tuple[syntax.Item, ...] = ()
    n_nodes: int = 0
    statements: tuple[typed.Statement, ...] = ()
    said: tuple[Diagnostic, ...] = ()
    retold: tuple[Diagnostic, ...] | None = None
    is_faulty: bool = False
    n_named: int = 0

    n_logical_lines = 1
    has_own_address = False

    @cached_property
    def depends(self) -> bool:
        """Return whether it may say something else in other braces."""
        blocks = (isinstance(item, syntax.Repeat | syntax.Choose) for item in self.items)
        # What is not told as too much is wrong may be that it has a brace without a partner.
        return bool(self.misread or self.marks) or self.counted.stop >= MAX_MISTAKES or any(blocks)

    @property
    def n_mistakes(self) -> int:
        """Return how many mistakes in its text are told; see `counted`."""
        return len(self.counted)

    def is_read_behind(self, n_mistakes: int) -> bool:
        """Return whether it says what it does behind so many mistakes too: where some are left, as many are told."""
        first = self.counted.start
        return first == n_mistakes or max(first, n_mistakes) + len(self.counted) < MAX_MISTAKES

    @cached_property
    def n_ends(self) -> int:
        """Return how many line ends there are in it."""
        return sum(token.type == "NEWLINE" for token in self.tokens)

    @cached_property
    def deeper(self) -> int:
        """Return how many more blocks there are around what comes after it than around it."""
        return len(after(self.around, self.marks)) - len(self.around)

    @cached_property
    def told(self) -> tuple[Diagnostic, ...]:
        """Return all that is wrong with it, of the same place what is said by who knows the definitions."""
        if self.retold is not None:
            return self.retold
        known = {one.span for one in self.said if one.code == INSTEAD} if self.misread else ()
        return (*(one for one in self.misread if one.span not in known), *self.said)

    @cached_property
    def solid(self) -> bool:
        """Return whether there is more in it than comments and line ends."""
        return any(token.type not in ("NEWLINE", "COMMENT") for token in self.tokens)

    @cached_property
    def balance(self) -> Balance:
        """Return its parentheses that may have their partners in other pieces."""
        return balance(self.tokens, len(self.around))

    @cached_property
    def miscalls(self) -> bool:
        """Return whether it might call what is not defined, or what cannot be called so."""
        return any(isinstance(node, syntax.Call) for item in self.expanded for node in syntax.walk(item)) and any(
            check_structure(syntax.Script(self.expanded, Span(0, 0)), None)
        )

    @cached_property
    def speaks(self) -> bool:
        """Return whether one of its comments may be meant for the compiler."""
        return any(token.type == "COMMENT" and "mlmg" in token.text for token in self.tokens)

    @cached_property
    def defining(self) -> tuple[syntax.Item, ...]:
        """Return its items with definitions or the use of a file somewhere in them, read or not."""
        return tuple(item for item in self.items if _defines(item))

    @cached_property
    def used(self) -> frozenset[str]:
        """Return the names that its statements use; see `used_names`."""
        return used_names(self.items) | (_STATEMENT if self.marks else frozenset())

    @cached_property
    def names(self) -> frozenset[str]:
        """Return all names in its statements, in NFC; those of graphs too, which may be definitions' by mistake."""
        items = (item for item in self.items if not isinstance(item, syntax.Let | syntax.Use))
        return frozenset(name for item in items for name in names_in(item))

    @cached_property
    def broken(self) -> bool:
        """Return whether some of it could not be read."""
        return any_broken(self.items)


def _defines(item: syntax.Item) -> bool:
    nodes = syntax.walk(item) if isinstance(item, syntax.Repeat | syntax.Choose) else (item,)
    return any(isinstance(node, syntax.Let | syntax.Use | syntax.BrokenDefinition) for node in nodes)


def lines_of(
    size: int, tokens: Sequence[Token], read: Read, around: Around = (), n_before: int = 0, address: int = 0
) -> list[Piece]:
    """Return the pieces of a text that no block lies across, read but not understood.

    Parameters
    ----------
    size : of the text, in code points.
    around : the braces that it stands in. n_before : how many mistakes have been told before it.
    address : of its beginning; in what is given, that is 0.
    """
    bounds = [0, *(() if read.deep else cut(read.narrow, len(around)).starts), size]
    wrong: list[list[Diagnostic]] = [[] for _ in bounds[1:]]
    for one in read.diagnostics:
        assert one.span is not None
        wrong[min(bisect_right(bounds, one.span.start), len(wrong)) - 1].append(one)
    found = []
    parts = zip(pairwise(bounds), _split(tokens, bounds), _split(read.marks, bounds), wrong, strict=True)
    for (start, end), own, marks, told in parts:
        count = counted(n_before, told)
        place = range(start + address, end + address)
        piece = _piece(place, around, count, *_put((own, marks, tuple(told)), address))
        found.append(piece)
        n_before = count.stop
        around = after(around, piece.marks)
    return found


def read_in(line: Piece, text: str, around: Around, n_before: int) -> Piece | None:
    """Return a piece as it is in other braces, or behind other mistakes; None if it is cut elsewhere then.

    The same goes for braces that are too many.
    """
    source = Source(text)
    tokens = tokenize(source)
    read = read_marks(source, tokens, around, n_before)
    again, *others = lines_of(len(text), tokens, read, around, n_before, line.address)
    return None if read.deep or others or again.balance != line.balance else again


def _piece(
    at: range,
    around: Around,
    count: range,
    tokens: tuple[Token, ...],
    marks: tuple[Mark, ...],
    misread: tuple[Diagnostic, ...],
) -> Piece:
    """Return a piece that has these addresses."""
    items = tuple(mark for mark in marks if not isinstance(mark, NO_STATEMENT))
    if len(items) == len(marks):
        return Piece(len(at), at.start, tokens, items, (), around, misread, count)
    marks, wrong = folded(marks)
    items = tuple(mark for mark in marks if not isinstance(mark, NO_STATEMENT))
    marks = () if len(items) == len(marks) else marks
    return Piece(len(at), at.start, tokens, items, marks, around, (*misread, *wrong), count)


def _put(values: T, address: int) -> T:
    return moved(values, by(address)) if address else values


def _split(values: Sequence[Placed], bounds: Sequence[int]) -> list[tuple[Placed, ...]]:
    """Return values, in the order of the text, by the stretches between bounds that they begin in."""
    places = [value.span.start for value in values]
    at = [bisect_left(places, bound) for bound in bounds]
    return [tuple(values[first:last]) for first, last in pairwise(at)]
