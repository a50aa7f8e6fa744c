"""How much a transition hurries the joints: whether one must go faster than it ever does in the two clips.

Where someone stands, the toes hardly move in a whole clip. A blend that leads them to where another clip's feet stand
slides them over the ground, though all other joints fit well and the distance of the windows is small.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mlmg_runtime.arrays import FloatArray, IntArray
from mlmg_runtime.blending import WEIGHTS
from mlmg_runtime.building.connect import Edges
from mlmg_runtime.pace import steps
from mlmg_runtime.point_cloud import best_fit

# So many transitions are blended at once; their points take some 20 MB.
AT_ONCE = 1000


@dataclass(frozen=True, slots=True, eq=False)
class Hurry:
    """The movement of a graph's joints in its motions, one motion after the other.

    Attributes
    ----------
    points : array, shape (sum of n_frames, n_joints, 3). World positions, y up.
    first : array, shape (n_motions + 1,). Where each motion begins, and their end.
    longest : array, shape (n_motions, n_joints). Each joint's longest step from a frame to the next; at least so long
        that it is hardly seen.
    weights : array, shape (n_joints,). Weights of the joints in the point-cloud distance.
    window : k. blend : how transitions are weighted, "c1" or "linear".
    """

    points: FloatArray
    first: IntArray
    longest: FloatArray
    weights: FloatArray
    window: int
    blend: str

    def of(self, edges: Edges) -> FloatArray:
        """Return the longest step of a joint in each transition, as a multiple of its longest in the two clips.

        It is the largest multiple of all joints; blended are positions, which are near those of blended rotations.

        Returns
        -------
        array, shape (n_edges,).
        """
        numbers = np.arange(len(edges.distance))
        some = [numbers[start : start + AT_ONCE] for start in range(0, len(numbers), AT_ONCE)]
        return np.concatenate([np.empty(0), *(self._of(edges.where(part)) for part in some)])

    def _of(self, edges: Edges) -> FloatArray:
        source = self._points(edges.src_motion, edges.src_frame)
        target = self._points(edges.dst_motion, edges.dst_frame - self.window + 1)
        fit = best_fit(source[:, 1:-1], target[:, 1:-1], self.weights)
        ground = (target[..., 0] + 1j * target[..., 2]) * np.exp(-1j * fit.yaw_rad)[:, None, None]
        ground += (fit.shift[:, 0] + 1j * fit.shift[:, 1])[:, None, None]
        weight = WEIGHTS[self.blend](np.arange(1, self.window + 1) / self.window)
        weight = np.concatenate(([1.0], weight, [0.0]))[:, None]
        across = np.diff(weight * (source[..., 0] + 1j * source[..., 2]) + (1.0 - weight) * ground, axis=1)
        up = np.diff(weight * source[..., 1] + (1.0 - weight) * target[..., 1], axis=1)
        taken = np.sqrt(across.real**2 + across.imag**2 + up**2).max(axis=1)
        longest = np.maximum(self.longest[edges.src_motion], self.longest[edges.dst_motion])
        return np.asarray((taken / np.maximum(longest, np.finfo(float).tiny)).max(axis=1))

    def _points(self, motion: IntArray, frame: IntArray) -> FloatArray:
        """Return windows and the frames before and after them, shape (n, k + 2, n_joints, 3); clips' ends repeated."""
        rows = (self.first[motion] + frame)[:, None] + np.arange(-1, self.window + 1)
        inside = np.clip(rows, self.first[motion][:, None], self.first[motion + 1][:, None] - 1)
        return np.asarray(self.points[inside])


def hurry(points: Sequence[FloatArray], weights: FloatArray, window: int, blend: str, creep: float = 0.0) -> Hurry:
    """Return what tells how much transitions hurry.

    Parameters
    ----------
    points : world positions of a graph's joints in each of its motions, shape (n_frames, n_joints, 3), y up.
    weights, window, blend : as the graph is configured.
    creep : the longest step that is hardly seen, in the length unit.
    """
    longest = [steps(p).max(axis=0, initial=creep) for p in points]
    first = np.cumsum([0, *(len(p) for p in points)])
    return Hurry(np.concatenate(points), first, np.array(longest), weights, window, blend)
