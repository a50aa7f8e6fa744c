"""Two-bone inverse kinematics: the hip and the knee that bring an ankle to where it has to be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class LegPose:
    """What a leg does.

    Attributes
    ----------
    hip : array, shape (n_frames, 4). World rotations of the thigh.
    knee_rad : array, shape (n_frames,). Flexion of the knee, 0 where the leg is straight, never negative.
    """

    hip: FloatArray
    knee_rad: FloatArray


def leg_pose(hip: FloatArray, ankle: FloatArray, forward: FloatArray, thigh_cm: float, shin_cm: float) -> LegPose:
    """Return how a leg, straight down at rest and with a knee that is a hinge about x, reaches its ankle.

    The law of cosines. What is out of reach is reached for with a straight leg.

    Parameters
    ----------
    hip, ankle : array, shape (n_frames, 3). World positions, cm, y up.
    forward : array, shape (n_frames, 3). Where the knee points; not along the leg.
    """
    leg = ankle - hip
    distance = np.linalg.norm(leg, axis=-1)
    reach = np.clip(distance, abs(thigh_cm - shin_cm), thigh_cm + shin_cm)
    knee_inside = _angle_opposite(reach, thigh_cm, shin_cm)
    hip_inside = _angle_opposite(np.full_like(reach, shin_cm), thigh_cm, reach)
    plane = _frame(-leg / distance[:, None], forward)
    hip_rotation = rotations.multiply(plane, rotations.about_axis("X", -hip_inside))
    return LegPose(hip_rotation, np.pi - knee_inside)


def _angle_opposite(side: FloatArray, a: float | FloatArray, b: float | FloatArray) -> FloatArray:
    """Return the angle of a triangle between its sides `a` and `b`, opposite to `side`."""
    return np.arccos(np.clip((a * a + b * b - side * side) / (2.0 * a * b), -1.0, 1.0))


def _frame(up: FloatArray, forward: FloatArray) -> FloatArray:
    """Return the rotations that turn y to `up`, a unit vector, and z as near to `forward` as can be."""
    x = np.cross(up, forward)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    return _quaternion_from_matrix(np.stack((x, up, np.cross(x, up)), axis=-1))


def _quaternion_from_matrix(m: FloatArray) -> FloatArray:
    """Return unit quaternions, shape (..., 4), of rotation matrices that turn by less than half a turn."""
    w = 0.5 * np.sqrt(np.maximum(1.0 + m[..., 0, 0] + m[..., 1, 1] + m[..., 2, 2], 1e-12))
    x = m[..., 2, 1] - m[..., 1, 2]
    y = m[..., 0, 2] - m[..., 2, 0]
    z = m[..., 1, 0] - m[..., 0, 1]
    return rotations.normalized(np.stack((w, x / (4.0 * w), y / (4.0 * w), z / (4.0 * w)), axis=-1))
