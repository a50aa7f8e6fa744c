"""What a rule says of a command: which candidates are out, or what keeps it from being obeyed at all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.planning.flow import Setter
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Out:
    """A motion that a command cannot take on a graph, and why not."""

    graph: str
    motion: str
    because: str


@dataclass(frozen=True, slots=True)
class Narrow:
    """Earlier commands have to do without some of their candidates, from which this one could not go on.

    Attributes
    ----------
    without : by what set them, the motions.
    graph : on which this one could not go on.
    """

    without: Mapping[Setter, frozenset[str]]
    graph: str


@dataclass(frozen=True, slots=True)
class Stopped:
    """A command that cannot be obeyed.

    Attributes
    ----------
    graph : on which nothing is left.
    span : of what it should do there.
    wanted : the motions that it could take there.
    above : the graph whose motions stand in the way, `graph` itself if it runs already.
    motions : those motions.
    by_rule_1 : whether rule 1 forbids it; else nothing can be reached.
    setter : the earlier statement that the motions come from; None if they are this one's, or of the start.
    within : whether they are this command's own, or may be anything, as after a statement with a mistake.
    """

    graph: str
    span: Span
    wanted: tuple[str, ...]
    above: str
    motions: tuple[str, ...]
    by_rule_1: bool
    setter: Setter | None
    within: bool


Hindrance: TypeAlias = Narrow | Stopped
Ruling: TypeAlias = tuple[Out, ...] | Narrow | Stopped
"""The candidates that are out, if a command can be obeyed without them."""
