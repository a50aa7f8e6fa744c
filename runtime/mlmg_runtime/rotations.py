"""Rotations as unit quaternions (w, x, y, z): active, right-handed, on column vectors.

Arrays of quaternions end in the axis of 4. These are the few operations that playing needs, in plain numpy:
importing scipy's would take half the time that a command may take. The tests hold them against scipy.
"""

from __future__ import annotations

import numpy as np

from mlmg_runtime.arrays import FloatArray, IntArray

AXES = {"X": 0, "Y": 1, "Z": 2}


def multiply(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the rotation that first applies `b`, then `a`; shapes (..., 4), broadcast."""
    aw, ax, ay, az = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bw, bx, by, bz = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    product[..., 0] = aw * bw - ax * bx - ay * by - az * bz
    product[..., 1] = aw * bx + ax * bw + ay * bz - az * by
    product[..., 2] = aw * by - ax * bz + ay * bw + az * bx
    product[..., 3] = aw * bz + ax * by - ay * bx + az * bw
    return product


def inverse(q: FloatArray) -> FloatArray:
    """Return the inverse of unit quaternions, shape (..., 4)."""
    return np.asarray(q * np.array([1.0, -1.0, -1.0, -1.0]))


def rotate(q: FloatArray, v: FloatArray) -> FloatArray:
    """Return vectors `v`, shape (..., 3), turned by `q`, shape (..., 4), broadcast."""
    w, x, y, z = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    a, b, c = v[..., 0], v[..., 1], v[..., 2]
    # v + w t + u x t, where u is the vector part of q and t = 2 u x v; written out, for `np.cross` is slow.
    t_a, t_b, t_c = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return np.stack(
        (a + w * t_a + y * t_c - z * t_b, b + w * t_b + z * t_a - x * t_c, c + w * t_c + x * t_b - y * t_a),
        axis=-1,
    )


def about_axis(axis: str, angle_rad: FloatArray) -> FloatArray:
    """Return rotations about a coordinate axis ("X", "Y" or "Z"), shape angle_rad.shape + (4,)."""
    q = np.zeros((*np.shape(angle_rad), 4))
    q[..., 0] = np.cos(0.5 * angle_rad)
    q[..., 1 + AXES[axis]] = np.sin(0.5 * angle_rad)
    return q


def about(axis: FloatArray, angle_rad: FloatArray) -> FloatArray:
    """Return rotations about any axes, shape (..., 3), not of length 0, by angles of shape (...)."""
    unit = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    half = 0.5 * angle_rad[..., None]
    return np.concatenate((np.cos(half), np.sin(half) * unit), axis=-1)


def between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the smallest rotations that turn `a` to where `b` points, shapes (..., 3); not for opposite ones."""
    a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    w = np.maximum(1.0 + np.sum(a * b, axis=-1, keepdims=True), 1e-12)
    return normalized(np.concatenate((w, np.cross(a, b)), axis=-1))


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
    """Return the intrinsic angles in radians, shape (..., len(order)), for which R_1 R_2 ... = `q`.

    `order` names one to three different axes. Three give every rotation, accurately near the singularity
    (middle angle +-90 degrees) too; the middle angle is within +-90 degrees. Fewer give the nearest rotation
    that they can make.
    """
    if len(order) == 1:
        return np.asarray(2.0 * np.arctan2(q[..., 1 + AXES[order]], q[..., 0]))[..., None]
    if len(order) == 2:
        return _two_angles(order, q)
    return _three_angles(order, q)


def _two_angles(order: str, q: FloatArray) -> FloatArray:
    """Return the angles a, b for which R_i(a) R_j(b) comes nearest to `q`.

    The inner product of the two quaternions, written with the sum and the difference of the half angles,
    falls into two terms, each of which one of them makes as large as can be.
    """
    i, j = (AXES[axis] for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    w, x_i, x_j, x_k = q[..., 0], q[..., 1 + i], q[..., 1 + j], sign * q[..., 1 + 3 - i - j]
    half_sum = np.arctan2(x_i + x_j, w - x_k)
    half_difference = np.arctan2(x_i - x_j, w + x_k)
    return np.stack((half_sum + half_difference, half_sum - half_difference), axis=-1)


def _three_angles(order: str, q: FloatArray) -> FloatArray:
    """Return all three angles; at the singularity the third is measured after the first has been undone."""
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
    return _slerp_as_signed(a, np.where(dot[..., None] < 0.0, -b, b), weight)


def slerp_movements(a: FloatArray, b: FloatArray, weight: FloatArray, starts: IntArray) -> FloatArray:
    """Return movements `a` blended into `b` frame by frame, each blend going the same way round all the time.

    Where two movements are about half a turn apart, the shortest way changes sides from one frame to the next, and
    the joint would jump. Here each blend takes, for each joint, the side that is the shorter one on the whole.

    Parameters
    ----------
    a, b : array, shape (n_frames, n_joints, 4). weight : array, shape (n_frames,).
    starts : array, shape (n_blends,). The first frame of each blend, ascending from 0.
    """
    relative = multiply(inverse(a), b)
    turns_over = np.sum(relative[1:] * relative[:-1], axis=-1) < 0.0
    sign = np.ones(relative.shape[:2])
    sign[1:] = np.cumprod(np.where(turns_over, -1.0, 1.0), axis=0)
    middle = (weight * (1.0 - weight))[:, None]
    shorter = np.add.reduceat(sign * relative[..., 0] * middle, starts, axis=0) >= 0.0
    sign *= np.repeat(np.where(shorter, 1.0, -1.0), np.diff(starts, append=len(a)), axis=0)
    return _slerp_as_signed(a, sign[..., None] * b, weight[:, None])


def _slerp_as_signed(a: FloatArray, b: FloatArray, weight: FloatArray) -> FloatArray:
    """Return slerp of quaternions as they are: of `b` and `-b`, one goes the short way round, one the long way."""
    # The angle between the two, from sine and cosine: accurate for equal and for opposite rotations.
    angle = 2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    sine = np.sin(angle)
    near = sine < 1e-9
    safe = np.where(near, 1.0, sine)
    weight_a = np.where(near, 1.0 - weight, np.sin((1.0 - weight) * angle) / safe)
    weight_b = np.where(near, np.where(angle < 1.0, weight, -weight), np.sin(weight * angle) / safe)
    return normalized(weight_a[..., None] * a + weight_b[..., None] * b)


def normalized(q: FloatArray) -> FloatArray:
    """Return `q`, shape (..., 4), scaled to unit length."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def angle_between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angles in radians, 0 to pi, by which `a` and `b` differ; shapes (..., 4), broadcast."""
    flip = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    return np.asarray(4.0 * np.arctan2(np.linalg.norm(a - flip * b, axis=-1), np.linalg.norm(a + flip * b, axis=-1)))


def continuous_euler(angles_rad: FloatArray) -> FloatArray:
    """Return angles as of `to_euler`, shape (n_frames, 1 to 3), written so that they jump least over time.

    An angle may be moved by whole turns, and of three angles a, b, c also a + pi, pi - b, c + pi make the
    same rotation. Which of the two is nearer to the frame before does not depend on which was taken there,
    but only on whether the frame before was changed; so that the changes add up.
    """
    if angles_rad.shape[-1] == 3:
        other = np.pi + angles_rad * np.array([1.0, -1.0, 1.0])
        changes = _turn(other[1:] - angles_rad[:-1]) < _turn(angles_rad[1:] - angles_rad[:-1])
        changed = np.concatenate(([False], np.cumsum(changes) % 2 == 1))
        angles_rad = np.where(changed[:, None], other, angles_rad)
    return np.asarray(np.unwrap(angles_rad, axis=0))


def _turn(step_rad: FloatArray) -> FloatArray:
    """Return how far steps of angles turn altogether, without whole turns; summed over the last axis."""
    return np.asarray(np.sum(np.abs(np.remainder(step_rad + np.pi, 2.0 * np.pi) - np.pi), axis=-1))
