"""The point-cloud distance between windows of frames [K02]: how alike two short stretches of movement are.

A window's point cloud is the world positions of a graph's joints over its k frames. Two clouds are compared after one
has been turned about the vertical and slid over the ground to where it fits the other best. The minimum has a closed
form, and all its terms are inner products. On the ground plane, with a point written as the complex number x + iz:

    D = E_a + E_b - 2 |C| + H,   C = sum_p w_p conj(a_p) b_p,   E = sum_p w_p |p|^2,   H = sum_p w_p (y_a - y_b)^2

where each cloud's horizontal centroid has been taken off. Within a frame, the points are split into the frame's
centroid and what is left about it. The part about the centroid is an inner product of *frames*, summed along diagonals
over a window; the centroids are a path of k points for each window. Both parts are matrix products and neither
suffers from how far a clip has walked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.errors import ShapeError

Matrix = NDArray[Any]


@dataclass(frozen=True, slots=True, eq=False)
class PointCloud:
    """A clip, ready to be compared window by window; a window is called by its first frame.

    Attributes
    ----------
    window : k, frames in a window.
    limbs : array, shape (n_frames, n_points), complex. Points about their frame's centroid, times sqrt(weight).
    heights : array, shape (n_frames, n_points). Heights times sqrt(weight).
    paths : array, shape (n_windows, k), complex. Frames' centroids about their window's, times sqrt(sum of weights).
    energy : array, shape (n_windows,). sum_p w_p (|p|^2 on the ground + y^2) about the window's centroid.
    """

    window: int
    limbs: Matrix
    heights: Matrix
    paths: Matrix
    energy: Matrix

    @property
    def n_windows(self) -> int:
        """Return the number of windows."""
        return int(self.energy.shape[0])


@dataclass(frozen=True, slots=True, eq=False)
class GroundTransform:
    """A turn about the vertical and a shift over the ground: p -> R(yaw) p + shift. Arrays hold one each.

    Attributes
    ----------
    yaw_rad : array, shape (n,). Counter-clockwise seen from above (about +y).
    shift : array, shape (n, 2). Along x and z, length units.
    """

    yaw_rad: FloatArray
    shift: FloatArray


def point_cloud(points: FloatArray, weights: FloatArray, window: int, dtype: type = np.float64) -> PointCloud:
    """Return a clip's point cloud.

    Parameters
    ----------
    points : array, shape (n_frames, n_points, 3)
        World positions, y up.
    weights : array, shape (n_points,)
        Non-negative, not all zero.
    window : frames in a window; a clip of fewer frames has no window.
    dtype : numpy.float64, or numpy.float32 for half the memory and time at 1e-4 of the distances' scale.

    Raises
    ------
    ShapeError
        If `weights` does not fit the points.
    """
    if points.ndim != 3 or points.shape[2] != 3 or weights.shape != points.shape[1:2]:
        raise ShapeError(f"expected points (n, m, 3) and weights (m,), found {points.shape} and {weights.shape}")
    ground = points[..., 0] + 1j * points[..., 2]
    total = float(weights.sum())
    centroids = ground @ weights / total
    root_weights = np.sqrt(weights)
    limbs = (ground - centroids[:, None]) * root_weights
    heights = points[..., 1] * root_weights
    n_windows = max(points.shape[0] - window + 1, 0)
    if n_windows == 0:
        paths = np.empty((0, window), dtype=np.complex128)
        energy = np.empty(0)
    else:
        paths = np.lib.stride_tricks.sliding_window_view(centroids, window)
        paths = (paths - paths.mean(axis=1, keepdims=True)) * np.sqrt(total)
        of_frame = np.sum(np.abs(limbs) ** 2 + heights**2, axis=1)
        of_window = np.lib.stride_tricks.sliding_window_view(of_frame, window).sum(axis=1)
        energy = of_window + np.sum(np.abs(paths) ** 2, axis=1)
    complex_type = np.result_type(dtype, np.complex64)
    return PointCloud(
        window,
        limbs.astype(complex_type),
        heights.astype(dtype),
        paths.astype(complex_type),
        energy.astype(dtype),
    )


def window_distances(a: PointCloud, b: PointCloud) -> Matrix:
    """Return D for each window of `a` with each window of `b`, shape (a.n_windows, b.n_windows).

    D is in squared length units, summed over the points of a window, each times its weight [K02].

    Raises
    ------
    ShapeError
        If the two were made for different windows or points.
    """
    if a.window != b.window or a.limbs.shape[1] != b.limbs.shape[1]:
        raise ShapeError(f"windows of {a.window} x {a.limbs.shape[1]} and {b.window} x {b.limbs.shape[1]} points")
    ground = _diagonal_sums(a.limbs.conj() @ b.limbs.T, a.window)
    ground += a.paths.conj() @ b.paths.T
    distance: Matrix = a.energy[:, None] + b.energy[None, :]
    distance -= 2.0 * np.abs(ground)
    distance -= 2.0 * _diagonal_sums(a.heights @ b.heights.T, a.window)
    np.maximum(distance, 0.0, out=distance)
    return distance


def _diagonal_sums(products: Matrix, window: int) -> Matrix:
    """Return out[i, j] = sum over p < window of products[i + p, j + p], by doubling: log2(window) additions."""
    n_rows, n_columns = (max(size - window + 1, 0) for size in products.shape)
    total = np.zeros((n_rows, n_columns), dtype=products.dtype)
    if total.size == 0:
        return total
    partial, length, done = products, 1, 0
    while True:
        if window & length:
            total += partial[done : done + n_rows, done : done + n_columns]
            done += length
        if done == window:
            return total
        partial = partial[:-length, :-length] + partial[length:, length:]
        length *= 2


def best_fit(a: FloatArray, b: FloatArray, weights: FloatArray) -> GroundTransform:
    """Return the transform of `b` that brings it closest to `a`, for many pairs of windows at once [K02].

    Parameters
    ----------
    a, b : array, shape (n, k, n_points, 3)
        World positions, y up.
    weights : array, shape (n_points,)

    Raises
    ------
    ShapeError
        If `a` and `b` differ in shape.
    """
    if a.shape != b.shape:
        raise ShapeError(f"expected two arrays of one shape, found {a.shape} and {b.shape}")
    share = np.broadcast_to(weights / (a.shape[1] * weights.sum()), a.shape[1:3])
    ground_a, ground_b = a[..., 0] + 1j * a[..., 2], b[..., 0] + 1j * b[..., 2]
    centre_a = np.sum(share * ground_a, axis=(1, 2))
    centre_b = np.sum(share * ground_b, axis=(1, 2))
    about_a, about_b = ground_a - centre_a[:, None, None], ground_b - centre_b[:, None, None]
    yaw_rad = np.angle(np.sum(share * about_a.conj() * about_b, axis=(1, 2)))
    shift = centre_a - np.exp(-1j * yaw_rad) * centre_b
    return GroundTransform(yaw_rad, np.stack((shift.real, shift.imag), axis=-1))
