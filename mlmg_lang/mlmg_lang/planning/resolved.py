"""The resolved plan: what is to be played, in the library's own names. Nothing in it is left to look up."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.source import Source, Span


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A motion that a command finds, but cannot take.

    Attributes
    ----------
    reason : the name of the rule that says so, see `rules.table`; or `look ahead`.
    because : the same in words, with the graph or line that it is about.
    """

    motion: str
    reason: str
    because: str


@dataclass(frozen=True, slots=True)
class Layer:
    """The motions that a command allows on one graph.

    Attributes
    ----------
    candidates : in configuration order; each allowed by rule 1 for some candidate of the layer above.
    left_out : the others that the command's words stand for.
    """

    graph: str
    candidates: tuple[str, ...]
    span: Span
    left_out: tuple[LeftOut, ...] = ()


@dataclass(frozen=True, slots=True)
class Seconds:
    """So much time."""

    number: float


@dataclass(frozen=True, slots=True)
class Cycles:
    """So many times the length of a motion's clip."""

    number: float


@dataclass(frozen=True, slots=True)
class Once:
    """From a motion's first frame to its last exit."""


Duration: TypeAlias = Seconds | Cycles | Once


@dataclass(frozen=True, slots=True)
class Command:
    """Bring every layer to one of its candidates, then let time pass.

    Attributes
    ----------
    layers : highest graph first; the first is the topmost named.
    duration : from when all layers have arrived to the next statement; None without `for` and `once`.
    """

    layers: tuple[Layer, ...]
    duration: Duration | None
    span: Span


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass in what is playing; cycles are those of the topmost graph of the command before."""

    duration: Seconds | Cycles
    span: Span


@dataclass(frozen=True, slots=True)
class End:
    """Give a body part back to its parent."""

    graph: str
    span: Span


@dataclass(frozen=True, slots=True)
class Repeat:
    """Statements that are executed several times.

    Attributes
    ----------
    body : with all candidates that are taken at some time.
    rounds : the body as it is executed each time, where motions were chosen for each; else none.
    """

    count: int
    body: tuple[Statement, ...]
    span: Span
    rounds: tuple[tuple[Statement, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class Branch:
    """Statements of which it is drawn whether they are executed, against those of other branches."""

    weight: int
    body: tuple[Statement, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Choose:
    """One branch is drawn by its weight and executed."""

    branches: tuple[Branch, ...]
    span: Span


Statement: TypeAlias = Command | Wait | End | Repeat | Choose


@dataclass(frozen=True, slots=True)
class ResolvedPlan:
    """A script, ready to be played.

    Attributes
    ----------
    start : the motion of the root graph that the character starts in, at its first frame.
    statements : in the order of the text, which is that of execution but for `repeat` and `choose`.
    ahead : whether the root graph's candidates have been chosen over the whole script, not command by command.
    """

    source: Source
    start: str
    statements: tuple[Statement, ...]
    ahead: bool = False


def commands(statements: Iterable[Statement]) -> Iterator[Command]:
    """Yield the commands of statements, those in blocks too, in the order of the text."""
    for statement in statements:
        match statement:
            case Command():
                yield statement
            case Repeat(body=body):
                yield from commands(body)
            case Choose(branches):
                yield from (command for branch in branches for command in commands(branch.body))
