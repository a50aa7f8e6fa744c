"""Ways between motions that a test says, in place of those of a library's graphs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest

from mlmg_lang.planning.estimate import Estimate, Playing, Trip, exactly


@dataclass
class SaidTravel:
    """Ways that take what a test says they take: whatever the graph, from one motion to another, in seconds.

    Attributes
    ----------
    takes : (source, target) -> seconds; 1 for others. None: no way leads there.
    chances : target -> the chance that it is reached before the others that are as soon.
    fits : (above, motion) -> OMS; else 1 for the same motion, 2 for others.
    without_begin : motions to whose beginning no way leads.
    """

    takes: Mapping[tuple[str, str], float | None] = field(default_factory=dict)
    chances: Mapping[str, float] = field(default_factory=dict)
    costs: Mapping[tuple[str, str], float] = field(default_factory=dict)
    fits: Mapping[tuple[str, str], float] = field(default_factory=dict)
    without_begin: frozenset[str] = frozenset()
    asked: list[Any] = field(default_factory=list)

    def soonest(
        self, graph: str, playing: Playing, candidates: tuple[str, ...], driver: str, to_begin: bool = False
    ) -> tuple[Trip, ...]:
        self.asked.append((graph, playing, candidates, driver, to_begin))
        known = {motion: self.takes.get((playing.motion, motion), 1.0) for motion in candidates}
        if to_begin:
            known = {motion: time for motion, time in known.items() if motion not in self.without_begin}
        soonest = min((time for time in known.values() if time is not None), default=None)
        first = [motion for motion, time in known.items() if time is not None and time == soonest]
        if not any(motion in self.chances for motion in first):
            first = first[:1]
        total = sum(self.chances.get(motion, 1.0) for motion in first)
        return tuple(
            Trip(
                motion,
                self.chances.get(motion, 1.0) / total,
                exactly(known[motion] or 0.0),
                self.costs.get((playing.motion, motion), 0.0),
            )
            for motion in first
        )

    def on_the_spot(self, graph: str, motion: str) -> Trip:
        return Trip(motion, 1.0, exactly(0.75), 0.0, 1.0)

    def back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        return Trip(above.motion, 1.0, exactly(0.5), 0.25, 1.0)

    def similarity(self, graph: str, above: str, motion: str) -> float:
        return self.fits.get((above, motion), 1.0 if above == motion else 2.0)

    def unlikeness(self, graph: str, above: str, motion: str) -> float:
        return 1.0

    def to_last_frame(self, driver: str, playing: Playing) -> Estimate:
        return exactly(7.0)

    def one_pass(self, driver: str, motion: str) -> Estimate:
        return exactly(5.0)

    def cycle(self, motion: str) -> Estimate:
        return exactly(10.0)


@pytest.fixture
def said() -> type[SaidTravel]:
    """Return what makes ways that take what is said."""
    return SaidTravel


@pytest.fixture(scope="session")
def said_always() -> type[SaidTravel]:
    """Return the same for a whole session, as tests with many examples need it."""
    return SaidTravel
