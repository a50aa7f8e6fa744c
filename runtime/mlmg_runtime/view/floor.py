"""The floor under a figure: a pool of light, a grid of metres, and the shadow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.view.palette import BACKGROUND, FLOOR, GRID
from mlmg_runtime.view.scene import Float32Array
from mlmg_runtime.view.studio import Studio

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

_LIT_RADIUS_M = 5.5  # How far from the figure the floor fades into the background.
_SHEET_M, _SHEET_PIXELS = 4.6, 368
_SHADOW, _SHADOW_BLUR = 0.62, 2.6  # How dark; how many pixels of the sheet its edge is soft.
_CONTACT, _CONTACT_BLUR, _CONTACT_HEIGHT_M = 0.75, 2.2, 0.08
_LINE_M = 0.012
_TURN = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)


def floor(studio: Studio, target: FloatArray, centres: FloatArray, radii: FloatArray) -> Float32Array:
    """Return the floor with the shadow of capsules, and the background: shape (height, width, 3), 0 to 255.

    Parameters
    ----------
    target : where the camera looks, shape (3,), metres.
    centres : array, shape (n_capsules, 2, 3). The balls of each capsule, metres.
    radii : array, shape (n_capsules, 2).
    """
    eye, rays = studio.eye(target), studio.rays
    background = np.array(BACKGROUND, dtype=np.float32)
    image = np.tile(background, (*rays.shape[:2], 1))
    hit = rays[..., 1] < -1e-3
    way = rays[hit]
    t = -np.float32(eye[1]) / way[:, 1]
    x = np.float32(eye[0] - target[0]) + t * way[:, 0]
    z = np.float32(eye[2] - target[2]) + t * way[:, 2]
    away = np.minimum(np.hypot(x, z) / np.float32(_LIT_RADIUS_M), 1.0)
    lit = (1.0 - away) ** 2 * (1.0 + 2.0 * away)
    pixel = t / np.float32(studio.focal)
    lines = np.maximum(
        *(_line(at + np.float32(target[axis]), pixel * _stretch(studio, way, axis)) for at, axis in ((x, 0), (z, 2)))
    )
    shadow, contact = _shadow_sheet(studio, target, centres, radii), _contact_sheet(target, centres, radii)
    dark = np.maximum(_SHADOW * _on_sheet(shadow, x, z), _CONTACT * _on_sheet(contact, x, z))
    bare, grid = np.array(FLOOR, dtype=np.float32), np.array(GRID, dtype=np.float32)
    colour = (bare + lines[:, None] * (grid - bare)) * (1.0 - dark)[:, None]
    image[hit] = background + lit[:, None] * (colour - background)
    return image


def _line(at: Float32Array, pixel: Float32Array) -> Float32Array:
    """Return how much of the line at the nearest whole metre covers a place, 0 to 1, for pixels so wide."""
    width = np.maximum(np.float32(_LINE_M), pixel)
    away = np.abs(at - np.round(at))
    cover = np.clip((0.5 * width - away) / np.maximum(pixel, 1e-6) + 0.5, 0.0, 1.0)
    return np.asarray(cover * (np.float32(_LINE_M) / width), dtype=np.float32)


def _stretch(studio: Studio, way: Float32Array, axis: int) -> Float32Array:
    """Return how much longer a pixel is on the floor along x (0) or z (2) than in the air; `way`: (n, 3)."""
    flat = np.maximum(np.hypot(way[:, 0], way[:, 2]), 1e-6)
    return np.hypot(np.float32(studio.axes[0, axis]), way[:, axis] / flat / way[:, 1])


def _shadow_sheet(studio: Studio, target: FloatArray, centres: FloatArray, radii: FloatArray) -> Float32Array:
    """Return the light's shadow: each ball throws an ellipse, longer where the light stands lower."""
    light = studio.light
    along = light[[0, 2]] / np.hypot(light[0], light[2])
    across = np.array([-along[1], along[0]])
    outline = np.cos(_TURN)[:, None] * along / light[1] + np.sin(_TURN)[:, None] * across
    places = centres[..., [0, 2]] - centres[..., 1:2] / light[1] * light[[0, 2]]
    return _sheet(places - target[[0, 2]], radii, outline, np.ones(len(radii)), _SHADOW_BLUR)


def _contact_sheet(target: FloatArray, centres: FloatArray, radii: FloatArray) -> Float32Array:
    """Return the dark under what is close to the floor."""
    outline = 0.8 * np.stack((np.cos(_TURN), np.sin(_TURN)), axis=1)
    gap = np.maximum(centres[..., 1] - radii, 0.0).min(axis=1)
    return _sheet(
        centres[..., [0, 2]] - target[[0, 2]], radii, outline, np.exp(-gap / _CONTACT_HEIGHT_M), _CONTACT_BLUR
    )


def _sheet(
    places: FloatArray, radii: FloatArray, outline: FloatArray, strength: FloatArray, blur: float
) -> Float32Array:
    """Return a square of floor around the target with the hulls of pairs of outlines, blurred; 0 to 1."""
    from PIL import Image, ImageDraw, ImageFilter

    corners = places[:, :, None] + radii[:, :, None, None] * outline
    pixels = (corners + 0.5 * _SHEET_M) * (_SHEET_PIXELS / _SHEET_M)
    sheet = Image.new("L", (_SHEET_PIXELS, _SHEET_PIXELS))
    pen = ImageDraw.Draw(sheet)
    for index in np.argsort(strength):
        if strength[index] > 0.02:
            _fill_hull(pen, pixels[index], int(255 * strength[index]))
    return np.asarray(sheet.filter(ImageFilter.GaussianBlur(blur)), dtype=np.float32) / np.float32(255.0)


def _fill_hull(pen: ImageDraw, outlines: FloatArray, value: int) -> None:
    """Fill the hull of two like outlines, shape (2, n, 2): both, and what is between their sides."""
    first, second = outlines
    between = np.stack((first, np.roll(first, -1, axis=0), np.roll(second, -1, axis=0), second), axis=1)
    for corners in (first, second, *between):
        pen.polygon(corners.ravel().tolist(), fill=value)


def _on_sheet(sheet: Float32Array, x: Float32Array, z: Float32Array) -> Float32Array:
    """Return what a sheet says at places around the target, between its pixels in proportion; 0 beside it."""
    scale = np.float32(_SHEET_PIXELS / _SHEET_M)
    column = (x + np.float32(0.5 * _SHEET_M)) * scale - np.float32(0.5)
    row = (z + np.float32(0.5 * _SHEET_M)) * scale - np.float32(0.5)
    on = (column >= 0) & (column < _SHEET_PIXELS - 1) & (row >= 0) & (row < _SHEET_PIXELS - 1)
    column, row = column[on], row[on]
    left, top = column.astype(np.int32), row.astype(np.int32)
    right_share, down_share = column - left, row - top
    upper = sheet[top, left] * (1 - right_share) + sheet[top, left + 1] * right_share
    lower = sheet[top + 1, left] * (1 - right_share) + sheet[top + 1, left + 1] * right_share
    result = np.zeros_like(x)
    result[on] = upper * (1 - down_share) + lower * down_share
    return result
