"""The points a body is drawn with: its joints, then the tips of those that end a limb."""

from __future__ import annotations

from dataclasses import dataclass

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
    """

    parents: tuple[int, ...]
    positions: FloatArray
    lengths: FloatArray


def points_from_transforms(skeleton: Skeleton, rotation: FloatArray, position: FloatArray) -> Points:
    """Return joints and tips of a skeleton.

    A joint that ends a limb gets a tip at its End Site; where that is missing or of no length, straight on.
    Joints above the travel joint, which never move, are put where the travel joint is.

    Parameters
    ----------
    rotation : array, shape (n_frames, n_joints, 4). In the world, unit quaternions.
    position : array, shape (n_frames, n_joints, 3). In the world.
    """
    offsets = {joint: _tip_offset(skeleton, joint) for joint, children in enumerate(skeleton.children) if not children}
    tips = [position[:, j] + rotations.rotate(rotation[:, j], offset) for j, offset in offsets.items()]
    positions = np.concatenate((position, *(tip[:, None] for tip in tips)), axis=1)
    positions[:, : skeleton.travel] = positions[:, skeleton.travel : skeleton.travel + 1]
    parents = (*skeleton.parents, *offsets)
    steps = positions - positions[:, [max(parent, 0) for parent in parents]]
    lengths = np.median(np.linalg.norm(steps, axis=-1), axis=0)
    return Points(parents, positions, lengths)


def _tip_offset(skeleton: Skeleton, joint: int) -> FloatArray:
    """Return where the tip of an end joint stands in that joint's frame, shape (3,)."""
    own = np.asarray(skeleton.joints[joint].offset)
    end = np.asarray(skeleton.joints[joint].end_site or (0.0, 0.0, 0.0))
    if np.linalg.norm(end) > _SHORTEST * np.linalg.norm(own):
        return end
    return _TIP_SHARE * own
