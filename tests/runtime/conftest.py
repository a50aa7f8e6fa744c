"""What the tests of the runtime share: made-up BVH documents, and a slow way to find their joints."""

from collections.abc import Callable
from functools import reduce

import numpy as np
import pytest
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh import Bvh, Joint

POSITIONS = ("Xposition", "Yposition", "Zposition")
CHANNELS = [
    ("Zrotation", "Xrotation", "Yrotation"),
    (*POSITIONS, "Yrotation", "Zrotation", "Xrotation"),
    ("Xrotation",),
    ("Zrotation", "Yrotation"),
    (),
    ("Zposition", "Xrotation", "Yposition", "Zrotation", "Xposition", "Yrotation"),
    ("Yposition", "Xrotation", "Yrotation", "Zrotation"),
]


@pytest.fixture(scope="session")
def random_bvh() -> Callable[[int], Bvh]:
    """Return a function that makes a document of 12 joints with channels of all kinds from a seed."""
    return _random_bvh


@pytest.fixture(scope="session")
def slow_positions() -> Callable[[Bvh], FloatArray]:
    """Return a function that multiplies the matrices of each frame: shape (n_frames, n_joints, 3)."""
    return _slow_positions


def _random_bvh(seed: int) -> Bvh:
    random = np.random.default_rng(seed)
    joints = [Joint("root", -1, (0.5, -1.0, 2.0), (*POSITIONS, "Yrotation", "Xrotation", "Zrotation"))]
    open_joints = [0]
    for index in range(1, 12):
        # The root gets two children, so that it is the travel joint.
        depth = 1 if index == 2 else int(random.integers(1, len(open_joints) + 1))
        del open_joints[depth:]
        x, y, z = random.normal(size=3).tolist()
        channels = CHANNELS[int(random.integers(len(CHANNELS)))]
        joints.append(Joint(f"joint{index}", open_joints[-1], (x, y, z), channels))
        open_joints.append(index)
    n_channels = sum(len(joint.channels) for joint in joints)
    steps = random.normal(scale=9.0, size=(20, n_channels))
    return Bvh(tuple(joints), 1.0 / 30.0, np.cumsum(steps, axis=0))


def _slow_positions(bvh: Bvh) -> FloatArray:
    frames = []
    for values in bvh.frames:
        rest = iter(values.tolist())
        world: list[FloatArray] = []
        for joint in bvh.joints:
            channels = {channel: next(rest) for channel in joint.channels}
            above = world[joint.parent] if joint.parent >= 0 else np.eye(4)
            world.append(reduce(np.matmul, _matrices(joint, channels), above))
        frames.append([matrix[:3, 3] for matrix in world])
    return np.array(frames)


def _matrices(joint: Joint, channels: dict[str, float]) -> list[FloatArray]:
    """Return the shift and the turns of a joint in the order of its channels, as 4 x 4 matrices."""
    shift = np.eye(4)
    shift[:3, 3] = [channels.get(name, joint.offset[axis]) for axis, name in enumerate(POSITIONS)]
    return [shift, *(_turn(name[0], angle) for name, angle in channels.items() if name.endswith("rotation"))]


def _turn(axis: str, angle_deg: float) -> FloatArray:
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    first, second = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    matrix = np.eye(4)
    matrix[first, first] = matrix[second, second] = c
    matrix[second, first], matrix[first, second] = s, -s
    return matrix
