"""Letting a body part go by a blend onto the graph above, where no way leads it back in time (rule 2)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.blending import WEIGHTS
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, play_clip
from mlmg_runtime.skeleton import Poses, world_positions

# A blend may lead a joint by steps this many times as long as its longest in the two clips. Where a graph is above
# the one above, the body sways otherwise than looked at here; what is shown is not to go half as fast again.
LARGEST_HURRY = 1.3
# So many moments are looked at at once.
AT_ONCE = 8


class _Moment(NamedTuple):
    """When a part could be let go: where it is then, and where the graph above is, as positions of the part's graph."""

    time: int
    own: Position
    above: Position


def release(
    library: Library, graph: MotionGraph, own: Iterable[Segment], above: Sequence[Clip], deadline: int
) -> tuple[Segment, ...]:
    """Return what a part plays until it has been blended onto the graph above.

    The blend begins as soon as no joint need hurry in it; where one would up to the deadline, when it would least.
    Until then the part goes on with what it does.

    Parameters
    ----------
    own : what the part will play if it goes on; endless. above : what the graph above will play, as for `find_return`.
    deadline : the latest output frame at which the blend may begin.
    """
    ahead = list(takewhile(lambda segment: segment.begin <= deadline, own))
    places = {time: at for segment in ahead for time, at in _places(segment) if time <= deadline}
    windows = dict(_windows(graph, above))
    moments = [_Moment(time, at, windows[time]) for time, at in places.items() if time in windows]
    time = _calmest(library, graph, moments) if moments else min(places)
    return (*_until(ahead, time), Blend(time, time + graph.window, places[time], None))


def _places(segment: Segment) -> Iterator[tuple[int, Position]]:
    """Yield when and where a segment can be left: a clip in each frame, a transition before it begins."""
    if isinstance(segment, Clip):
        for moment in range(segment.end - segment.begin):
            yield segment.begin + moment, Position(segment.first.motion, segment.first.frame + moment)
    else:
        yield segment.begin, segment.source


def _windows(graph: MotionGraph, above: Sequence[Clip]) -> Iterator[tuple[int, Position]]:
    """Yield when the graph above begins to play k frames of one clip in a row, and which frame is the first."""
    for clip in above:
        for moment in range(clip.end - clip.begin - graph.window + 1):
            yield clip.begin + moment, Position(clip.first.motion, clip.first.frame + moment)


def _calmest(library: Library, graph: MotionGraph, moments: Sequence[_Moment]) -> int:
    """Return the time of the first moment that hurries no joint, or of that which hurries least."""
    longest = {
        motion: _steps(library, graph, [library.poses(graph.motions[motion])]).max(axis=(0, 1))
        for motion in sorted({place.motion for moment in moments for place in moment[1:]})
    }
    hurries = np.empty(0)
    for first in range(0, len(moments), AT_ONCE):
        some = moments[first : first + AT_ONCE]
        expected = np.array([np.maximum(longest[moment.own.motion], longest[moment.above.motion]) for moment in some])
        blends = [_blend(library, graph, moment) for moment in some]
        taken = _steps(library, graph, blends).max(axis=1)
        hurries = np.append(hurries, (taken / np.maximum(expected, np.finfo(float).tiny)).max(axis=1))
        if hurries.min() <= LARGEST_HURRY:
            return moments[int(np.argmax(hurries <= LARGEST_HURRY))].time
    return moments[int(hurries.argmin())].time


def _blend(library: Library, graph: MotionGraph, moment: _Moment) -> Poses:
    """Return what a blend shows where nothing else is blended; with a frame before and after, clips' ends repeated."""
    frames = np.arange(-1, graph.window + 1)
    own, above = (library.poses(graph.motions[place.motion]) for place in moment[1:])
    own_rows, rows = (
        np.clip(place.frame + frames, 0, poses.n_frames - 1)
        for place, poses in zip(moment[1:], (own, above), strict=True)
    )
    joints = list(graph.joints)
    share = 1.0 - WEIGHTS[graph.blend](np.clip((frames + 1) / graph.window, 0.0, 1.0))
    shown = Poses(above.rotations[rows], above.positions[rows])
    shown.rotations[:, joints] = rotations.slerp_movements(
        own.rotations[own_rows][:, joints], shown.rotations[:, joints], share, np.zeros(1, dtype=np.int64)
    )
    return shown


def _steps(library: Library, graph: MotionGraph, movements: Sequence[Poses]) -> FloatArray:
    """Return how far joints go from frame to frame, shape (n_movements, n_frames - 1, n_joints)."""
    every = Poses(
        np.concatenate([poses.rotations for poses in movements]), np.concatenate([p.positions for p in movements])
    )
    points = world_positions(library.skeleton, every)[:, list(graph.joints)]
    points = points.reshape(len(movements), -1, *points.shape[1:])
    return np.asarray(np.linalg.norm(np.diff(points, axis=1), axis=-1))


def _until(segments: Sequence[Segment], time: int) -> Iterator[Segment]:
    """Yield segments up to a time at which one of them can be left."""
    for segment in segments:
        if segment.end <= time:
            yield segment
        elif isinstance(segment, Clip) and segment.begin < time:
            yield from play_clip(segment.begin, segment.first, time - segment.begin)
