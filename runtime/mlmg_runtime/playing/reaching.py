"""Two-bone inverse kinematics: how a leg is turned at the hip and at the knee to bring its ankle elsewhere."""

from __future__ import annotations

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray

# A leg that is bent by less than some degrees bends about its hinge, not in the plane that it happens to lie in.
_STRAIGHT_SINE = 0.1
# The larger, the more abruptly a leg that is nearly stretched stops to stretch.
_SHARPNESS = 4


def reach(
    hip: FloatArray, knee: FloatArray, ankle: FloatArray, goal: FloatArray, hinge: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the turns in the world of thigh and shin, shape (n_frames, 4) each, that bring the ankle to its goal.

    The knee bends in the plane in which it is bent, and the leg turns the shortest way. What is out of reach is
    stretched for; the nearer a leg is to being stretched, the less it follows: so it never snaps straight.

    Parameters
    ----------
    hip, knee, ankle, goal : array, shape (n_frames, 3). World positions.
    hinge : array, shape (n_frames, 3). Unit vectors: about what the shin turns against the thigh when the knee bends.
    """
    thigh, shin = knee - hip, ankle - knee
    upper, lower = _norm(thigh), _norm(shin)
    axis = np.cross(thigh, shin)
    across = hinge - thigh * (np.sum(hinge * thigh, axis=-1) / upper**2)[:, None]
    axis = axis + _STRAIGHT_SINE * (upper * lower)[:, None] * across
    distance = _within_reach(_norm(goal - hip), _norm(ankle - hip), upper, lower)
    cosine = (distance**2 - upper**2 - lower**2) / (2.0 * upper * lower)
    bent = np.arctan2(_norm(np.cross(thigh, shin)), np.sum(thigh * shin, axis=-1))
    flexion = rotations.about(axis, np.arccos(np.clip(cosine, -1.0, 1.0)) - bent)
    swing = rotations.between(thigh + rotations.rotate(flexion, shin), goal - hip)
    return swing, rotations.multiply(swing, flexion)


def _within_reach(wanted: FloatArray, now: FloatArray, upper: FloatArray, lower: FloatArray) -> FloatArray:
    """Return how far from the hip the ankle gets: as far as wanted, but for the last of the way to full stretch."""
    room = np.maximum(upper + lower - now, 1e-9 * (upper + lower))
    over = np.maximum(wanted - now, 0.0) / room
    kept = now + room * over / (1.0 + over**_SHARPNESS) ** (1.0 / _SHARPNESS)
    return np.where(wanted > now, kept, np.maximum(wanted, np.abs(upper - lower)))


def _norm(v: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(v, axis=-1))
