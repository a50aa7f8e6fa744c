"""The transitions of a graph -> the soonest ways into one of its motions, from everywhere at once.

They are worked out backward: for each transition, how long it takes from there. Of equally soon ways the smoothest
counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.motion_graph import MotionGraph

# Frames + 1j times costs: complex numbers are ordered by their real parts first. Where no way leads, infinite.
Ways: TypeAlias = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, eq=False)
class Exits:
    """The transitions of a graph as they are left one after the other.

    Attributes
    ----------
    key : array, shape (n_transitions,). Motion and frame of the departure as one number, which rises.
    stride : so much the key rises from motion to motion; more than any way takes in frames.
    onward : array. The first transition that can be left after this one has arrived; their number, if there is none.
    wait : array. Frames from the arrival to that.
    """

    key: FloatArray
    stride: float
    onward: IntArray
    wait: FloatArray

    def first(self, motions: IntArray, frames: IntArray) -> IntArray:
        """Return the first transition that leaves each of some motions at a frame or later; their number: none."""
        found = np.searchsorted(self.key, motions * self.stride + frames)
        return np.where(found < np.searchsorted(self.key, (motions + 1) * self.stride), found, len(self.key))


@dataclass(frozen=True, slots=True, eq=False)
class Into:
    """The soonest ways into one motion.

    Attributes
    ----------
    from_exit : array, shape (n_transitions + 1,). From where a transition can be left, whichever is then taken.
    arrival : array of the same shape. The frame that is reached; -1 where no way leads.
    """

    exits: Exits
    from_exit: Ways
    arrival: IntArray

    def ways(self, motions: IntArray, frames: IntArray) -> Ways:
        """Return the ways from positions."""
        first = self.exits.first(motions, frames)
        keys = np.append(self.exits.key, np.inf)
        return np.asarray(self.from_exit[first] + (keys[first] - motions * self.exits.stride - frames))

    def arrivals(self, motions: IntArray, frames: IntArray) -> IntArray:
        """Return the frames that are reached from positions; -1 where no way leads."""
        return self.arrival[self.exits.first(motions, frames)]


def exits_of(graph: MotionGraph) -> Exits:
    """Return the transitions of a graph as they are left."""
    edges = graph.transitions
    longest = int(graph.n_frames.max(initial=0)) + graph.window + 1
    stride = float(longest * (len(edges) + 2))
    key = edges["src_motion"] * stride + edges["src_frame"]
    ends = np.searchsorted(key, (edges["dst_motion"] + 1) * stride)
    onward = np.searchsorted(key, edges["dst_motion"] * stride + edges["dst_frame"] + 1)
    onward = np.where(onward < ends, onward, len(key))
    leaves = np.append(edges["src_frame"], 0)[onward]
    return Exits(key, stride, onward, (leaves - edges["dst_frame"] - 1).astype(float))


def ways_into(graph: MotionGraph, exits: Exits, target: int, to_begin: bool = False) -> Into:
    """Return the soonest ways into a motion; with `to_begin`, to frame k - 1 of it.

    Each round lets ways be one transition longer, so there are as many rounds as the longest way has.
    """
    edges, n = graph.transitions, len(graph.transitions)
    is_into: BoolArray = edges["dst_motion"] == target
    if to_begin:
        is_into &= edges["dst_frame"] == graph.window - 1
    step = graph.window + 1j * edges["cost"]
    taken = np.where(is_into, step, np.inf)
    while True:
        from_exit, choice = _best_exits(edges["src_frame"], edges["src_motion"], taken, exits.stride)
        longer = np.where(is_into, step, step + exits.wait + from_exit[exits.onward])
        if np.array_equal(longer, taken):
            break
        taken = longer
    arrival = np.where(is_into, edges["dst_frame"] + 1, -1)
    while True:
        reached = np.append(arrival[choice[:n]], -1)
        further = np.where(is_into, arrival, reached[exits.onward])
        if np.array_equal(further, arrival):
            return Into(exits, from_exit, np.where(np.isfinite(from_exit.real), reached, -1))
        arrival = further


def _best_exits(frames: IntArray, motions: IntArray, taken: Ways, stride: float) -> tuple[Ways, IntArray]:
    """Return from where each transition can be left the way by the best of it and the later ones, and which that is.

    Parameters
    ----------
    taken : the ways that begin with each transition.
    """
    n = len(taken)
    # Later motions have larger numbers, so a minimum taken from the end on begins anew with each motion.
    reversed_ways = (taken + frames + motions * stride)[::-1]
    best = np.minimum.accumulate(reversed_ways)
    at_end = np.where(reversed_ways == best, np.arange(n)[::-1], n)
    choice = np.minimum.accumulate(at_end)[::-1] if n else at_end
    offsets = (frames + motions * stride)[::-1]
    ways = np.where(best.real < (motions[::-1] + 1) * stride, best - offsets, np.inf)[::-1]
    return np.append(ways, np.inf), choice
