"""From a timeline to poses: clips placed in the world, transitions blended, body parts laid over the whole."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.blending import WEIGHTS
from mlmg_runtime.feet import find_plants
from mlmg_runtime.legs import find_legs
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.foot_locking import Sources, Windows, lock_feet
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline
from mlmg_runtime.point_cloud import GroundTransform, best_fit
from mlmg_runtime.skeleton import Poses, world_positions, world_transforms


@dataclass(frozen=True, slots=True, eq=False)
class _Pool:
    """The clips that a graph plays, one after the other; `first_row` tells where each motion begins."""

    poses: Poses
    first_row: Mapping[int, int]
    last_row: Mapping[int, int]

    def rows(self, first: Position, n_output: int, speed: float) -> FloatArray:
        """Return the rows of `n_output` frames from a position on; past its end a clip stands still."""
        rows = self.first_row[first.motion] + first.frame + speed * np.arange(n_output)
        return np.asarray(np.minimum(rows, self.last_row[first.motion]))

    def rows_around(self, first: Position, n_output: int) -> IntArray:
        """Return the rows of the frame before a position and of `n_output` frames from it on, none outside the clip."""
        rows = self.first_row[first.motion] + first.frame + np.arange(-1, n_output)
        return np.clip(rows, self.first_row[first.motion], self.last_row[first.motion])


@dataclass(frozen=True, slots=True, eq=False)
class _Score:
    """A track, spelt out frame by frame; rows are fractional indices into a pool.

    Attributes
    ----------
    times : array, shape (n,). Output frames. rows : array, shape (n,). What they show, or blend from.
    segment : array, shape (n,). Index of the segment.
    blended : array, shape (m,). Indices into `times` of the frames that are blended, `weight` (m,) the weight of
        `rows` there, `target_rows` (m,) what they blend to; NaN for what the graph above shows.
    """

    times: IntArray
    rows: FloatArray
    segment: IntArray
    blended: IntArray
    weight: FloatArray
    target_rows: FloatArray


def synthesize(library: Library, timeline: Timeline, blend: str | None = None, feet: bool = True) -> Poses:
    """Return the poses of a timeline, one an output frame; y up, the library's length unit.

    Each transition is aligned to where the character is and carried on, so that it walks on from there. A graph that
    runs on its own replaces the local rotations of exactly its own joints; all else is bit for bit its parent's.

    Parameters
    ----------
    blend : "c1" or "linear"; None for what each graph was configured with.
    feet : whether planted feet are kept from sliding in transitions of the whole body; other frames have their clips'.
    """
    root, *parts = (library.by_name[graph] for graph in timeline.tracks)
    poses = _whole_body(library, root, timeline, blend or root.blend, feet)
    for graph in parts:
        _lay_over(library, graph, timeline, blend or graph.blend, poses)
    return poses


def _whole_body(library: Library, graph: MotionGraph, timeline: Timeline, blend: str, feet: bool) -> Poses:
    segments = timeline.tracks[graph.name]
    pool = _pool(library, graph, segments)
    score = _score(segments, pool, timeline.n_frames, WEIGHTS[blend])
    source, target = _placements(library, graph, segments, pool)
    shown = _placed(_sampled(pool.poses, score.rows), library.skeleton.travel, _of_each(source, score.segment))
    if len(score.blended):
        at = score.blended
        placement = _of_each(target, score.segment[at])
        goal = _placed(_sampled(pool.poses, score.target_rows), library.skeleton.travel, placement)
        share = 1.0 - score.weight
        starts = _starts(score.segment[at])
        shown.rotations[at] = rotations.slerp_movements(shown.rotations[at], goal.rotations, share, starts)
        shown.positions[at] += share[:, None, None] * (goal.positions - shown.positions[at])
        if feet:
            blended = Poses(shown.rotations[at], shown.positions[at])
            _keep_feet(library, segments, pool, (source, target), blend, blended, timeline.n_frames)
            shown.rotations[at] = blended.rotations
    return shown


def _keep_feet(
    library: Library,
    segments: Sequence[Segment],
    pool: _Pool,
    placements: tuple[GroundTransform, GroundTransform],
    blend: str,
    blended: Poses,
    n_frames: int,
) -> None:
    """Keep planted feet from sliding, in place, in all frames that are blended."""
    legs = find_legs(library.skeleton, pool.poses)
    if not legs:
        return
    numbers = [number for number, segment in enumerate(segments) if isinstance(segment, Blend)]
    begins = np.array([segments[number].begin for number in numbers])
    length = segments[numbers[0]].end - segments[numbers[0]].begin
    firsts = zip(*(_windows(segment) for segment in segments if isinstance(segment, Blend)), strict=True)
    left, entered = (
        Windows(np.stack([pool.rows_around(first, length) for first in each]), _of_each(ground, np.array(numbers)))
        for each, ground in zip(firsts, placements, strict=True)
    )
    turned, places = world_transforms(library.skeleton, pool.poses)
    clips = [places[first : pool.last_row[motion] + 1] for motion, first in pool.first_row.items()]
    planted = np.concatenate([find_plants(clip, legs, library.frame_rate) for clip in clips])
    sources = Sources(pool.poses.rotations, turned, places, planted)
    body = WEIGHTS[blend](np.arange(length + 1) / length)
    is_shown = begins[:, None] + np.arange(length) < n_frames
    lock_feet(library.skeleton, legs, sources, (left, entered), body, blended, is_shown)


def _lay_over(library: Library, graph: MotionGraph, timeline: Timeline, blend: str, poses: Poses) -> None:
    """Replace the local rotations of a graph's joints, in place, wherever it runs on its own."""
    segments = timeline.tracks[graph.name]
    joints = np.array(graph.joints)
    pool = _pool(library, graph, segments)
    score = _score(segments, pool, timeline.n_frames, WEIGHTS[blend])
    own = _sampled(pool.poses, score.rows).rotations[:, joints]
    if len(score.blended):
        at = score.blended
        to_parent = np.isnan(score.target_rows)
        goal = poses.rotations[score.times[at][:, None], joints]
        goal[~to_parent] = _sampled(pool.poses, score.target_rows[~to_parent]).rotations[:, joints]
        own[at] = rotations.slerp_movements(own[at], goal, 1.0 - score.weight, _starts(score.segment[at]))
    poses.rotations[score.times[:, None], joints] = own


def _starts(segment: IntArray) -> IntArray:
    """Return where in a list of segment numbers each segment starts."""
    return np.flatnonzero(np.diff(segment, prepend=-1))


def _pool(library: Library, graph: MotionGraph, segments: Sequence[Segment]) -> _Pool:
    used: dict[int, None] = {}
    for segment in segments:
        places = (segment.first,) if isinstance(segment, Clip) else (segment.source, segment.target)
        used.update((place.motion, None) for place in places if place is not None)
    clips = [library.poses(graph.motions[motion]) for motion in used]
    ends = np.cumsum([clip.n_frames for clip in clips]).tolist()
    return _Pool(
        Poses(np.concatenate([c.rotations for c in clips]), np.concatenate([c.positions for c in clips])),
        {motion: end - clip.n_frames for motion, end, clip in zip(used, ends, clips, strict=True)},
        {motion: end - 1 for motion, end in zip(used, ends, strict=True)},
    )


def _score(
    segments: Sequence[Segment], pool: _Pool, n_frames: int, weight: Callable[[FloatArray], FloatArray]
) -> _Score:
    times, rows, numbers, blended, weights, target_rows = [], [], [], [], [], []
    n_before = 0
    for number, segment in enumerate(segments):
        length = segment.end - segment.begin
        shown = min(segment.end, n_frames) - segment.begin
        first = segment.first if isinstance(segment, Clip) else segment.source
        speed = segment.speed if isinstance(segment, Clip) else 1.0
        times.append(np.arange(segment.begin, segment.begin + shown))
        rows.append(pool.rows(first, shown, speed))
        numbers.append(np.full(shown, number))
        if isinstance(segment, Blend):
            blended.append(np.arange(n_before, n_before + shown))
            weights.append(weight(np.arange(1, shown + 1) / length))
            target_rows.append(_target_rows(segment, pool, length)[:shown])
        n_before += shown
    nothing = [np.empty(0)]
    return _Score(
        np.concatenate(times),
        np.concatenate(rows),
        np.concatenate(numbers),
        np.concatenate(blended or nothing).astype(np.int64),
        np.concatenate(weights or nothing),
        np.concatenate(target_rows or nothing),
    )


def _target_rows(blend: Blend, pool: _Pool, length: int) -> FloatArray:
    if blend.target is None:
        return np.full(length, np.nan)
    return pool.rows(_windows(blend)[1], length, 1.0)


def _windows(blend: Blend) -> tuple[Position, Position]:
    """Return where the two windows begin that a blend leads between."""
    assert blend.target is not None
    return blend.source, Position(blend.target.motion, blend.target.frame - (blend.end - blend.begin) + 1)


def _sampled(poses: Poses, rows: FloatArray) -> Poses:
    """Return poses at fractional rows; whole rows are taken as they are."""
    from mlmg_runtime.clips import sample

    whole = rows.astype(np.int64)
    taken = Poses(poses.rotations[whole], poses.positions[whole])
    bent = np.flatnonzero(rows != whole)
    if len(bent):
        between = sample(poses, rows[bent])
        taken.rotations[bent], taken.positions[bent] = between.rotations, between.positions
    return taken


def _placements(
    library: Library, graph: MotionGraph, segments: Sequence[Segment], pool: _Pool
) -> tuple[GroundTransform, GroundTransform]:
    """Return where each segment's source and target stand: the clip's own ground to the world's, one a segment."""
    fits = _fits(library, graph, segments, pool)
    yaw, shift = 0.0, 0j
    source: list[tuple[float, complex]] = []
    target: list[tuple[float, complex]] = []
    for segment in segments:
        source.append((yaw, shift))
        if isinstance(segment, Blend) and segment.target is not None:
            turn, move = fits[segment.source, segment.target]
            yaw, shift = yaw + turn, shift + np.exp(-1j * yaw) * move
        target.append((yaw, shift))
    return _transform(source), _transform(target)


def _transform(each: Sequence[tuple[float, complex]]) -> GroundTransform:
    shifts = np.array([shift for _, shift in each])
    return GroundTransform(np.array([yaw for yaw, _ in each]), np.stack((shifts.real, shifts.imag), axis=-1))


def _fits(
    library: Library, graph: MotionGraph, segments: Sequence[Segment], pool: _Pool
) -> dict[tuple[Position, Position], tuple[float, complex]]:
    """Return for each pair of windows that is blended how the second is brought onto the first; each told once."""
    pairs = list(
        dict.fromkeys(
            (segment.source, segment.target, segment.end - segment.begin)
            for segment in segments
            if isinstance(segment, Blend) and segment.target is not None
        )
    )
    if not pairs:
        return {}
    length = pairs[0][2]
    sources = np.stack([pool.rows(source, length, 1.0) for source, _, _ in pairs])
    targets = np.stack(
        [pool.rows(Position(target.motion, target.frame - length + 1), length, 1.0) for _, target, _ in pairs]
    )
    rows, place = np.unique(np.concatenate((sources, targets)).astype(np.int64), return_inverse=True)
    points = world_positions(library.skeleton, Poses(pool.poses.rotations[rows], pool.poses.positions[rows]))
    clouds = points[:, list(graph.joints)][place.reshape(2 * len(pairs), length)]
    fit = best_fit(clouds[: len(pairs)], clouds[len(pairs) :], graph.weights)
    return {
        (source, target): (float(yaw), complex(*shift))
        for (source, target, _), yaw, shift in zip(pairs, fit.yaw_rad, fit.shift, strict=True)
    }


def _of_each(transform: GroundTransform, segment: IntArray) -> GroundTransform:
    return GroundTransform(transform.yaw_rad[segment], transform.shift[segment])


def _placed(poses: Poses, travel: int, ground: GroundTransform) -> Poses:
    """Return poses turned about the vertical and shifted over the ground, each frame by its own transform; in place."""
    turn = rotations.about_axis("Y", ground.yaw_rad)
    poses.rotations[:, travel] = rotations.multiply(turn, poses.rotations[:, travel])
    poses.positions[:, 0] = rotations.rotate(turn, poses.positions[:, 0])
    poses.positions[:, 0, 0] += ground.shift[:, 0]
    poses.positions[:, 0, 2] += ground.shift[:, 1]
    return poses
