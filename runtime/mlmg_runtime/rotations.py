"""Rotations as unit quaternions (w, x, y, z): active, right-handed, on column vectors; arrays end in the axis of 4.

The few operations that playing needs, in plain numpy: importing scipy's would take half the time that a
command may take. The tests hold them against scipy.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mlmg_runtime.arrays import FloatArray

AXES = {"X": 0, "Y": 1, "Z": 2}


def multiply(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the rotation that first applies `b`, then `a`; shapes (..., 4), broadcast."""
    aw, ax, ay, az = np.moveaxis(a, -1, 0)
    bw, bx, by, bz = np.moveaxis(b, -1, 0)
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def inverse(q: FloatArray) -> FloatArray:
    """Return the inverse of unit quaternions, shape (..., 4)."""
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def rotate(q: FloatArray, v: FloatArray) -> FloatArray:
    """Return vectors `v`, shape (..., 3), turned by `q`, shape (..., 4), broadcast."""
    w, u = q[..., :1], q[..., 1:]
    t = 2.0 * np.cross(u, v)
    return np.asarray(v + w * t + np.cross(u, t))


def about_axis(axis: str, angle_rad: FloatArray) -> FloatArray:
    """Return rotations about a coordinate axis ("X", "Y" or "Z"), shape angle_rad.shape + (4,)."""
    q = np.zeros((*np.shape(angle_rad), 4))
    q[..., 0] = np.cos(0.5 * angle_rad)
    q[..., 1 + AXES[axis]] = np.sin(0.5 * angle_rad)
    return q


def from_euler(order: str, angles_rad: FloatArray) -> FloatArray:
    """Return R = R_1 R_2 ... (intrinsic, as BVH channels mean it) for angles of shape (..., len(order)).

    `order` names up to three axes, such as "ZXY"; "" gives the identity.
    """
    if not order:
        identity = np.zeros((*angles_rad.shape[:-1], 4))
        identity[..., 0] = 1.0
        return identity
    q = about_axis(order[0], angles_rad[..., 0])
    for index in range(1, len(order)):
        q = multiply(q, about_axis(order[index], angles_rad[..., index]))
    return q


def matrix_from_quaternion(q: FloatArray) -> FloatArray:
    """Return rotation matrices, shape (..., 3, 3), of unit quaternions, shape (..., 4)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.stack(
        (
            np.stack((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)), axis=-1),
            np.stack((2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)), axis=-1),
            np.stack((2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)), axis=-1),
        ),
        axis=-2,
    )


def to_euler(order: str, q: FloatArray) -> FloatArray:
    """Return intrinsic angles in radians, shape (..., 3), with R_1 R_2 R_3 = `q`; `order` names three different axes.

    Accurate everywhere, near the singularity (middle angle +-90 degrees) too: there the split between the first
    and the third angle is free, and the third is measured after the first has been undone.
    """
    i, j, k = (AXES[axis] for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    m = matrix_from_quaternion(q)
    first = np.arctan2(-sign * m[..., j, k], m[..., k, k])
    sin_1, cos_1 = np.sin(first), np.cos(first)
    # Rows j and k of R_1^-1 R, and from them the two angles that are left.
    row_j = cos_1[..., None] * m[..., j, :] + sign * sin_1[..., None] * m[..., k, :]
    row_k = cos_1[..., None] * m[..., k, :] - sign * sin_1[..., None] * m[..., j, :]
    middle = np.arctan2(sign * m[..., i, k], row_k[..., k])
    third = np.arctan2(sign * row_j[..., i], row_j[..., j])
    return np.stack((first, middle, third), axis=-1)


def slerp(a: FloatArray, b: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the rotation a share `weight` of the shortest way from `a` to `b`; weight broadcast to (...)."""
    dot = np.sum(a * b, axis=-1)
    b = np.where(dot[..., None] < 0.0, -b, b)
    # The angle between the two, from sine and cosine: accurate for equal and for opposite rotations.
    angle = 2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    sine = np.sin(angle)
    near = sine < 1e-9
    safe = np.where(near, 1.0, sine)
    weight_a = np.where(near, 1.0 - weight, np.sin((1.0 - weight) * angle) / safe)
    weight_b = np.where(near, weight, np.sin(weight * angle) / safe)
    return normalized(weight_a[..., None] * a + weight_b[..., None] * b)


def normalized(q: FloatArray) -> FloatArray:
    """Return `q`, shape (..., 4), scaled to unit length."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def angle_between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angles in radians, 0 to pi, by which `a` and `b` differ; shapes (..., 4), broadcast."""
    flip = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    return np.asarray(
        4.0 * np.arctan2(np.linalg.norm(a - flip * b, axis=-1), np.linalg.norm(a + flip * b, axis=-1))
    )


def continuous_degrees(angles_deg: FloatArray) -> FloatArray:
    """Return angles (n_frames, ...) in degrees, each moved by whole turns to lie nearest to the one before."""
    return np.asarray(np.unwrap(angles_deg, axis=0, period=360.0))


def is_rotation_order(order: str) -> bool:
    """Return whether `order` names different axes, as the rotation channels of a joint must."""
    return all(a != b for a, b in pairwise(sorted(order)))
