"""A motion graph: the motions of one body part and the transitions between them, as playing sees them.

A *position* in a graph is the frame of a motion that will be shown next. From position f of a motion one can go on to
f + 1, or, where a transition (A_i, B_j) leaves at i = f, show its k blended frames and be at position j + 1 of B.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray

# One transition: from A_i (its first blended frame) to B_j (its last), distance D and its `transition_cost`.
# A graph's transitions are sorted by source motion, source frame, target motion, target frame; searching relies on it.
TRANSITION = np.dtype(
    [
        ("src_motion", "<i4"),
        ("src_frame", "<i4"),
        ("dst_motion", "<i4"),
        ("dst_frame", "<i4"),
        ("distance", "<f8"),
        ("cost", "<f8"),
    ]
)
UNREACHABLE = -1
# So many times sigma, at most, the cost is by the formula; above, 1 - exp(-D / sigma) soon has no digits left.
_FAR = 16.0
# Windows up to five times as far apart as smooth ones (root mean square) make a blend that is seen, but no stumble: so
# many times sigma, at most.
USUAL_BRIDGE = 25.0


class Position(NamedTuple):
    """A place in a graph: the motion's index, and the frame that will be shown next."""

    motion: int
    frame: int


class Transition(NamedTuple):
    """One transition as plain numbers; see `TRANSITION`."""

    src_motion: int
    src_frame: int
    dst_motion: int
    dst_frame: int
    distance: float
    cost: float

    @property
    def arrival(self) -> Position:
        """Return the position after the transition's last blended frame."""
        return Position(self.dst_motion, self.dst_frame + 1)


def transition_cost(distance: FloatArray, sigma: float) -> FloatArray:
    """Return what transitions cost: 1 - exp(-D / sigma) [MLMG], from 0 up to 1, which no cost is.

    Above 36 sigma that is 1 in floating point, and bridges between which a walk has to choose may be that far apart.
    So from 16 sigma on it goes over, without a bend, into 1 - exp(-16) / (1 + D / sigma - 16), which goes on growing
    with D. The two differ by less than 1.2e-7.

    Parameters
    ----------
    distance : array. D of each, not below 0; in the unit of `sigma`.
    """
    times = distance / sigma
    beyond = np.maximum(times - _FAR, 0.0)
    costs = np.where(beyond > 0.0, 1.0 - np.exp(-_FAR) / (1.0 + beyond), -np.expm1(-times))
    return np.minimum(costs, np.nextafter(1.0, 0.0))


@dataclass(frozen=True)
class MotionGraph:
    """The motion graph of one body part; immutable.

    Attributes
    ----------
    name, parent : the graph's name and that of the graph above it (None: the root).
    joints : indices of the graph's joints in the skeleton.
    weights : array, shape (len(joints),). Weights of the joints in the point-cloud distance.
    window : k, the frames of a window and of a transition.
    sigma : the scale of costs, in the unit of distances.
    blend : how transitions are weighted, "c1" or "linear".
    motions : names, in configuration order.
    tags : motion -> tags, in configuration order.
    n_frames : array, shape (n_motions,). Frames of each motion.
    transitions : array of `TRANSITION`, sorted.
    forbidden : array, shape (n_motions, n_motions). Whether the configuration forbids to go from a motion to another.
    oms : array, shape (n_motions, n_motions). Overall motion similarity; smaller means more alike.
    hops : array, shape (n_motions, n_motions). Fewest transitions from a motion to another, or `UNREACHABLE`.
    """

    name: str
    parent: str | None
    joints: tuple[int, ...]
    weights: FloatArray
    window: int
    sigma: float
    blend: str
    motions: tuple[str, ...]
    tags: Mapping[str, tuple[str, ...]]
    n_frames: IntArray
    transitions: np.ndarray[tuple[int], np.dtype[np.void]]
    forbidden: BoolArray
    oms: FloatArray
    hops: IntArray

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Return the index of each motion."""
        return {motion: index for index, motion in enumerate(self.motions)}

    @cached_property
    def usual_oms(self) -> float:
        """Return the median overall motion similarity of two different motions; 0 where there are not two."""
        of_pairs = self.oms[~np.eye(len(self.motions), dtype=bool)]
        return float(np.median(of_pairs)) if len(of_pairs) else 0.0

    @cached_property
    def edges(self) -> tuple[Transition, ...]:
        """Return the transitions as plain numbers, in their order."""
        return tuple(Transition(*row) for row in self.transitions.tolist())

    @cached_property
    def first_exit(self) -> tuple[tuple[int, ...], ...]:
        """Return, for each motion, the frames of its transitions' departures, in order."""
        departures: list[list[int]] = [[] for _ in self.motions]
        for edge in self.edges:
            departures[edge.src_motion].append(edge.src_frame)
        return tuple(map(tuple, departures))

    @cached_property
    def first_edge(self) -> tuple[int, ...]:
        """Return the index of each motion's first transition, and their number at the end."""
        motions = np.arange(len(self.motions) + 1)
        return tuple(np.searchsorted(self.transitions["src_motion"], motions).tolist())

    @cached_property
    def rounds(self) -> dict[tuple[int, frozenset[int]], tuple[Transition, ...] | None]:
        """Return the ways round that `playing.rounds` has found, by motion and what is allowed: it keeps them here."""
        return {}
