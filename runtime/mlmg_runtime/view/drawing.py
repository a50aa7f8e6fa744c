"""A picture of one frame, drawn in software: the figure that the player shows, in the same light."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.view.floor import floor
from mlmg_runtime.view.palette import BODY
from mlmg_runtime.view.scene import Scene, ball_centres
from mlmg_runtime.view.solid import solid
from mlmg_runtime.view.studio import Studio

if TYPE_CHECKING:
    from PIL.Image import Image

Rgb: TypeAlias = tuple[int, int, int]


def draw(scene: Scene, frame: int, studio: Studio, target: FloatArray, tints: Mapping[int, Rgb] | None = None) -> Image:
    """Return a picture of one frame.

    Parameters
    ----------
    target : where the camera looks, shape (3,), metres.
    tints : the colours of the parts that some joints move; the others have the body's.
    """
    from PIL.Image import fromarray

    balls = [ball for capsule in scene.capsules for ball in (capsule.first, capsule.second)]
    centres = ball_centres(scene.positions[frame], balls).reshape(-1, 2, 3)
    radii = np.array([ball.radius for ball in balls]).reshape(-1, 2)
    colours = np.array([(tints or {}).get(capsule.joint, BODY) for capsule in scene.capsules], dtype=np.float32)
    image = floor(studio, target, centres, radii)
    body = solid(studio, studio.eye(target), centres, radii, colours)
    rows, columns = body.cover.shape
    part = image[body.top : body.top + rows, body.left : body.left + columns]
    part *= 1.0 - body.cover[..., None]
    part += body.colour
    return fromarray(np.clip(image, 0.0, 255.0).astype(np.uint8))
