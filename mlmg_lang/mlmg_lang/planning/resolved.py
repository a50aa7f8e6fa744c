"""The resolved plan: what is to be played, in the library's own names. Nothing in it is left to look up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.source import Source, Span


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A motion that a command finds, but cannot take.

    Attributes
    ----------
    reason : `rule 1`, `unreachable` or `later command`.
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
class Command:
    """Bring every layer to one of its candidates, then let `duration_s` pass.

    Attributes
    ----------
    layers : highest graph first; the first is the topmost named.
    duration_s : seconds from when all layers have arrived to the next statement; None without `for`.
    """

    layers: tuple[Layer, ...]
    duration_s: float | None
    span: Span


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass in what is playing."""

    duration_s: float
    span: Span


@dataclass(frozen=True, slots=True)
class End:
    """Give a body part back to its parent."""

    graph: str
    span: Span


Statement: TypeAlias = Command | Wait | End


@dataclass(frozen=True, slots=True)
class ResolvedPlan:
    """A script, ready to be played.

    Attributes
    ----------
    start : the motion of the root graph that the character starts in, at its first frame.
    statements : in the order in which they are executed.
    """

    source: Source
    start: str
    statements: tuple[Statement, ...]
