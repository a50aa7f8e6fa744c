"""Capsules as a camera sees them: the rays cut each of them exactly, and the nearest cut wins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.view.scene import Float32Array
from mlmg_runtime.view.studio import Studio

_NEAR = 0.1
_CREVICE_DEPTH_M = 0.10
_GENTLE_SLOPE = 0.2  # Sine.


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """A body in part of a picture.

    Attributes
    ----------
    left, top : the first column and row of the part, pixels.
    colour : float32 array, shape (height, width, 3). Red, green and blue, 0 to 255, times the cover.
    cover : float32 array, shape (height, width). How much of each pixel the body covers, 0 to 1.
    """

    left: int
    top: int
    colour: Float32Array
    cover: Float32Array


@dataclass(frozen=True, slots=True, eq=False)
class _Hits:
    """What each ray meets first: how far away (inf: nothing), with which normal, on which capsule."""

    depth: Float32Array
    normal: Float32Array
    capsule: NDArray[np.int32]


def solid(studio: Studio, eye: FloatArray, centres: FloatArray, radii: FloatArray, colours: Float32Array) -> Solid:
    """Return capsules as seen from `eye`, lit.

    Parameters
    ----------
    centres : array, shape (n_capsules, 2, 3). The balls of each capsule, metres.
    radii : array, shape (n_capsules, 2).
    colours : float32 array, shape (n_capsules, 3).
    """
    n = studio.oversampling
    boxes = _boxes(studio, centres - eye, radii)
    kept = np.flatnonzero((boxes[:, 0] < boxes[:, 2]) & (boxes[:, 1] < boxes[:, 3]))
    if not kept.size:
        return Solid(0, 0, np.zeros((0, 0, 3), np.float32), np.zeros((0, 0), np.float32))
    left, top = boxes[kept, :2].min(axis=0)
    right, bottom = boxes[kept, 2:].max(axis=0)
    rays = studio.fine_rays[n * top : n * bottom, n * left : n * right]
    boxes = n * (boxes - [left, top, left, top])
    hits = _hits(rays, boxes, kept, centres - eye, radii)
    shown = np.isfinite(hits.depth)
    colour = np.zeros((*shown.shape, 3), dtype=np.float32)
    colour[shown] = _shade(studio, rays, hits, shown, colours)
    return Solid(int(left), int(top), _reduced(colour, n), _reduced(shown[..., None].astype(np.float32), n)[..., 0])


def _boxes(studio: Studio, centres: FloatArray, radii: FloatArray) -> NDArray[np.int64]:
    """Return the pixels [left, top, right, bottom) that each capsule may cover, shape (n, 4); or none."""
    width, height = studio.size
    seen = centres @ studio.axes.T
    depth = -seen[..., 2]
    safe = np.maximum(depth - radii, _NEAR)
    x = 0.5 * width + studio.focal * seen[..., 0] / np.maximum(depth, _NEAR)
    y = 0.5 * height - studio.focal * seen[..., 1] / np.maximum(depth, _NEAR)
    reach = 1.05 * studio.focal * radii / safe + 1.0
    sides = np.stack(
        ((x - reach).min(axis=1), (y - reach).min(axis=1), (x + reach).max(axis=1), (y + reach).max(axis=1)),
        axis=1,
    )
    boxes: NDArray[np.int64] = np.clip(
        np.floor(sides) + np.array([0, 0, 1, 1]), 0, [width, height, width, height]
    ).astype(np.int64)
    boxes[depth.min(axis=1) < _NEAR + radii.max(axis=1)] = 0
    return boxes


def _hits(
    rays: Float32Array,
    boxes: NDArray[np.int64],
    kept: NDArray[np.intp],
    centres: FloatArray,
    radii: FloatArray,
) -> _Hits:
    shape = rays.shape[:2]
    hits = _Hits(np.full(shape, np.inf, np.float32), np.zeros((*shape, 3), np.float32), np.zeros(shape, np.int32))
    for index in kept:
        left, top, right, bottom = boxes[index]
        box = np.s_[top:bottom, left:right]
        found, normal = cut(rays[box], centres[index], radii[index])
        nearer = found < hits.depth[box]
        hits.depth[box][nearer] = found[nearer]
        hits.normal[box][nearer] = normal[nearer]
        hits.capsule[box][nearer] = index
    return hits


def cut(rays: Float32Array, ends: FloatArray, radii: FloatArray) -> tuple[Float32Array, Float32Array]:
    """Return where rays from the origin first meet the hull of two balls: distance (inf: never) and normal.

    On the side of the hull, at height y along the axis from the first centre, the distance from the axis is
    (r1 - y s) / c, with s = (r1 - r2) / length the sine of the side's slope and c its cosine: a cone. With
    the ray put in, that is a quadratic equation. The balls close the ends. Normals leave out a gentle slope,
    so that the bones of a limb are shaded as one piece.
    """
    first, second = ends.astype(np.float32)
    r1, r2 = float(radii[0]), float(radii[1])
    near, normal = _cut_ball(rays, first, r1)
    other, other_normal = _cut_ball(rays, second, r2)
    closer = other < near
    near = np.where(closer, other, near)
    normal = np.where(closer[..., None], other_normal, normal)
    length = float(np.linalg.norm(second - first))
    if length <= 1.001 * abs(r1 - r2) + 1e-6:
        return near, normal
    sine = (r1 - r2) / length
    axis = (second - first) / np.float32(length)
    cosine_2 = 1.0 - sine * sine
    along = rays @ axis
    height = -float(first @ axis)
    a = cosine_2 - along**2
    b = -cosine_2 * (rays @ first) + (sine * r1 - height) * along
    c = cosine_2 * float(first @ first) - height**2 - r1 * r1 + 2.0 * sine * r1 * height
    inside = b * b - a * c
    # Where the ray comes in, (-b - sqrt) / a, in the form that holds for a = 0 too: a ray along the side.
    below = np.sqrt(np.maximum(inside, 0.0)) - b
    t = c / np.where(np.abs(below) > 1e-9, below, np.inf)
    y = height + t * along
    side = (inside > 0.0) & (t > _NEAR) & (y > r1 * sine) & (y < length + r2 * sine) & (t <= near)
    away = t[..., None] * rays - first - y[..., None] * axis
    shown_sine = sine if abs(sine) > _GENTLE_SLOPE else 0.0
    away *= np.float32(np.sqrt(1.0 - shown_sine**2)) / np.maximum(np.linalg.norm(away, axis=-1, keepdims=True), 1e-9)
    away += np.float32(shown_sine) * axis
    return np.where(side, t, near).astype(np.float32), np.where(side[..., None], away, normal).astype(np.float32)


def _cut_ball(rays: Float32Array, centre: Float32Array, radius: float) -> tuple[Float32Array, Float32Array]:
    along = rays @ centre
    inside = along**2 - np.float32(float(centre @ centre) - radius * radius)
    t = along - np.sqrt(np.maximum(inside, 0.0))
    distance = np.where((inside > 0.0) & (t > _NEAR), t, np.inf).astype(np.float32)
    return distance, ((t[..., None] * rays - centre) / np.float32(radius)).astype(np.float32)


def _shade(
    studio: Studio, rays: Float32Array, hits: _Hits, shown: NDArray[np.bool_], colours: Float32Array
) -> Float32Array:
    """Return the colours of the samples that show the body, shape (n, 3): a key light, the sky, a rim."""
    normal = hits.normal[shown]
    key = np.clip((normal @ studio.light.astype(np.float32) + 0.25) / 1.25, 0.0, 1.0)
    sky = 0.5 + 0.5 * normal[:, 1]
    facing = np.clip(-np.sum(normal * rays[shown], axis=-1), 0.0, 1.0)
    rim = (1.0 - facing) ** 3 * (0.35 + 0.65 * sky)
    light = (0.20 + 0.24 * sky + 0.62 * key) * (1.0 - 0.55 * _crevices(hits.depth, shown, 3 * studio.oversampling))
    return np.asarray(colours[hits.capsule[shown]] * light[:, None] + 34.0 * rim[:, None], dtype=np.float32)


def _crevices(depth: Float32Array, shown: NDArray[np.bool_], reach: int) -> Float32Array:
    """Return how far each shown sample is behind those around it, 0 to 1: an arm darkens the chest."""
    filled = np.where(shown, depth, 0.0).astype(np.float32)
    around = _blurred(filled, reach) / np.maximum(_blurred(shown.astype(np.float32), reach), 1e-6)
    return np.clip((filled - around)[shown] / np.float32(_CREVICE_DEPTH_M), 0.0, 1.0)


def _blurred(image: Float32Array, reach: int) -> Float32Array:
    """Return the means of squares 2 * reach + 1 wide, taken twice."""
    for axis in (0, 1, 0, 1):
        n, padding = image.shape[axis], [(0, 0), (0, 0)]
        padding[axis] = (reach + 1, reach)
        sums = np.cumsum(np.pad(image, padding), axis=axis, dtype=np.float64)
        wide = np.take(sums, np.arange(2 * reach + 1, 2 * reach + 1 + n), axis=axis)
        image = ((wide - np.take(sums, np.arange(n), axis=axis)) / (2 * reach + 1)).astype(np.float32)
    return image


def _reduced(image: Float32Array, n: int) -> Float32Array:
    """Return the means of blocks of n by n samples."""
    height, width, depth = image.shape
    return np.asarray(image.reshape(height // n, n, width // n, n, depth).mean(axis=(1, 3)), dtype=np.float32)
