"""The typed plan: each expression with the graph it is on and the motions it stands for there.

An expression's type is a set of motions on one graph (`Choice`) or an assignment of such sets to several
graphs (`Layering`). What was played before is not looked at yet.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.planning.names import Kind
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Named:
    """The motions that a name stands for.

    Attributes
    ----------
    name : the library's spelling.
    written : the script's spelling.
    """

    graph: str
    motions: tuple[str, ...]
    name: str
    kind: Kind
    written: str
    span: Span


@dataclass(frozen=True, slots=True)
class Both:
    """The motions that all operands have."""

    graph: str
    motions: tuple[str, ...]
    operands: tuple[Choice, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Either:
    """The motions that one of the operands has."""

    graph: str
    motions: tuple[str, ...]
    operands: tuple[Choice, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class AllBut:
    """The motions of the graph that the operand does not have."""

    graph: str
    motions: tuple[str, ...]
    operand: Choice
    span: Span


Choice: TypeAlias = Named | Both | Either | AllBut
"""A set of motions on one graph, in configuration order."""


@dataclass(frozen=True, slots=True)
class Layer:
    """A choice as a part of a command; `span` has the name of its graph in it, if there is one."""

    choice: Choice
    span: Span

    @property
    def graph(self) -> str:
        """Return the graph that it is on."""
        return self.choice.graph

    @property
    def motions(self) -> tuple[str, ...]:
        """Return the motions that it leaves to choose from."""
        return self.choice.motions


@dataclass(frozen=True, slots=True)
class Layering:
    """A layer for each of several graphs, in the order of the text; `shared`: out of an `and`."""

    layers: tuple[Layer, ...]
    shared: bool = False


@dataclass(frozen=True, slots=True)
class Duration:
    """How long. Of `seconds` and `cycles` one is None; both are if the duration is wrong."""

    seconds: float | None
    cycles: float | None
    span: Span


@dataclass(frozen=True, slots=True)
class Command:
    """A motion expression with its type.

    Attributes
    ----------
    ways : the assignments that the expression allows, the best first. There are several only where an `and`
        is shared out over graphs, and it depends on what plays before which of them rule 1 allows.
    start : the motion that the command is the name of, if it is nothing else.
    """

    ways: tuple[Layering, ...]
    duration: Duration | None
    once: bool
    start: str | None
    span: Span


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass."""

    duration: Duration
    span: Span


@dataclass(frozen=True, slots=True)
class End:
    """Give a body part back to its parent."""

    graph: str
    span: Span


@dataclass(frozen=True, slots=True)
class Repeat:
    """A body that is played several times."""

    count: int
    body: tuple[Statement, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Branch:
    """One of the bodies that `choose` draws from."""

    weight: int
    body: tuple[Statement, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Choose:
    """One branch is drawn and played."""

    branches: tuple[Branch, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Unplanned:
    """A statement that has no type: a mistake is in it, or a definition that is not expanded yet."""

    span: Span


Statement: TypeAlias = Command | Wait | End | Repeat | Choose | Unplanned


@dataclass(frozen=True, slots=True)
class TypedPlan:
    """A script whose names all mean something, or have been reported."""

    statements: tuple[Statement, ...]
