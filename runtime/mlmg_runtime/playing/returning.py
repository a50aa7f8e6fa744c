"""Leading a body part back to the very motion and frame that the graph above it plays (rule 2).

For one output frame after the other it is worked out at which frames of its graph the part can be, and at what cost;
all frames of the graph at once, since where there are many transitions there are far too many paths to follow.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.arrays import BoolArray, IntArray
from mlmg_runtime.motion_graph import MotionGraph, Position, Transition
from mlmg_runtime.playing.timeline import Clip, Segment, play_transition

# A clip may be played a fifth faster or slower: whatever it then shows is made up of these output and source frames.
_STEPS = ((1, 1), (5, 4), (5, 6))
_N_BLANKS = max(n_source for _, n_source in _STEPS)

# The costs of a way, as complex numbers, which are ordered by their real parts first: the sum of its transitions' costs
# + 1j times the frames by which its clips are stretched or shortened.
_Costs: TypeAlias = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class _Frames:
    """The frames of a graph's motions in a row, and the transitions between them.

    Attributes
    ----------
    first : array, shape (n_motions + 1,). The number of each motion's first frame; at the end that of all frames.
    is_blank : array. After each motion come blanks, where nothing can be, so that no step leads into the next motion.
    sources, targets : arrays, shape (n_transitions,). The frames that transitions leave, and those shown after them.
    """

    first: IntArray
    is_blank: BoolArray
    sources: IntArray
    targets: IntArray

    def number(self, position: Position) -> int:
        """Return the number of a position in the row."""
        return int(self.first[position.motion]) + position.frame

    def position(self, number: int) -> Position:
        """Return the position with a number."""
        motion = int(np.searchsorted(self.first, number, side="right")) - 1
        return Position(motion, number - int(self.first[motion]))


@dataclass(frozen=True, slots=True)
class _Step:
    """The last step to a frame: from frame `source` by some frames of a clip, or by a transition."""

    source: int
    n_output: int
    n_source: int
    cost: complex
    edge: Transition | None = None


def find_return(
    graph: MotionGraph, position: Position, time: int, above: Sequence[Clip], deadline: int
) -> tuple[Segment, ...] | None:
    """Return the soonest way back, or None if there is none by the deadline.

    The way is a path in the part's own graph that is at the motion and frame of the graph above at the same time, the
    speed of its clips bent by at most a fifth. Of equally soon ways the smoothest, then the least bent.

    It takes 16 bytes for each frame of the graph and each output frame up to the meeting.

    Parameters
    ----------
    position, time : where the part is in its graph, and the output frame from which on.
    above : what the graph above plays meanwhile at its own speed; motions as indices of `graph`.
    deadline : the latest output frame at which the two may meet.
    """
    frames = _frames(graph)
    costs: list[_Costs] = []
    for places in _places(frames, time, above, deadline):
        costs.append(_onward(graph, frames, costs) if costs else _at(frames, position))
        reached = [place for place in places if np.isfinite(costs[-1][place])]
        if reached:
            meets = reached[int(np.argmin(costs[-1][reached]))]
            return _segments(frames, graph.window, time, reversed(_trace_back(graph, frames, costs, meets)))
    return None


def _frames(graph: MotionGraph) -> _Frames:
    first = np.concatenate(([0], np.cumsum(graph.n_frames + _N_BLANKS)))
    is_blank = np.arange(first[-1]) >= np.repeat(first[:-1] + graph.n_frames, graph.n_frames + _N_BLANKS)
    edges = graph.transitions
    sources = first[edges["src_motion"]] + edges["src_frame"]
    targets = first[edges["dst_motion"]] + edges["dst_frame"] + 1
    return _Frames(first, is_blank, sources, targets)


def _places(frames: _Frames, time: int, above: Sequence[Clip], deadline: int) -> Sequence[Sequence[int]]:
    """Return where the graph above is in each output frame from `time` on; where two clips meet, it is at both."""
    places: list[list[int]] = [[] for _ in range(time, deadline + 1)]
    for clip in above:
        for moment in range(max(clip.begin, time), min(clip.end, deadline) + 1):
            places[moment - time].append(frames.number(clip.first) + moment - clip.begin)
    return places


def _at(frames: _Frames, position: Position) -> _Costs:
    """Return the costs of being at each frame where one is at `position`."""
    costs = np.full(len(frames.is_blank), np.inf, np.complex128)
    costs[frames.number(position)] = 0.0
    costs[frames.is_blank] = np.inf
    return costs


def _onward(graph: MotionGraph, frames: _Frames, costs: Sequence[_Costs]) -> _Costs:
    """Return the least costs of being at each frame one output frame after the last of `costs`; inf: one cannot."""
    onward = np.full(len(frames.is_blank), np.inf, np.complex128)
    for n_output, n_source in _STEPS:
        if n_output <= len(costs):
            before = costs[-n_output][:-n_source] + 1j * abs(n_output - n_source)
            np.minimum(onward[n_source:], before, out=onward[n_source:])
    if graph.window <= len(costs):
        before = costs[-graph.window][frames.sources]
        taken = np.flatnonzero(np.isfinite(before))
        np.minimum.at(onward, frames.targets[taken], before[taken] + graph.transitions["cost"][taken])
    onward[frames.is_blank] = np.inf
    return onward


def _trace_back(graph: MotionGraph, frames: _Frames, costs: Sequence[_Costs], meets: int) -> Sequence[_Step]:
    """Return the steps of the cheapest way to the frame `meets` in the last of `costs`, the last step first."""
    steps: list[_Step] = []
    time, at = len(costs) - 1, meets
    while time > 0:
        # The sums are those by which `costs` were made, so that they are equal to the last bit.
        step = next(
            step
            for step in _last_steps(graph, frames, at)
            if step.n_output <= time and costs[time - step.n_output][step.source] + step.cost == costs[time][at]
        )
        steps.append(step)
        time, at = time - step.n_output, step.source
    return steps


def _last_steps(graph: MotionGraph, frames: _Frames, at: int) -> Iterator[_Step]:
    """Yield all steps that lead to a frame."""
    for n_output, n_source in _STEPS:
        if n_source <= at:
            yield _Step(at - n_source, n_output, n_source, 1j * abs(n_output - n_source))
    for number in np.flatnonzero(frames.targets == at):
        edge = graph.edges[number]
        yield _Step(int(frames.sources[number]), graph.window, 0, complex(edge.cost), edge)


def _segments(frames: _Frames, window: int, time: int, steps: Iterable[_Step]) -> tuple[Segment, ...]:
    """Return steps in a row as segments; all steps in a clip as one, so that it is bent evenly."""
    segments: list[Segment] = []
    for step in steps:
        last, end = segments[-1] if segments else None, time + step.n_output
        if step.edge is not None:
            segments.append(play_transition(time, step.edge, window))
        elif isinstance(last, Clip):
            segments[-1] = replace(last, end=end, n_source=last.n_source + step.n_source)
        else:
            segments.append(Clip(time, end, frames.position(step.source), step.n_source))
        time = end
    return tuple(segments)
