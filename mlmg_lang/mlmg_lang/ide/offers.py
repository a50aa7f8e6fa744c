"""What is playing, and a graph -> its names that can be had then, the best first."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from math import inf
from typing import NamedTuple, Protocol, TypeAlias

from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.planning.names import Entry, Kind, Names

Asked: TypeAlias = tuple[str, frozenset[str], str | None]
"""A graph, what may be played above it, and the graph beside it as in `Completion`."""


class What(StrEnum):
    """What a completion is."""

    MOTION = "motion"
    TAG = "tag"
    GRAPH = "graph"
    DEFINITION = "definition"
    PARAMETER = "parameter"
    ARGUMENT = "argument"
    FILE = "file"
    WORD = "word"
    UNIT = "unit"


class Completion(NamedTuple):
    """Something that could be written.

    Attributes
    ----------
    text : as it is written, in quotes if it must be or a quote has been written. name : as it is called.
    graph : that the motions of a name are on, or None.
    motions : that it stands for.
    says : a few words about it.
    beside : the graph that what stands left of it and of `and` is on, if the two are shared out over graphs.
    owner : of a parameter, and of an argument's name, the definition that it belongs to, in NFC.
    """

    text: str
    name: str
    what: What
    graph: str | None = None
    motions: tuple[str, ...] = ()
    says: str = ""
    beside: str | None = None
    owner: str = ""


class Fits(Protocol):
    """What goes how well with what is playing."""

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        """Return, by motion of a graph that can be had, how well it fits; the smaller, the better.

        Parameters
        ----------
        above : the motions that the graph above it may play then; of the root, those that it may play itself.
        """


class Ranked(NamedTuple):
    """The names on a graph whose motions can be had, the best first, and how well the motions fit."""

    found: tuple[Completion, ...]
    fits: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Offers:
    """What the names of a library are worth while something is playing. What was asked is kept.

    Attributes
    ----------
    uses : by name, how often it has been used.
    """

    names: Names
    fits: Fits
    uses: Mapping[str, int] = field(default_factory=dict)
    _known: dict[Asked, Ranked] = field(default_factory=dict)
    _listed: dict[tuple[str, str | None], tuple[Completion, ...]] = field(default_factory=dict)

    def on(self, graph: str, above: Collection[str], beside: str | None = None) -> Ranked:
        """Return the names on a graph whose motions can be had, what fits best first, then what is used most.

        Parameters
        ----------
        beside : as in `Completion`.
        """
        key = (graph, frozenset(above), beside)
        found = self._known.get(key)
        if found is None:
            if (graph, beside) not in self._listed:
                self._listed[graph, beside] = tuple(_named(one, graph, beside) for one in self.names.entries(graph))
            fits = self.fits.fits(graph, above)
            found = self._known[key] = Ranked(self._ranked(self._listed[graph, beside], fits), fits)
        return found

    def _ranked(self, listed: Sequence[Completion], fits: Mapping[str, float]) -> tuple[Completion, ...]:
        best = [best_fit(one, fits) for one in listed]
        order = [at for at in sorted(range(len(listed)), key=best.__getitem__) if best[at] < inf]
        if self.uses:
            order.sort(key=lambda at: (best[at], -self.uses.get(listed[at].name, 0)))
        return tuple([listed[at] for at in order])


def _named(entry: Entry, graph: str, beside: str | None) -> Completion:
    what = What.MOTION if entry.kind is Kind.MOTION else What.TAG
    return Completion(script_name(entry.name), entry.name, what, graph, entry.motions, beside=beside)


def best_fit(one: Completion, fits: Mapping[str, float]) -> float:
    """Return how well the best motion of a name fits; infinity if none can be had."""
    motions = one.motions
    if len(motions) == 1:
        return fits.get(motions[0], inf)
    return min((fits[motion] for motion in motions if motion in fits), default=inf)
