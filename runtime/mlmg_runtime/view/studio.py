"""The camera and the light of stills and movies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.view.scene import Float32Array, Scene

_FROM_THE_SIDE_RAD = 0.6
_MARGIN_M = 0.22
_NEAREST_M = 4.0
CAMERA_SMOOTHING_S = 1.0
"""The camera's place over the ground is the mean of the figure's over so long."""


@dataclass(frozen=True)
class Studio:
    """A camera and a light that keep their directions, and the size of the pictures taken.

    Attributes
    ----------
    size : width and height of a picture, pixels.
    yaw_rad : from where the camera looks, from z towards x.
    pitch_rad : how far above the horizontal it stands.
    distance_m : how far from its target.
    fov_rad : the vertical angle of view.
    oversampling : each pixel of the body is the mean of this many by this many samples.
    """

    size: tuple[int, int]
    yaw_rad: float
    pitch_rad: float = 0.2
    distance_m: float = 5.0
    fov_rad: float = 0.42
    oversampling: int = 2

    @cached_property
    def axes(self) -> FloatArray:
        """Return the camera's right, up and backward directions, rows of shape (3, 3)."""
        sin_yaw, cos_yaw = np.sin(self.yaw_rad), np.cos(self.yaw_rad)
        sin_pitch, cos_pitch = np.sin(self.pitch_rad), np.cos(self.pitch_rad)
        back = np.array([sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch])
        right = np.array([cos_yaw, 0.0, -sin_yaw])
        return np.stack((right, np.cross(back, right), back))

    @cached_property
    def light(self) -> FloatArray:
        """Return the unit direction to the light: above the camera's left shoulder."""
        way = np.array([-0.55, 0.0, 0.5]) @ self.axes
        way[1] = 1.15
        return np.asarray(way / np.linalg.norm(way))

    @cached_property
    def focal(self) -> float:
        """Return how many pixels a length of 1 takes at a distance of 1."""
        return 0.5 * self.size[1] / float(np.tan(0.5 * self.fov_rad))

    @cached_property
    def rays(self) -> Float32Array:
        """Return the unit direction through each pixel, shape (height, width, 3)."""
        return self._rays(1)

    @cached_property
    def fine_rays(self) -> Float32Array:
        """Return the unit direction through each sample, shape (n * height, n * width, 3)."""
        return self._rays(self.oversampling)

    def eye(self, target: FloatArray) -> FloatArray:
        """Return where the camera stands to look at `target`, shape (3,)."""
        return np.asarray(target + self.distance_m * self.axes[2])

    def _rays(self, n: int) -> Float32Array:
        width, height = n * self.size[0], n * self.size[1]
        x = (np.arange(width) + 0.5 - 0.5 * width) / (n * self.focal)
        y = (0.5 * height - np.arange(height) - 0.5) / (n * self.focal)
        ways = x[None, :, None] * self.axes[0] + y[:, None, None] * self.axes[1] - self.axes[2]
        return np.asarray(ways / np.linalg.norm(ways, axis=-1, keepdims=True), dtype=np.float32)


def studio_for(scene: Scene, size: tuple[int, int], frames: IntArray, oversampling: int = 2) -> Studio:
    """Return a studio that sees a figure from ahead and from the side, as near as lets it fit.

    Parameters
    ----------
    size : width and height of a picture, pixels.
    frames : the frames to be shown, all of which fit, with the camera on `camera_path`.
    """
    studio = Studio(size, scene.heading_rad + _FROM_THE_SIDE_RAD, oversampling=oversampling)
    seen = (scene.positions[frames] - camera_path(scene)[frames][:, None]) @ studio.axes.T
    across, upright = np.abs(seen[..., :2]).max(axis=(0, 1)) + _MARGIN_M
    nearest = max(upright, across * size[1] / size[0]) / np.tan(0.5 * studio.fov_rad)
    return replace(studio, distance_m=float(max(nearest + seen[..., 2].max(), _NEAREST_M)))


def camera_path(scene: Scene, smoothing_s: float = CAMERA_SMOOTHING_S) -> FloatArray:
    """Return where a camera that follows the figure looks in each frame, shape (n_frames, 3).

    Over the ground it follows smoothly; its height is half that of the body.
    """
    path = scene.positions[:, scene.root].astype(np.float64)
    reach = max(round(0.5 * smoothing_s / scene.frame_time_s), 1)
    padded = np.concatenate((np.repeat(path[:1], reach, axis=0), path, np.repeat(path[-1:], reach, axis=0)))
    sums = np.concatenate((np.zeros((1, 3)), np.cumsum(padded, axis=0)))
    smooth = (sums[2 * reach + 1 :] - sums[: -2 * reach - 1]) / (2 * reach + 1)
    smooth[:, 1] = 0.5 * np.median(scene.positions[..., 1].max(axis=1))
    return np.asarray(smooth)
