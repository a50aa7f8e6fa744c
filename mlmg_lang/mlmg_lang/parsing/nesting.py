"""What stands in and around braces, one after the other -> blocks, each with what is in it.

Statements are put together whatever a stage has made of them: nodes of the syntax tree, or typed statements.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Generic, TypeAlias, TypeVar

from mlmg_lang.diagnostics import Brace, Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import Bar, Close, unclosed
from mlmg_lang.source import Span

T = TypeVar("T")
B = TypeVar("B")


@dataclass(frozen=True, slots=True)
class Braces:
    """What a statement needs to know of the braces around it.

    Attributes
    ----------
    bars : whether `|` parts branches in them.
    in_choose : whether what is in them stands in a `choose`.
    """

    bars: bool
    in_choose: bool


Around: TypeAlias = tuple[Braces, ...]
"""The braces around a place, from the outermost."""


@dataclass(frozen=True, slots=True)
class Opened:
    """A brace that opens a block.

    Attributes
    ----------
    head : None if nothing takes the block: what is in it stands for itself.
    brace : its place. span : with what stands before it.
    braces : what its statements need to know.
    is_told : whether it has been said that it should not be there at all.
    """

    head: syntax.RepeatHead | syntax.ChooseHead | None
    brace: Span
    span: Span
    braces: Braces
    is_told: bool


Mark: TypeAlias = syntax.Item | syntax.Weight | Opened | Bar | Close


@dataclass(frozen=True, slots=True)
class Make(Generic[T, B]):
    """Makes blocks, and what is to stand for a weight that is none."""

    repeat: Callable[[syntax.RepeatHead, tuple[T, ...], Span], T]
    branch: Callable[[syntax.Weight | None, tuple[T, ...], Span], B]
    choose: Callable[[syntax.ChooseHead, tuple[B, ...], Span], T]
    instead: Callable[[syntax.Weight], tuple[T, ...]]


SYNTAX: Final[Make[syntax.Item, syntax.Branch]] = Make(
    syntax.Repeat,
    syntax.Branch,
    syntax.Choose,
    lambda weight: (syntax.Broken(weight.span),),
)


@dataclass(slots=True)
class _Branch(Generic[T]):
    """A branch that is being read, or all that a `repeat` repeats; `first` and `last` are in it."""

    weight: syntax.Weight | None = None
    found: list[T] = field(default_factory=list)
    first: Span | None = None
    last: Span | None = None

    def add(self, spans: tuple[Span, Span], found: Iterable[T]) -> None:
        self.first, self.last = self.first or spans[0], spans[1]
        self.found += found

    def span(self, end: int) -> Span:
        if self.first is None or self.last is None:
            return Span(end, end)
        return Span(self.first.start, self.last.end)


@dataclass(slots=True)
class _Frame(Generic[T]):
    opened: Opened
    branches: list[_Branch[T]] = field(default_factory=lambda: [_Branch()])


_SCRIPT: Final = Opened(None, Span(0, 0), Span(0, 0), Braces(False, False), True)


class Nest(Generic[T]):
    """Puts statements into the blocks that they stand in; what has no block around it is in `found`."""

    def __init__(self, make: Make[T, Any]) -> None:
        """Take what makes blocks."""
        self.diagnostics: list[Diagnostic] = []
        self._make = make
        self._frames: list[_Frame[T]] = [_Frame(_SCRIPT)]

    @property
    def found(self) -> tuple[T, ...]:
        """Return what has no block around it, or stands in one that nothing takes."""
        return tuple(self._frames[0].branches[0].found)

    def add(self, items: Sequence[syntax.Item], found: Iterable[T]) -> None:
        """Add what has been made of some statements, at least one."""
        self._frames[-1].branches[-1].add((items[0].span, items[-1].span), found)

    def take(self, mark: syntax.Weight | Opened | Bar | Close) -> None:
        """Go on with what is not a statement."""
        match mark:
            case Opened():
                self._frames.append(_Frame(mark))
            case Bar():
                self._frames[-1].branches.append(_Branch())
            case Close(span):
                self._end(span.end)
            case syntax.Weight():
                self._weigh(mark)

    def finish(self, end: int) -> None:
        """End the blocks that have no end."""
        while len(self._frames) > 1:
            if not self._frames[-1].opened.is_told:
                self.diagnostics.append(unclosed(self._frames[-1].opened.brace))
            self._end(end)

    def _weigh(self, weight: syntax.Weight) -> None:
        frame = self._frames[-1]
        branch = frame.branches[-1]
        if isinstance(frame.opened.head, syntax.ChooseHead) and branch.weight is None and branch.first is None:
            branch.weight = weight
            branch.first = branch.last = weight.span
            return
        if frame.opened.head is None and len(self._frames) > 1 and branch.first is None:
            return
        message = "a weight stands at the beginning of a branch of `choose { }`"
        self.diagnostics.append(Diagnostic("MS010", message, weight.span, help="take it out", brace=Brace.OUTSIDE))
        branch.add((weight.span, weight.span), self._make.instead(weight))

    def _end(self, end: int) -> None:
        frame = self._frames.pop()
        opened, around = frame.opened, self._frames[-1].branches[-1]
        span = Span(opened.span.start, end)
        match opened.head:
            case syntax.RepeatHead():
                body = tuple(one for branch in frame.branches for one in branch.found)
                around.add((span, span), (self._make.repeat(opened.head, body, span),))
            case syntax.ChooseHead():
                branches = (
                    self._make.branch(branch.weight, tuple(branch.found), branch.span(end)) for branch in frame.branches
                )
                around.add((span, span), (self._make.choose(opened.head, tuple(branches), span),))
            case None:
                for branch in frame.branches:
                    if branch.first is not None and branch.last is not None:
                        around.add((branch.first, branch.last), branch.found)


NO_STATEMENT: Final = (Opened, Bar, Close, syntax.Weight)
"""What stands between statements, and holds them."""


def folded(marks: Iterable[Mark]) -> tuple[tuple[Mark, ...], tuple[Diagnostic, ...]]:
    """Return marks with an item in place of each block that begins and ends among them, and what is wrong in these."""
    found: list[Mark] = []
    opened: list[int] = []
    told: list[Diagnostic] = []
    for mark in marks:
        if isinstance(mark, Opened):
            opened.append(len(found))
        found.append(mark)
        if isinstance(mark, Close) and opened:
            first = opened.pop()
            items, wrong = nested(found[first:], mark.span.end)
            found[first:] = items
            told += wrong
    return tuple(found), tuple(told)


def after(around: Around, marks: Iterable[Mark]) -> Around:
    """Return the braces around what comes after some marks."""
    for mark in marks:
        if isinstance(mark, Opened):
            around = (*around, mark.braces)
        elif isinstance(mark, Close):
            around = around[:-1]
    return around


def nested(marks: Iterable[Mark], end: int) -> tuple[tuple[syntax.Item, ...], tuple[Diagnostic, ...]]:
    """Return the items that marks stand for, and what is wrong with how they stand; blocks without an end end there."""
    nest = Nest(SYNTAX)
    for mark in marks:
        if isinstance(mark, NO_STATEMENT):
            nest.take(mark)
        else:
            nest.add((mark,), (mark,))
    nest.finish(end)
    return nest.found, tuple(nest.diagnostics)
