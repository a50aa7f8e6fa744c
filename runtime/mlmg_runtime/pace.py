"""How far joints go from frame to frame, and how far that is hardly seen."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.skeleton import Skeleton

# So fast, in shares of the body's height a second, joints that else stand still are hardly seen to move. Without this,
# a person who stands and talks would have to walk about to go on talking.
_CREEP_SHARE_S = 0.045


def steps(points: FloatArray) -> FloatArray:
    """Return how far points, shape (..., n_frames, n_joints, 3), go from each frame to the next.

    Returns
    -------
    array, shape (..., n_frames - 1, n_joints).
    """
    return np.asarray(np.linalg.norm(np.diff(points, axis=-3), axis=-1))


def stature(skeleton: Skeleton, points: Iterable[FloatArray]) -> float:
    """Return how tall the body usually stands: the median height of its highest joint over its lowest.

    Parameters
    ----------
    points : the joints' positions in the world in some movements, shape (n_frames, n_joints, 3), y up.
    """
    heights = [np.ptp(p[:, skeleton.travel :, 1], axis=1) for p in points]
    return float(np.median(np.concatenate(heights)))


def creep(stature: float, frame_rate: float) -> float:
    """Return the longest step from frame to frame that is hardly seen of a body so tall; in the unit of `stature`."""
    return _CREEP_SHARE_S * stature / frame_rate
