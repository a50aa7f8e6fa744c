"""Letting a body part go by a blend onto the graph above, where no way leads it back in time (rule 2)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.blending import WEIGHTS
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.pace import creep, stature, steps
from mlmg_runtime.playing.longest_steps import LongestSteps, seen
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline, play_clip
from mlmg_runtime.skeleton import Poses, world_positions

# A blend may lead a joint by steps this many times as long as its longest in the clips. Where a graph is above the one
# above, the body sways otherwise than looked at here; what is shown is not to go half as fast again.
LARGEST_HURRY = 1.3
# So many moments are looked at at once.
AT_ONCE = 8
# How tall the body stands is told by one of so many frames.
SOMETIMES = 10


@dataclass(frozen=True, slots=True, eq=False)
class _Above:
    """What a graph above will show, from output frame `begin` on, as if it were the whole body.

    Attributes
    ----------
    longest : array, shape (n_frames, 2 * n_joints). The longest steps of a part's joints, `seen`, in the clips that
        play in each frame.
    """

    begin: int
    poses: Poses
    longest: FloatArray


def release(
    usual: LongestSteps,
    graph: MotionGraph,
    own: Iterable[Segment],
    driver: MotionGraph,
    above: Iterable[Segment],
    deadline: int,
) -> tuple[Segment, ...]:
    """Return what a part plays until it has been blended onto the graph above.

    The blend takes k frames and begins as soon as no joint need hurry in it, neither in the world nor as seen from what
    carries the part. Where one would up to the deadline, because two people stand as good as still, but not alike, it
    takes half as long again, or twice as long. Until then the part goes on with what it does.

    Parameters
    ----------
    usual : tells what the joints do in their motions.
    own : what the part will play if it goes on, from where it can be let go; endless.
    driver, above : the graph that plays above, and what it will play, from no later on; endless.
    deadline : the latest output frame at which the blend may begin; later only where the part cannot be let go before.
    """
    coming = iter(own)
    first = next(coming)
    deadline = max(deadline, first.begin)
    ahead = [first, *takewhile(lambda segment: segment.begin <= deadline, coming)]
    places = {time: at for segment in ahead for time, at in _places(segment) if time <= deadline}
    shown = _above(usual, driver, graph.joints, above, first.begin, deadline + max(_lengths(graph)) + 1)
    time, length = _calm(usual, graph, places, shown)
    return (*_until(ahead, time), Blend(time, time + length, places[time], None))


def _lengths(graph: MotionGraph) -> Sequence[int]:
    """Return how many frames a blend may take, in the order in which that is tried."""
    return graph.window, graph.window * 3 // 2, graph.window * 2


def _places(segment: Segment) -> Iterator[tuple[int, Position]]:
    """Yield when and where a segment can be left: a clip in each frame, a transition before it begins."""
    if isinstance(segment, Clip):
        for moment in range(segment.end - segment.begin):
            yield segment.begin + moment, Position(segment.first.motion, segment.first.frame + moment)
    else:
        yield segment.begin, segment.source


def _above(
    usual: LongestSteps, graph: MotionGraph, joints: tuple[int, ...], segments: Iterable[Segment], begin: int, end: int
) -> _Above:
    """Return what a graph shows from the frame before `begin` up to `end`; its first frame twice if it begins there."""
    played = list(takewhile(lambda segment: segment.begin < end, segments))
    start = played[0].begin
    track = tuple(replace(segment, begin=segment.begin - start, end=segment.end - start) for segment in played)
    poses = synthesize(usual.library, Timeline(end - start, {graph.name: track}), feet=False)
    longest = np.zeros((end - start, 2 * len(joints)))
    for segment in track:
        places = (segment.first,) if isinstance(segment, Clip) else (segment.source, segment.target)
        during = slice(segment.begin, segment.end)
        for motion in (graph.motions[place.motion] for place in places if place is not None):
            longest[during] = np.maximum(longest[during], usual.of(joints, motion))
    frames = np.maximum(np.arange(begin - 1, end) - start, 0)
    return _Above(begin - 1, Poses(poses.rotations[frames], poses.positions[frames]), longest[frames])


def _calm(usual: LongestSteps, graph: MotionGraph, places: Mapping[int, Position], above: _Above) -> tuple[int, int]:
    """Return the first moment at which a blend hurries no joint, and its length, as short as can be.

    Where each does, that moment at which the longest hurries least.
    """
    body = world_positions(usual.library.skeleton, above.poses[::SOMETIMES])
    hardly_seen = creep(stature(usual.library.skeleton, [body]), usual.library.frame_rate)
    for length in _lengths(graph):
        hurries: dict[int, float] = {}
        for time, hurry in _hurries(usual, graph, places, above, length, hardly_seen):
            if hurry <= LARGEST_HURRY:
                return time, length
            hurries[time] = hurry
    return min(hurries, key=lambda time: hurries[time]), length


def _hurries(
    usual: LongestSteps,
    graph: MotionGraph,
    places: Mapping[int, Position],
    above: _Above,
    length: int,
    hardly_seen: float,
) -> Iterator[tuple[int, float]]:
    """Yield, for each moment, the longest step of a joint in a blend from then on, as a multiple of its longest."""
    library, times = usual.library, list(places)
    for some in (times[first : first + AT_ONCE] for first in range(0, len(times), AT_ONCE)):
        rows = np.array(some)[:, None] - above.begin + np.arange(-1, length + 1)
        own = np.stack([_own(library, graph, places[time], length) for time in some])
        shown = seen(library.skeleton, _blends(graph, own, above.poses, rows), graph.joints)
        taken = steps(shown.reshape(*rows.shape, -1, 3))
        longest = np.array([usual.of(graph.joints, graph.motions[places[time].motion]) for time in some])
        longest = np.maximum(np.maximum(above.longest[rows[:, 1:]], above.longest[rows[:, :-1]]), longest[:, None])
        hurry = np.where(taken > hardly_seen, taken / np.maximum(longest, np.finfo(float).tiny), 0.0)
        yield from zip(some, hurry.max(axis=(1, 2)).tolist(), strict=True)


def _own(library: Library, graph: MotionGraph, place: Position, length: int) -> FloatArray:
    """Return a part's own rotations in a blend, with the frames before and after; clips' ends repeated."""
    poses = library.poses(graph.motions[place.motion])
    frames = np.clip(place.frame + np.arange(-1, length + 1), 0, poses.n_frames - 1)
    return poses.rotations[frames][:, list(graph.joints)]


def _blends(graph: MotionGraph, own: FloatArray, above: Poses, rows: IntArray) -> Poses:
    """Return what blends onto the graph above show, one after the other.

    Parameters
    ----------
    own : array, shape (n_blends, n_frames, n_joints, 4). rows : array, shape (n_blends, n_frames). Frames of `above`.
    """
    n_blends, n_frames = rows.shape
    share = 1.0 - WEIGHTS[graph.blend](np.clip(np.arange(n_frames) / (n_frames - 2), 0.0, 1.0))
    shown = Poses(above.rotations[rows.ravel()], above.positions[rows.ravel()])
    joints = list(graph.joints)
    shown.rotations[:, joints] = rotations.slerp_movements(
        own.reshape(-1, len(joints), 4),
        shown.rotations[:, joints],
        np.tile(share, n_blends),
        np.arange(0, rows.size, n_frames),
    )
    return shown


def _until(segments: Sequence[Segment], time: int) -> Iterator[Segment]:
    """Yield segments up to a time at which one of them can be left."""
    for segment in segments:
        if segment.end <= time:
            yield segment
        elif isinstance(segment, Clip) and segment.begin < time:
            yield from play_clip(segment.begin, segment.first, time - segment.begin)
