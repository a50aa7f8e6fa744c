"""Staying in a motion -> where a graph is after some time, and where it may be after any."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from contextlib import suppress
from dataclasses import dataclass
from math import isinf

import numpy as np

from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.errors import PlayError
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.timeline import Clip, Segment


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Where a graph may be: arrays of one shape.

    Attributes
    ----------
    motions, frames : the positions.
    leads : how many frames pass until it is there, as it is in a blend before.
    shares : how likely; the sum is 1.
    """

    motions: IntArray
    frames: IntArray
    leads: FloatArray
    shares: FloatArray


@dataclass(frozen=True, slots=True)
class Stay:
    """What a graph plays that stays in a motion, from frame 0 on.

    Attributes
    ----------
    again : the number of the segment that comes again after the last; their number, if it cannot go on.
    """

    segments: tuple[Segment, ...]
    again: int

    @property
    def n_frames(self) -> int:
        """Return how long all segments are."""
        return self.segments[-1].end if self.segments else 0


def staying(likeness: Likeness, graph: MotionGraph, home: int, position: Position, allowed: Collection[int]) -> Stay:
    """Return what a graph plays to stay in the motion `home`, up to where that comes round."""
    seen: dict[Position, int] = {}
    segments: list[Segment] = []
    with suppress(PlayError):
        for segment in stay(likeness, graph, home, position, 0, allowed):
            at = begins_at(segment)
            if at in seen:
                return Stay(tuple(segments), seen[at])
            seen[at] = len(segments)
            segments.append(segment)
    return Stay(tuple(segments), len(segments))


def begins_at(segment: Segment) -> Position:
    """Return the position at which a segment begins."""
    return segment.first if isinstance(segment, Clip) else segment.source


def after(stays: Stay, position: Position, n_frames: float) -> list[tuple[Position, int]]:
    """Return where a graph is that has stayed for some frames, each with the frames until it is there.

    Parameters
    ----------
    position : where it began. n_frames : infinite, if it may be any number; then there are all places that come again.
    """
    if not stays.segments:
        return [(position, 0)]
    if isinf(n_frames):
        return [place for segment in stays.segments[stays.again :] or stays.segments for place in _places_in(segment)]
    time = int(n_frames)
    if time >= stays.n_frames and stays.again < len(stays.segments):
        begin = stays.segments[stays.again].begin
        time = begin + (time - begin) % (stays.n_frames - begin)
    segment = next((one for one in stays.segments if time < one.end), stays.segments[-1])
    return [_places_in(segment)[min(time, segment.end - 1) - segment.begin]]


def _places_in(segment: Segment) -> list[tuple[Position, int]]:
    """Return the place for each frame of a segment; in a blend that has begun, it is where that leads."""
    first, n_frames = begins_at(segment), segment.end - segment.begin
    if isinstance(segment, Clip):
        return [(Position(first.motion, first.frame + n), 0) for n in range(n_frames)]
    assert segment.after is not None, "a graph that stays is not given back"
    return [(first, 0), *((segment.after, n_frames - n) for n in range(1, n_frames))]


def places_of(found: Iterable[tuple[float, list[tuple[Position, int]]]]) -> Places:
    """Return places in arrays.

    Parameters
    ----------
    found : lists of places with their leads, each list with its share, in which all of its places are as likely.
    """
    rows: dict[tuple[Position, int], float] = {}
    for share, places in found:
        for place in places:
            rows[place] = rows.get(place, 0.0) + share / len(places)
    return Places(
        np.array([position.motion for position, _ in rows]),
        np.array([position.frame for position, _ in rows]),
        np.array([lead for _, lead in rows], float),
        np.array(list(rows.values())),
    )
