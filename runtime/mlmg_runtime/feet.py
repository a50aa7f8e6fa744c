"""Plants: when a foot stands on the ground [KS02]."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from mlmg_runtime.arrays import BoolArray, FloatArray
from mlmg_runtime.legs import Leg

# Of the length of the leg: how high above its floor a joint of a planted foot is at most, and how far it goes in a
# second. On real clips toes that stand are below 0.05 and 0.2, and toes that swing above 0.6 in most frames.
_HEIGHT_SHARE = 0.08
_SPEED_SHARE = 0.25
# A clip's floor is where a joint is at its lowest, but for so many of the frames.
_FLOOR_QUANTILE = 0.05
# A plant lasts longer than this, and so does the time between two.
_SHORTEST_S = 0.1


def find_plants(points: FloatArray, legs: Sequence[Leg], frame_rate: float) -> BoolArray:
    """Return when each foot of a clip is planted, shape (n_frames, n_legs): when its ankle or its toes stand.

    What stands is low and slow. Each clip has its own floor, the same for all feet.

    Parameters
    ----------
    points : array, shape (n_frames, n_joints, 3). World positions of the clip's joints, y up.
    """
    stands = np.zeros((len(points), len(legs)), dtype=bool)
    if not len(points):
        return stands
    size = np.array([_length(points[0], leg) for leg in legs])
    for of_foot in ([leg.ankle for leg in legs], [leg.toes for leg in legs]):
        at = points[:, of_foot]
        floor = np.quantile(at[..., 1], _FLOOR_QUANTILE, axis=0).min()
        low = at[..., 1] - floor < _HEIGHT_SHARE * size
        stands |= low & (_speeds(at) * frame_rate < _SPEED_SHARE * size)
    shortest = max(round(_SHORTEST_S * frame_rate), 1)
    for foot in stands.T:
        _fill_short(foot, shortest, False)
        _fill_short(foot, shortest, True)
    return stands


def _length(at: FloatArray, leg: Leg) -> float:
    """Return how long a leg is: thigh and shin."""
    return float(np.linalg.norm(at[leg.knee] - at[leg.hip]) + np.linalg.norm(at[leg.ankle] - at[leg.knee]))


def _speeds(at: FloatArray) -> FloatArray:
    """Return how far points go in a frame, the mean of the steps before and after it; shape at.shape[:-1]."""
    steps = np.linalg.norm(np.diff(at, axis=0), axis=-1)
    if not len(steps):
        return np.zeros(at.shape[:-1])
    return np.asarray(0.5 * (np.concatenate((steps[:1], steps)) + np.concatenate((steps, steps[-1:]))))


def _fill_short(foot: BoolArray, shortest: int, value: bool) -> None:
    """Turn over what is `value` for no more than `shortest` frames, in place; what touches an end may go on there."""
    changes = np.flatnonzero(np.diff(foot)) + 1
    for first, end in itertools.pairwise(changes):
        if foot[first] == value and end - first <= shortest:
            foot[first:end] = not value
