"""The points a body is drawn with: its joints, then the tips of those that end a limb."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.skeleton import Skeleton

# A tip that the file leaves out is drawn as far from its joint as a hand is long beside a forearm.
_TIP_SHARE = 0.42
_SHORTEST = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points that move, and the tree that they form.

    Attributes
    ----------
    parents : the index of each point's parent, -1 for the root; parents stand before their children. Point i
        is joint i as long as there are joints; the tips follow.
    positions : array, shape (n_frames, n_points, 3). In the world, y up.
    lengths : array, shape (n_points,). How far each point is from its parent, the median over the frames.
    offsets : of the points after the joints: where each stands in the frame of its parent, a joint, shape (3,).
    """

    parents: tuple[int, ...]
    positions: FloatArray
    lengths: FloatArray
    offsets: tuple[FloatArray, ...] = ()

    def scaled(self, factor: float) -> Points:
        """Return the points of a body `factor` times as large."""
        return replace(
            self,
            positions=factor * self.positions,
            lengths=factor * self.lengths,
            offsets=tuple(factor * offset for offset in self.offsets),
        )

    def carried(self, travel: int, rotation: FloatArray, position: FloatArray) -> FloatArray:
        """Return where all points are when the joints are elsewhere, shape (n_frames, n_points, 3).

        Joints above the travel joint, which never move, are put where the travel joint is.

        Parameters
        ----------
        rotation : array, shape (n_frames, n_joints, 4). In the world, unit quaternions.
        position : array, shape (n_frames, n_joints, 3). In the world.
        """
        carriers = self.parents[len(self.parents) - len(self.offsets) :]
        moved = [
            position[:, joint] + rotations.rotate(rotation[:, joint], offset)
            for joint, offset in zip(carriers, self.offsets, strict=True)
        ]
        positions = np.concatenate((position, *(point[:, None] for point in moved)), axis=1)
        positions[:, :travel] = positions[:, travel : travel + 1]
        return positions


def points_from_transforms(skeleton: Skeleton, rotation: FloatArray, position: FloatArray) -> Points:
    """Return joints and tips of a skeleton.

    A joint that ends a limb gets a tip at its End Site; where that is missing or of no length, straight on.

    Parameters
    ----------
    rotation, position : of the joints, as in `Points.carried`.
    """
    offsets = {joint: _tip_offset(skeleton, joint) for joint, children in enumerate(skeleton.children) if not children}
    parents = (*skeleton.parents, *offsets)
    points = Points(parents, position, np.zeros(len(parents)), tuple(offsets.values()))
    positions = points.carried(skeleton.travel, rotation, position)
    steps = positions - positions[:, [max(parent, 0) for parent in parents]]
    lengths = np.median(np.linalg.norm(steps, axis=-1), axis=0)
    return replace(points, positions=positions, lengths=lengths)


def _tip_offset(skeleton: Skeleton, joint: int) -> FloatArray:
    """Return where the tip of an end joint stands in that joint's frame, shape (3,)."""
    own = np.asarray(skeleton.joints[joint].offset)
    end = np.asarray(skeleton.joints[joint].end_site or (0.0, 0.0, 0.0))
    if np.linalg.norm(end) > _SHORTEST * np.linalg.norm(own):
        return end
    return _TIP_SHARE * own
