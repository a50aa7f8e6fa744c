"""A timeline: for each graph that runs, which frames of which clips fill which frames of the output."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from mlmg_runtime.motion_graph import Position, Transition


@dataclass(frozen=True, slots=True)
class Clip:
    """Frames of a clip, `n_source` of them from `first.frame` on, played in the output frames [begin, end).

    Attributes
    ----------
    first : motion and frame of the first output frame.
    n_source : how far the clip goes on; other than end - begin where its speed is bent, 0 where it stands still.
    """

    begin: int
    end: int
    first: Position
    n_source: int

    @property
    def speed(self) -> float:
        """Return source frames for each output frame."""
        return self.n_source / (self.end - self.begin)

    @property
    def after(self) -> Position:
        """Return the position at `end`."""
        return Position(self.first.motion, self.first.frame + self.n_source)


@dataclass(frozen=True, slots=True)
class Blend:
    """A blend of k = end - begin frames from the window that begins at `source` to the one that ends at `target`.

    Attributes
    ----------
    source : A_i. target : B_j; None for whatever the graph above plays at the time.
    transition : the graph's own transition, or None for a blend made on the spot.
    """

    begin: int
    end: int
    source: Position
    target: Position | None
    transition: Transition | None = None

    @property
    def after(self) -> Position | None:
        """Return the position at `end`, or None where the part has gone back to the graph above."""
        return None if self.target is None else Position(self.target.motion, self.target.frame + 1)


Segment: TypeAlias = Clip | Blend


def play_transition(begin: int, edge: Transition, window: int) -> Blend:
    """Return a transition of a graph as a segment."""
    source, target = Position(edge.src_motion, edge.src_frame), Position(edge.dst_motion, edge.dst_frame)
    return Blend(begin, begin + window, source, target, edge)


def play_clip(begin: int, first: Position, n_frames: int) -> tuple[Clip, ...]:
    """Return `n_frames` of a clip at its own speed as segments: one, or none."""
    return (Clip(begin, begin + n_frames, first, n_frames),) if n_frames > 0 else ()


def play_along(way: Sequence[Transition], window: int, position: Position, time: int) -> list[Segment]:
    """Return transitions in a row as segments, with the clips that lead to each, from `position` at frame `time` on."""
    segments: list[Segment] = []
    for edge in way:
        segments += play_clip(time, position, edge.src_frame - position.frame)
        time += edge.src_frame - position.frame
        segments.append(play_transition(time, edge, window))
        position, time = edge.arrival, time + window
    return segments


def appended(track: tuple[Segment, ...], segment: Segment) -> tuple[Segment, ...]:
    """Return a track with one more segment; clips that go on where the last one stopped become one with it."""
    last = track[-1] if track else None
    if (
        isinstance(last, Clip)
        and isinstance(segment, Clip)
        and last.end == segment.begin
        and last.after == segment.first
        and last.speed == segment.speed
        and segment.speed in (0.0, 1.0)
    ):
        return (*track[:-1], replace(last, end=segment.end, n_source=last.n_source + segment.n_source))
    return (*track, segment)


@dataclass(frozen=True, slots=True)
class Timeline:
    """What every graph plays in each of `n_frames` output frames.

    Attributes
    ----------
    tracks : graph -> segments in order of time, the root first, parents before children. The root's fill all frames.
        Where another graph has none, its part follows the graph above. Segments may reach over `n_frames`.
    """

    n_frames: int
    tracks: Mapping[str, tuple[Segment, ...]]
