"""How long things take, as far as that can be told before they are played; and what is asked of a library for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from math import inf
from typing import Protocol


@dataclass(frozen=True, slots=True)
class Estimate:
    """How many seconds something takes: on average, at the least and at the most."""

    mean: float
    least: float
    most: float

    @property
    def is_exact(self) -> bool:
        """Return whether it takes the same in all cases, in tenths of a second, as it is told."""
        return f"{self.least:.1f}" == f"{self.most:.1f}"

    def __add__(self, other: Estimate) -> Estimate:
        """Return how long the one and then the other takes."""
        return Estimate(self.mean + other.mean, self.least + other.least, self.most + other.most)

    def times(self, n: float) -> Estimate:
        """Return how long it takes `n` times in a row."""
        return Estimate(self.mean * n, self.least * n, self.most * n)


NO_TIME = Estimate(0.0, 0.0, 0.0)


def exactly(seconds: float) -> Estimate:
    """Return the estimate of what is known."""
    return Estimate(seconds, seconds, seconds)


def mixed(chances: Iterable[tuple[float, Estimate]]) -> Estimate:
    """Return how long it takes if one thing or another happens; each with its chance, in proportion."""
    known = [(chance, one) for chance, one in chances if chance > 0]
    if not known:
        return NO_TIME
    total = sum(chance for chance, _ in known)
    mean = sum(chance * one.mean for chance, one in known) / total
    return Estimate(mean, min(one.least for _, one in known), max(one.most for _, one in known))


def together(estimates: Iterable[Estimate]) -> Estimate:
    """Return how long several things take that begin at the same time."""
    every = [NO_TIME, *estimates]
    return Estimate(max(e.mean for e in every), max(e.least for e in every), max(e.most for e in every))


class Moment(StrEnum):
    """A moment of which it is known where in its motion a graph was."""

    FIRST = "at its first frame"
    BEGUN = "where it begins"
    ARRIVED = "where one arrives from another"
    PASSED = "at its last exit"
    AT = "at a frame that is known"


@dataclass(frozen=True, slots=True, order=True)
class Playing:
    """A motion that a graph plays, and what is known of where in it the graph is.

    Attributes
    ----------
    moment : when that was known. source : if it had arrived then, the motion that it came from.
    held_s : seconds since, in which it has stayed in the motion; infinite, if it may be any number.
    frame : the one that is known, if one is.
    """

    motion: str
    moment: Moment = Moment.BEGUN
    source: str = ""
    held_s: float = inf
    frame: int = 0

    def held(self, time: Estimate) -> Playing:
        """Return what is known after some time; where that is not sure, it may be any."""
        return replace(self, held_s=self.held_s + time.mean if time.least == time.most else inf)


@dataclass(frozen=True, slots=True)
class Trip:
    """A way into a motion.

    Attributes
    ----------
    chance : that this motion is reached first of those that were asked for together.
    takes : until it has been reached. cost : the sum over the transitions, on average.
    on_the_spot : the chance that no way leads there, so that a blend is made.
    """

    motion: str
    chance: float
    takes: Estimate
    cost: float
    on_the_spot: float = 0.0


class Travel(Protocol):
    """What a forecast asks of a library. A `driver` is the graph that plays: the one asked of, or one above it."""

    def soonest(
        self, graph: str, playing: Playing, candidates: tuple[str, ...], driver: str, to_begin: bool = False
    ) -> tuple[Trip, ...]:
        """Return the candidates that may be reached before the others; none if none can be reached.

        Parameters
        ----------
        to_begin : whether they have to be entered where they begin.
        """

    def on_the_spot(self, graph: str, motion: str) -> Trip:
        """Return how a motion is blended into where it begins, as is done where no way leads there."""

    def back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        """Return how a part comes back to what `driver`, a graph above it, plays."""

    def similarity(self, graph: str, above: str, motion: str) -> float:
        """Return the OMS of a motion to that of the graph above; the smaller, the better it fits."""

    def unlikeness(self, graph: str, above: str, motion: str) -> float:
        """Return the same over what is usual on the graph."""

    def to_last_frame(self, driver: str, playing: Playing) -> Estimate:
        """Return how long it takes until the clip's last frame has been shown."""

    def one_pass(self, driver: str, motion: str) -> Estimate:
        """Return how long a motion takes from where it begins to its last exit."""

    def cycle(self, motion: str) -> Estimate:
        """Return how long a motion's clip is."""
