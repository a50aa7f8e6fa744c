"""Planted feet stay where they are while the body is blended [KS02].

In a transition each foot goes over from one motion to the other at a time of its own, in the air if it can. Before, it
is where the motion that is left has it, turned as it is there; after, where the motion that is entered has it. So it
stands as still as in the clips. The leg follows by inverse kinematics, and all else is left as it was blended.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.legs import Leg
from mlmg_runtime.playing.foot_weights import FootPath, foot_weights
from mlmg_runtime.playing.reaching import reach
from mlmg_runtime.point_cloud import GroundTransform
from mlmg_runtime.skeleton import Poses, Skeleton, world_transforms

# In lengths of the leg: how far from where the body's blend would have it a foot may well be.
_FAR = 0.1
# A planted foot that has to go over farther than is hardly seen steps. In lengths of the leg: how far that is, how high
# a foot is lifted at most; and how high it is lifted for the rest of its way.
_UNSEEN = 0.03
_HIGHEST = 0.05
_LIFT = 0.4


@dataclass(frozen=True, slots=True, eq=False)
class Sources:
    """The clips that are blended, one after the other, each in a world of its own.

    Attributes
    ----------
    rotations : array, shape (n_rows, n_joints, 4). Local. world_rotations : the same in the world.
    world_positions : array, shape (n_rows, n_joints, 3).
    planted : array, shape (n_rows, n_legs).
    """

    rotations: FloatArray
    world_rotations: FloatArray
    world_positions: FloatArray
    planted: BoolArray


@dataclass(frozen=True, slots=True, eq=False)
class Windows:
    """A window of k frames for each of n blends, with the frame before it.

    Attributes
    ----------
    rows : array, shape (n, k + 1). Rows of the sources. ground : where each window stands in the world, n of them.
    """

    rows: IntArray
    ground: GroundTransform

    def __getitem__(self, which: IntArray) -> Windows:
        """Return some of the windows."""
        ground = GroundTransform(self.ground.yaw_rad[which], self.ground.shift[which])
        return Windows(self.rows[which], ground)

    def places(self, points: FloatArray) -> FloatArray:
        """Return points of the sources, shape (n_rows, 3), where they stand in the world, shape (n, k + 1, 3)."""
        placed = rotations.rotate(self._turn, points[self.rows])
        placed[..., 0] += self.ground.shift[:, None, 0]
        placed[..., 2] += self.ground.shift[:, None, 1]
        return placed

    def turns(self, turned: FloatArray) -> FloatArray:
        """Return world rotations of the sources, shape (n_rows, 4), in this world, shape (n, k + 1, 4)."""
        return rotations.multiply(self._turn, turned[self.rows])

    @property
    def _turn(self) -> FloatArray:
        return rotations.about_axis("Y", self.ground.yaw_rad)[:, None]


@dataclass(frozen=True, slots=True, eq=False)
class _Foot:
    """Where a foot has to be in some frames: its ankle's place and turn in the world, its other joints' own turns."""

    place: FloatArray
    turn: FloatArray
    below: Mapping[int, FloatArray]


def lock_feet(
    skeleton: Skeleton,
    legs: Sequence[Leg],
    sources: Sources,
    windows: tuple[Windows, Windows],
    body: FloatArray,
    poses: Poses,
    is_shown: BoolArray,
) -> None:
    """Turn the legs of blended poses, in place, so that planted feet do not slide.

    A foot that is planted in neither motion of a blend is left as it is.

    Parameters
    ----------
    windows : of the motions that are left and of those that are entered.
    body : array, shape (k + 1,). The weight of the motion that is left for the body, 1 before the blend.
    poses : the frames of all blends that are shown, in order. is_shown : array, shape (n, k). Which those are.
    """
    world = world_transforms(skeleton, poses)
    for number, leg in enumerate(legs):
        weight, lift = _going_over(leg, number, sources, windows, body)
        planted = [sources.planted[own.rows, number].any(axis=1, keepdims=True) for own in windows]
        is_held = is_shown & (planted[0] | planted[1])
        foot = _blended_foot(skeleton, leg, sources, windows, weight, is_held)
        foot.place[:, 1] += (4.0 * weight * (1.0 - weight) * lift[:, None])[is_held]
        hinge = np.broadcast_to(_hinges(sources, windows, leg)[:, None], (*is_held.shape, 3))[is_held]
        _turn_leg(skeleton, leg, hinge, foot, world, np.flatnonzero(is_held[is_shown]), poses)


def _going_over(
    leg: Leg, number: int, sources: Sources, windows: tuple[Windows, Windows], body: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return a foot's weight of the motion that is left, shape (n, k), and how high it is lifted, shape (n,).

    Wherever it happens, a blend of the same windows is the same, and worked out once.
    """
    pairs = np.concatenate([own.rows for own in windows], axis=1)
    _, once, again = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    paths = [
        FootPath(own[once].places(sources.world_positions[:, leg.toes]), sources.planted[own.rows[once], number])
        for own in windows
    ]
    length = _lengths(sources, windows[0][once], leg)
    weight, dragged = foot_weights(paths[0], paths[1], body, _FAR * length)
    lift = np.clip(_LIFT * (dragged - _UNSEEN * length), 0.0, _HIGHEST * length)
    return weight[again.reshape(-1)], lift[again.reshape(-1)]


def _lengths(sources: Sources, windows: Windows, leg: Leg) -> FloatArray:
    """Return how long a leg is in each blend, thigh and shin, shape (n,)."""
    hip, knee, ankle = (sources.world_positions[windows.rows[:, 0], joint] for joint in (leg.hip, leg.knee, leg.ankle))
    return np.asarray(np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1))


def _blended_foot(
    skeleton: Skeleton,
    leg: Leg,
    sources: Sources,
    windows: tuple[Windows, Windows],
    weight: FloatArray,
    is_held: BoolArray,
) -> _Foot:
    """Return the foot in the frames `is_held`, shape (n, k), blended with a weight of its own, shape (n, k)."""
    share = 1.0 - weight[is_held]
    a, b = (own.places(sources.world_positions[:, leg.ankle])[:, 1:][is_held] for own in windows)
    turned, turned_to = (own.turns(sources.world_rotations[:, leg.ankle])[:, 1:][is_held] for own in windows)
    below = sorted(skeleton.subtree(leg.ankle) - {leg.ankle})
    rows, rows_to = (own.rows[:, 1:][is_held] for own in windows)
    return _Foot(
        a + share[:, None] * (b - a),
        rotations.slerp(turned, turned_to, share),
        {j: rotations.slerp(sources.rotations[rows, j], sources.rotations[rows_to, j], share) for j in below},
    )


def _hinges(sources: Sources, windows: tuple[Windows, Windows], leg: Leg) -> FloatArray:
    """Return about what the knee bends in each blend, unit vectors in the thigh's own frame, shape (n, 3)."""
    rows = np.concatenate([own.rows for own in windows], axis=1)
    hip, knee, ankle = (sources.world_positions[rows, joint] for joint in (leg.hip, leg.knee, leg.ankle))
    back = rotations.inverse(sources.world_rotations[rows, leg.hip])
    thigh, shin = rotations.rotate(back, knee - hip), rotations.rotate(back, ankle - knee)
    # A leg that is never bent may bend about whatever lies across it.
    across = np.cross(thigh[:, 0], np.eye(3)[np.abs(thigh[:, 0]).argmin(axis=-1)])
    bend = np.cross(thigh, shin).sum(axis=1) + 1e-9 * np.linalg.norm(thigh[:, 0], axis=-1)[:, None] * across
    return np.asarray(bend / np.linalg.norm(bend, axis=-1, keepdims=True))


def _turn_leg(
    skeleton: Skeleton,
    leg: Leg,
    hinge: FloatArray,
    foot: _Foot,
    world: tuple[FloatArray, FloatArray],
    rows: IntArray,
    poses: Poses,
) -> None:
    """Bring a foot to its place in some rows of `poses`, whose joints are in the world as `world` tells."""
    turned, place = (values[rows] for values in world)
    swing, bend = reach(
        place[:, leg.hip],
        place[:, leg.knee],
        place[:, leg.ankle],
        foot.place,
        rotations.rotate(turned[:, leg.hip], hinge),
    )
    above = turned[:, skeleton.parents[leg.hip]]
    thigh, shin = rotations.multiply(swing, turned[:, leg.hip]), rotations.multiply(bend, turned[:, leg.knee])
    for joint, parent, own in ((leg.hip, above, thigh), (leg.knee, thigh, shin), (leg.ankle, shin, foot.turn)):
        poses.rotations[rows, joint] = rotations.multiply(rotations.inverse(parent), own)
    for joint, own in foot.below.items():
        poses.rotations[rows, joint] = own
