"""What the tests of the demo motions share: each clip as poses, and where its joints are."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.demo.clips import demo_clips
from mlmg_runtime.skeleton import Poses, Skeleton, world_transforms

# From the ankle of a flat foot to the point where the heel touches the ground, cm.
HEEL = np.array([0.0, -8.0, -5.0])


@dataclass(frozen=True)
class Clip:
    skeleton: Skeleton
    poses: Poses
    rotations: FloatArray
    positions: FloatArray

    def at(self, joint: str) -> FloatArray:
        """Return a joint's world positions, shape (n_frames, 3)."""
        return self.positions[:, self.skeleton.names.index(joint)]

    def local(self, joint: str) -> FloatArray:
        """Return a joint's local rotations, shape (n_frames, 4)."""
        return self.poses.rotations[:, self.skeleton.names.index(joint)]

    def heel(self, side: str) -> FloatArray:
        """Return the world positions of a heel's sole, shape (n_frames, 3)."""
        turned = self.rotations[:, self.skeleton.names.index(f"{side}Foot")]
        return self.at(f"{side}Foot") + rotations.rotate(turned, HEEL)

    def knee_deg(self, side: str) -> FloatArray:
        """Return how far a knee is bent, shape (n_frames,)."""
        return np.degrees(rotations.to_euler("XZY", self.local(f"{side}Leg"))[:, 0])


@pytest.fixture(scope="session")
def clips() -> dict[str, Clip]:
    """Return the demo clips by name."""
    made = {}
    for name, bvh in demo_clips().items():
        skeleton, poses = skeleton_from_bvh(bvh), poses_from_bvh(bvh)
        made[name] = Clip(skeleton, poses, *world_transforms(skeleton, poses))
    return made


@pytest.fixture(scope="session")
def plants() -> Callable[[FloatArray, float], list[FloatArray]]:
    """Return a function that finds where a point, (n_frames, 3), stays below a height: its paths there."""

    def find(point: FloatArray, height: float) -> list[FloatArray]:
        low = np.concatenate(([False], point[:, 1] < height, [False]))
        edges = np.flatnonzero(np.diff(low.astype(int)))
        return [point[begin:end] for begin, end in edges.reshape(-1, 2) if end - begin >= 3]

    return find
