"""How far joints go from frame to frame in the motions of a library, at most: what blends are held against."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.library import Library
from mlmg_runtime.pace import steps
from mlmg_runtime.skeleton import Poses, Skeleton, carried_positions, world_transforms


@dataclass(slots=True)
class LongestSteps:
    """The longest steps of joints in the motions of a library. What has been worked out is kept."""

    library: Library
    _kept: dict[tuple[tuple[int, ...], str], FloatArray] = field(default_factory=dict)

    def of(self, joints: tuple[int, ...], motion: str) -> FloatArray:
        """Return the longest step of each joint of a part from a frame to the next, `seen`; shape (2 * n_joints,)."""
        key = (joints, motion)
        if key not in self._kept:
            self._kept[key] = steps(seen(self.library.skeleton, self.library.poses(motion), joints)).max(axis=0)
        return self._kept[key]


def seen(skeleton: Skeleton, poses: Poses, joints: Sequence[int]) -> FloatArray:
    """Return where a part's joints are in the world, and then from what carries them; (n_frames, 2 * n_joints, 3)."""
    turned, places = world_transforms(skeleton, poses)
    return np.concatenate((places[:, list(joints)], carried_positions(skeleton, turned, places, joints)), axis=1)
