"""A scene: one motion made ready to be drawn, in metres, on the ground, with its captions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.anatomy import anatomy_from_points
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.skeleton import Skeleton, world_transforms
from mlmg_runtime.view import landmarks
from mlmg_runtime.view.captions import Story
from mlmg_runtime.view.mannequin import BODY_HEIGHT, Ball, Capsule, body_height, mannequin, skull_share
from mlmg_runtime.view.points import Points, points_from_transforms

Float32Array: TypeAlias = NDArray[np.float32]

# Metres in one unit of length, the likeliest first; a plausible height tells which one a file is in.
_UNITS_M = (1.0, 0.01, 0.0254, 0.001, 0.1, 0.3048)
_PLAUSIBLE_M = (1.0, 2.4)
_GROUND_QUANTILE = 0.05
_SAMPLED_FRAMES = 4000
_FRAMES_AT_ONCE = 2000


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A motion to be looked at: metres, y up, the ground at y = 0.

    Attributes
    ----------
    name : what to call it, usually the file's stem.
    frame_time_s : seconds from one frame to the next.
    frames : which frames of the file these are.
    positions : float32 array, shape (n_frames, n_points, 3), read-only. Joints, tips, heels, jaw.
    root : the point that carries the body through the world.
    bones : pairs of points, parent and child.
    capsules : the body around them.
    joint_names : of the points that are joints.
    heading_rad : where the body mostly faces, from z towards x.
    metres_per_unit : what one unit of the file was taken for.
    story : the commands and the tracks of the run that made the motion.
    """

    name: str
    frame_time_s: float
    frames: range
    positions: Float32Array
    root: int
    bones: tuple[tuple[int, int], ...]
    capsules: tuple[Capsule, ...]
    joint_names: tuple[str, ...]
    heading_rad: float
    metres_per_unit: float
    story: Story

    @property
    def n_frames(self) -> int:
        """Return the number of frames."""
        return int(self.positions.shape[0])

    def time_s(self, frame: int) -> float:
        """Return when a frame is shown, counted from the beginning of the file."""
        return self.frame_time_s * (self.frames.start / self.frames.step + frame)

    @property
    def joints_of_graphs(self) -> dict[str, frozenset[int]]:
        """Return the joints that each graph moves, where the report says so."""
        index = {name: joint for joint, name in enumerate(self.joint_names)}
        return {graph: frozenset(index[n] for n in names if n in index) for graph, names in self.story.joints}


def scene_from_bvh(
    bvh: Bvh, name: str, *, up: str = "y", story: Story | None = None, frames: range | None = None
) -> Scene:
    """Return a motion ready to be drawn.

    Of a long motion some thousand frames tell the size of the body and where the ground is, and positions are worked
    out in pieces: beside the file's own numbers, a scene takes 12 bytes for each point and frame.

    Parameters
    ----------
    bvh : a file's content with at least one frame; any unit, which is told from the size of the body.
    name : what to call it.
    up : the vertical axis of the file, "y" or "z".
    story : what its report tells.
    frames : those of the file's frames that the scene is to have, at least one; by default all.
    """
    chosen = range(len(bvh.frames)) if frames is None else frames
    body = _body(bvh, up)
    return Scene(
        name=name,
        frame_time_s=chosen.step * bvh.frame_time_s,
        frames=chosen,
        positions=_positions(bvh, up, body, chosen),
        root=body.skeleton.travel,
        bones=body.bones,
        capsules=body.capsules,
        joint_names=body.skeleton.names,
        heading_rad=body.heading_rad,
        metres_per_unit=body.metres_per_unit,
        story=(story or Story()).within(chosen),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Body:
    """What holds in every frame of a motion; `points` are those of some frames, in metres, `ground` is their height."""

    skeleton: Skeleton
    points: Points
    bones: tuple[tuple[int, int], ...]
    capsules: tuple[Capsule, ...]
    ground: float
    heading_rad: float
    metres_per_unit: float


def _body(bvh: Bvh, up: str) -> _Body:
    """Return the body of a motion, as frames from all over it tell it."""
    skeleton = skeleton_from_bvh(bvh)
    sampled = range(0, len(bvh.frames), -(-len(bvh.frames) // _SAMPLED_FRAMES))
    rotation, position = _transforms(bvh, up, skeleton, sampled)
    points = points_from_transforms(skeleton, rotation, position)
    anatomy = anatomy_from_points(points, skeleton.travel)
    metres = metres_per_unit(body_height(points, anatomy))
    points = points.scaled(metres)
    anatomy = anatomy_from_points(points, skeleton.travel)
    forward = landmarks.facing(points, anatomy)
    n_tips_and_joints = len(points.parents)
    heels: tuple[int, ...] = ()
    jaw = None
    if anatomy.is_human:
        size = body_height(points, anatomy) / BODY_HEIGHT
        chin = skull_share(points, anatomy) - 0.055 * size / max(float(points.lengths[anatomy.head[-1]]), 1e-6)
        points, heels = landmarks.with_heels(points, anatomy, rotation, 0.045 * size)
        points, jaw = landmarks.with_jaw(points, anatomy, rotation, forward=forward, share=chin, depth=0.036 * size)
    capsules = mannequin(points, anatomy, heels, jaw)
    return _Body(
        skeleton,
        points,
        _bones(points, skeleton.travel, n_tips_and_joints),
        capsules,
        _ground(points.positions, capsules),
        landmarks.heading_rad(forward),
        metres,
    )


def _transforms(bvh: Bvh, up: str, skeleton: Skeleton, frames: range) -> tuple[FloatArray, FloatArray]:
    """Return rotations and positions of the joints in the world in some frames, in the file's unit."""
    part = replace(bvh, frames=bvh.frames[frames.start : frames.stop : frames.step])
    return world_transforms(skeleton, poses_from_bvh(part, up))


def _positions(bvh: Bvh, up: str, body: _Body, frames: range) -> Float32Array:
    """Return where all points of a body are in some frames, in metres, with the ground at y = 0."""
    result: Float32Array = np.empty((len(frames), len(body.points.parents), 3), dtype=np.float32)
    for first in range(0, len(frames), _FRAMES_AT_ONCE):
        piece = slice(first, first + _FRAMES_AT_ONCE)
        rotation, position = _transforms(bvh, up, body.skeleton, frames[piece])
        carried = body.points.carried(body.skeleton.travel, rotation, body.metres_per_unit * position)
        result[piece] = carried - np.array([0.0, body.ground, 0.0])
    result.setflags(write=False)
    return result


def metres_per_unit(height: float) -> float:
    """Return what to multiply a body `height` units tall by: a common unit that makes it as tall as
    people are.

    If none does, the body is made 1.7 m tall.
    """
    low, high = _PLAUSIBLE_M
    fitting = [unit for unit in _UNITS_M if low <= unit * height <= high]
    return fitting[0] if fitting else BODY_HEIGHT / max(height, 1e-9)


def ball_centres(positions: NDArray[np.floating], balls: list[Ball]) -> FloatArray:
    """Return where balls are, shape (..., n_balls, 3); `positions` has shape (..., n_points, 3)."""
    a = positions[..., [ball.a for ball in balls], :]
    b = positions[..., [ball.b for ball in balls], :]
    share = np.array([ball.share for ball in balls])[:, None]
    return np.asarray(a + share * (b - a), dtype=np.float64)


def _ground(positions: FloatArray, capsules: tuple[Capsule, ...]) -> float:
    """Return the height of the ground: that of the body's lowest ball, bar outliers."""
    balls = [ball for capsule in capsules for ball in (capsule.first, capsule.second)]
    radii = np.array([ball.radius for ball in balls])
    lowest = (ball_centres(positions, balls)[..., 1] - radii).min(axis=1) if balls else positions[..., 1].min(axis=1)
    return float(np.quantile(lowest, _GROUND_QUANTILE))


def _bones(points: Points, travel: int, n_points: int) -> tuple[tuple[int, int], ...]:
    return tuple((points.parents[point], point) for point in range(travel + 1, n_points) if points.lengths[point] > 0.0)
