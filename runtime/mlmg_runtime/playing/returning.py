"""Leading a body part back to the very motion and frame that the graph above it plays (rule 2)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from math import ceil, floor, inf
from typing import NamedTuple

from mlmg_runtime.motion_graph import MotionGraph, Position, Transition
from mlmg_runtime.playing.timeline import Clip, Segment, play_transition

# A clip may be played this much faster or slower to meet the graph above.
LARGEST_BEND = 0.2


class _Landing(NamedTuple):
    """When a path can have ended: with its clips played fastest, at their own speed, and slowest."""

    earliest: int
    unbent: int
    latest: int


class _Way(NamedTuple):
    """A path, by when it can have ended: transitions taken, their costs, and the position after the last."""

    lands: _Landing
    edges: tuple[Transition, ...]
    cost: float
    at: Position


@dataclass(frozen=True, slots=True)
class _Meeting:
    """One way back: when its last transition ends, and the frames of the last clip until it meets."""

    way: _Way
    landed: int
    n_output: int
    n_source: int

    @property
    def at(self) -> int:
        return self.landed + self.n_output

    @property
    def key(self) -> tuple[int, float, int]:
        bend = abs(self.landed - self.way.lands.unbent) + abs(self.n_source - self.n_output)
        return self.at, self.way.cost, bend


def find_return(
    graph: MotionGraph, position: Position, time: int, above: Sequence[Clip], deadline: int
) -> tuple[Segment, ...] | None:
    """Return the soonest way back, or None if there is none by the deadline.

    The way is a path in the part's own graph that is at the motion and frame of the graph above at the same time, the
    speed of its clips bent by at most a fifth. Of equally soon ways the smoothest, then the least bent.

    Parameters
    ----------
    position, time : where the part is in its graph, and the output frame from which on.
    above : what the graph above plays meanwhile at its own speed; motions as indices of `graph`.
    deadline : the latest output frame at which the two may meet.
    """
    best: _Meeting | None = None
    pending = [_Way(_Landing(time, time, time), (), 0.0, position)]
    # Of ways that land in the same place at the same times only the smoothest counts; without this there are too many.
    smoothest: dict[tuple[Position, _Landing], float] = {}
    while pending and pending[0].lands.earliest <= deadline:
        way = heappop(pending)
        for meeting in _meetings(graph, way, above, deadline):
            if best is None or meeting.key < best.key:
                best, deadline = meeting, meeting.at
        for onward in _onward(graph, way, deadline):
            if onward.cost < smoothest.get((onward.at, onward.lands), inf):
                smoothest[onward.at, onward.lands] = onward.cost
                heappush(pending, onward)
    return None if best is None else _segments(graph, position, time, best)


def _onward(graph: MotionGraph, way: _Way, deadline: int) -> Iterator[_Way]:
    """Yield a way with one more transition, for each that can have ended by the deadline."""
    for edge in graph.edges[graph.first_edge[way.at.motion] : graph.first_edge[way.at.motion + 1]]:
        n_source = edge.src_frame - way.at.frame
        if n_source < 0:
            continue
        lands = _Landing(
            way.lands.earliest + _fewest(n_source) + graph.window,
            way.lands.unbent + n_source + graph.window,
            way.lands.latest + _most(n_source) + graph.window,
        )
        if lands.earliest > deadline:
            return
        yield _Way(lands, (*way.edges, edge), way.cost + edge.cost, edge.arrival)


def _meetings(graph: MotionGraph, way: _Way, above: Sequence[Clip], deadline: int) -> Iterator[_Meeting]:
    """Yield where the clip that a way lands in can meet the graph above."""
    motion, frame = way.at
    for clip in above:
        if clip.first.motion != motion:
            continue
        for landed in range(way.lands.earliest, min(way.lands.latest, clip.end, deadline) + 1):
            ahead = clip.first.frame + landed - clip.begin - frame
            n_output = max(ceil(abs(ahead) / LARGEST_BEND - 1e-9), clip.begin - landed)
            within_clip = frame + n_output + ahead < graph.n_frames[motion]
            if landed + n_output <= min(clip.end, deadline) and within_clip:
                yield _Meeting(way, landed, n_output, n_output + ahead)


def _fewest(n_source: int) -> int:
    """Return the fewest output frames in which `n_source` frames of a clip may be played."""
    return ceil(n_source / (1 + LARGEST_BEND) - 1e-9)


def _most(n_source: int) -> int:
    """Return the most output frames in which `n_source` frames of a clip may be played."""
    return floor(n_source / (1 - LARGEST_BEND) + 1e-9)


def _segments(graph: MotionGraph, position: Position, time: int, meeting: _Meeting) -> tuple[Segment, ...]:
    """Return a way back as segments; the clips share the time that there is, each as little bent as it may."""
    segments: list[Segment] = []
    lengths: list[int] = []
    at = position
    for edge in meeting.way.edges:
        lengths.append(edge.src_frame - at.frame)
        at = edge.arrival
    spare = meeting.landed - time - graph.window * len(lengths) - sum(lengths)
    at = position
    for edge, n_source in zip(meeting.way.edges, lengths, strict=True):
        change = min(max(spare, _fewest(n_source) - n_source), _most(n_source) - n_source)
        spare -= change
        segments += _bent(time, at, n_source + change, n_source)
        time += n_source + change
        segments.append(play_transition(time, edge, graph.window))
        at, time = edge.arrival, time + graph.window
    return (*segments, *_bent(time, at, meeting.n_output, meeting.n_source))


def _bent(begin: int, first: Position, n_output: int, n_source: int) -> tuple[Clip, ...]:
    return (Clip(begin, begin + n_output, first, n_source),) if n_output > 0 else ()
