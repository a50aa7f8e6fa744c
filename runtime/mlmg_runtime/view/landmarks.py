"""What no joint says and a figure needs: where it looks, where its heels and its jaw are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.anatomy import Anatomy, upper_joint
from mlmg_runtime.arrays import BoolArray, FloatArray
from mlmg_runtime.view.points import Points

_GROUND = np.array([1.0, 0.0, 1.0])
_LOW_SHARE = 0.3  # A foot stands flat in the third of the frames in which its ankle is lowest.


def facing(points: Points, anatomy: Anatomy) -> FloatArray:
    """Return where the body faces in each frame, shape (n_frames, 3): horizontal unit vectors.

    It is where the feet point. Without feet it is the z axis.
    """
    ways = [points.positions[:, leg[-1]] - points.positions[:, ankle(leg, points)] for leg in anatomy.legs]
    if not ways:
        return np.tile([0.0, 0.0, 1.0], (points.positions.shape[0], 1))
    return _horizontal(np.sum([_horizontal(way) for way in ways], axis=0))


def heading_rad(forward: FloatArray) -> float:
    """Return where a body mostly faces, an angle from z towards x; `forward` as `facing` gives it."""
    mean = forward.mean(axis=0)
    return float(np.arctan2(mean[0], mean[2]))


def ankle(leg: tuple[int, ...], points: Points) -> int:
    """Return the point at the end of the shin, or the one before the tip where the leg has fewer bones."""
    upper = leg.index(upper_joint(leg, points))
    return leg[max(min(upper + 2, len(leg) - 2), 0)]


def with_heels(points: Points, anatomy: Anatomy, rotation: FloatArray, depth: float) -> tuple[Points, tuple[int, ...]]:
    """Return the points with a heel for each leg, and which they are.

    A heel moves with the foot; where the foot stands, it is as low as the toes, and `depth` behind the ankle.

    Parameters
    ----------
    rotation : array, shape (n_frames, n_joints, 4). The joints' rotations in the world.
    """
    heels = []
    for leg in anatomy.legs:
        joint = ankle(leg, points)
        at, toes = points.positions[:, joint], points.positions[:, leg[-1]]
        heel = -depth * _horizontal(toes - at)
        heel[:, 1] = np.minimum(toes[:, 1] - at[:, 1], 0.0)
        standing = at[:, 1] <= np.quantile(at[:, 1], _LOW_SHARE)
        points = _with_rigid_point(points, joint, rotation, heel, standing)
        heels.append(len(points.parents) - 1)
    return points, tuple(heels)


def with_jaw(
    points: Points, anatomy: Anatomy, rotation: FloatArray, *, forward: FloatArray, share: float, depth: float
) -> tuple[Points, int]:
    """Return the points with the middle of the jaw, and which it is; it turns with the head.

    It is a `share` of the way from the head joint to the crown, then `depth` to where the body faces.
    """
    joint, crown = anatomy.head[-2:]
    up = points.positions[:, crown] - points.positions[:, joint]
    everywhere = np.ones(len(forward), dtype=bool)
    jaw = share * up + depth * forward
    return _with_rigid_point(points, joint, rotation, jaw, everywhere), len(points.parents)


def _with_rigid_point(points: Points, joint: int, rotation: FloatArray, step: FloatArray, known: BoolArray) -> Points:
    """Return the points with one that moves with a joint, a `step` away from it in the frames `known`."""
    turn = rotation[:, joint]
    local = np.median(rotations.rotate(rotations.inverse(turn[known]), step[known]), axis=0)
    length = float(np.median(np.linalg.norm(step[known], axis=-1)))
    local *= length / max(float(np.linalg.norm(local)), 1e-9)
    new = points.positions[:, joint] + rotations.rotate(turn, local)
    return replace(
        points,
        parents=(*points.parents, joint),
        positions=np.concatenate((points.positions, new[:, None]), axis=1),
        lengths=np.append(points.lengths, length),
        offsets=(*points.offsets, local),
    )


def _horizontal(way: FloatArray) -> FloatArray:
    flat = way * _GROUND
    return np.asarray(flat / np.maximum(np.linalg.norm(flat, axis=-1, keepdims=True), 1e-9))
