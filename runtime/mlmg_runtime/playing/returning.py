"""Leading a body part back to the very motion and frame that the graph above it plays (rule 2)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, floor
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


@dataclass(frozen=True, slots=True)
class _Meeting:
    """One way back: transitions taken, when the last ends, and the frames of the last clip until it meets."""

    way: tuple[Transition, ...]
    landed: int
    n_output: int
    n_source: int
    bend: int

    @property
    def at(self) -> int:
        return self.landed + self.n_output

    @property
    def key(self) -> tuple[int, float, int]:
        return self.at, sum(edge.cost for edge in self.way), self.bend


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
    for way, lands in _ways(graph, position, time, deadline):
        for meeting in _meetings(graph, way, way[-1].arrival if way else position, lands, above, deadline):
            if best is None or meeting.key < best.key:
                best = meeting
    return None if best is None else _segments(graph, position, time, best)


def _ways(
    graph: MotionGraph, position: Position, time: int, deadline: int
) -> Iterator[tuple[tuple[Transition, ...], _Landing]]:
    """Yield paths of any number of transitions, with the times at which each can have ended."""
    pending: list[tuple[tuple[Transition, ...], Position, _Landing]] = [((), position, _Landing(time, time, time))]
    while pending:
        way, at, lands = pending.pop()
        yield way, lands
        for edge in graph.edges[graph.first_edge[at.motion] : graph.first_edge[at.motion + 1]]:
            n_source = edge.src_frame - at.frame
            if n_source < 0:
                continue
            after = _Landing(
                lands.earliest + _fewest(n_source) + graph.window,
                lands.unbent + n_source + graph.window,
                lands.latest + _most(n_source) + graph.window,
            )
            if after.earliest > deadline:
                break
            pending.append(((*way, edge), edge.arrival, after))


def _meetings(
    graph: MotionGraph,
    way: tuple[Transition, ...],
    landing: Position,
    lands: _Landing,
    above: Sequence[Clip],
    deadline: int,
) -> Iterator[_Meeting]:
    """Yield where a clip entered at `landing`, at any of the times of `lands`, can meet the graph above."""
    for clip in above:
        if clip.first.motion != landing.motion:
            continue
        for landed in range(lands.earliest, min(lands.latest, clip.end, deadline) + 1):
            ahead = clip.first.frame + landed - clip.begin - landing.frame
            n_output = max(ceil(abs(ahead) / LARGEST_BEND - 1e-9), clip.begin - landed)
            meets = landed + n_output
            within_clip = landing.frame + n_output + ahead < graph.n_frames[landing.motion]
            if meets <= min(clip.end, deadline) and within_clip:
                bend = abs(landed - lands.unbent) + abs(ahead)
                yield _Meeting(way, landed, n_output, n_output + ahead, bend)


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
    for edge in meeting.way:
        lengths.append(edge.src_frame - at.frame)
        at = edge.arrival
    spare = meeting.landed - time - graph.window * len(lengths) - sum(lengths)
    at = position
    for edge, n_source in zip(meeting.way, lengths, strict=True):
        change = min(max(spare, _fewest(n_source) - n_source), _most(n_source) - n_source)
        spare -= change
        segments += _bent(time, at, n_source + change, n_source)
        time += n_source + change
        segments.append(play_transition(time, edge, graph.window))
        at, time = edge.arrival, time + graph.window
    return (*segments, *_bent(time, at, meeting.n_output, meeting.n_source))


def _bent(begin: int, first: Position, n_output: int, n_source: int) -> tuple[Clip, ...]:
    return (Clip(begin, begin + n_output, first, n_source),) if n_output > 0 else ()
