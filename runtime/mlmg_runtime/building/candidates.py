"""Candidate points: where two motions are most alike, locally [K02]."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.point_cloud import Matrix


class Candidates(NamedTuple):
    """Pairs of windows of two motions, by their first frames, with their distance; arrays of one length.

    Each is a transition both ways: (A_i, B_j) with j = b + k - 1, and (B_b, A_{i+k-1}).
    """

    i: IntArray
    b: IntArray
    distance: FloatArray


def find_candidates(distances: Matrix, *, within_motion: bool, window: int) -> Candidates:
    """Return the local minima of a matrix of window distances, among the eight neighbours of each entry.

    An entry at the matrix' border counts if it is the least of the neighbours it has: clips often begin and end where
    they are most alike. Of equal neighbours the one with the smaller indices counts.

    Parameters
    ----------
    distances : array, shape (windows of a, windows of b).
    within_motion : both motions are the same one. Then each pair is told once, the earlier window first, and only
        windows that share no frame are compared.
    window : k.
    """
    if distances.size == 0:
        nothing = np.empty(0, dtype=np.int64)
        return Candidates(nothing, nothing, np.empty(0))
    padded = np.pad(distances, 1, constant_values=np.inf)
    least = _share_no_frame(distances.shape[0], window) if within_motion else np.ones(distances.shape, dtype=bool)
    for row in (-1, 0, 1):
        for column in (-1, 0, 1):
            if (row, column) == (0, 0):
                continue
            neighbour = padded[1 + row : 1 + row + distances.shape[0], 1 + column : 1 + column + distances.shape[1]]
            least &= distances < neighbour if (row, column) < (0, 0) else distances <= neighbour
    i, b = np.nonzero(least)
    return Candidates(i, b, distances[i, b].astype(np.float64))


def _share_no_frame(n_windows: int, window: int) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Return which pairs of a motion's windows (first earlier than second) do not overlap."""
    return np.subtract.outer(np.arange(n_windows), np.arange(n_windows)) <= -window
