"""What the tests of the runtime share: made-up BVH documents and where their joints are, a small library."""

from collections.abc import Callable
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.bvh import Bvh, Joint, write
from mlmg_runtime.database import write_database
from mlmg_runtime.library import Library, open_library

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


# A small library: five made-up clips of a body of nine joints, and four graphs on three levels.

_TURNS = ("Zrotation", "Xrotation", "Yrotation")
_SMALL_JOINTS = (
    Joint("Hips", -1, (0.0, 0.0, 0.0), (*POSITIONS, *_TURNS)),
    Joint("Spine", 0, (0.0, 25.0, 1.0), _TURNS),
    Joint("LeftArm", 1, (18.0, 30.0, 0.0), _TURNS),
    Joint("LeftHand", 2, (27.0, -3.0, 0.0), _TURNS, (12.0, 0.0, 2.0)),
    Joint("RightArm", 1, (-18.0, 30.0, 0.0), _TURNS),
    Joint("RightHand", 4, (-27.0, -3.0, 0.0), _TURNS, (-12.0, 0.0, 2.0)),
    Joint("LeftLeg", 0, (9.0, -45.0, 0.0), _TURNS, (0.0, -42.0, 6.0)),
    Joint("RightLeg", 0, (-9.0, -45.0, 0.0), _TURNS, (0.0, -42.0, 6.0)),
)
# Motion -> frames, centimetres a second ahead, swing of the joints in degrees.
_SMALL_CLIPS = {
    "Stand": (120, 0.0, 3.0),
    "Stroll": (110, 60.0, 10.0),
    "Sway": (100, 5.0, 7.0),
    "Reach": (90, 10.0, 8.0),
    "Wave": (80, 0.0, 9.0),
}
SMALL_CONFIGURATION = """\
[library]
frame_rate = 30
start = "Stand"

[[graph]]
name = "Full-Body"
window = 8
weights = { LeftHand = 2.0, RightLeg = 0.5 }

[[graph]]
name = "Upper-Body"
joints = ["Spine"]
window = 8

[[graph]]
name = "Left-Arm"
joints = ["LeftArm"]
window = 6

[[graph]]
name = "Right-Arm"
joints = ["RightArm"]
window = 6

[tags.Full-Body]
Stand = ["IDLE"]
Stroll = ["WALK", "GO"]
Sway = ["IDLE", "GO"]
Reach = ["REACH"]

[tags.Upper-Body]
Stand = ["IDLE"]
Stroll = ["SWING"]
Reach = ["REACH"]
Wave = []

[tags.Left-Arm]
Wave = ["WAVE"]
Reach = ["REACH"]
Stand = ["IDLE"]

[tags.Right-Arm]
Stroll = ["SWING"]
Stand = ["IDLE"]
Wave = ["WAVE"]
Reach = ["REACH"]

[[transitions]]
graph = "Full-Body"
forbid = [["REACH", "REACH"]]

[[transitions]]
graph = "Upper-Body"
forbid = [["REACH", "REACH"], ["REACH", "IDLE"], ["REACH", "Wave"]]
"""


@pytest.fixture(scope="session")
def small_clips() -> dict[str, Bvh]:
    """Return clips of smooth random curves: each swings about one pose, which no two share wholly."""
    return {name: _small_clip(seed, *what) for seed, (name, what) in enumerate(_SMALL_CLIPS.items())}


@pytest.fixture(scope="session")
def small_configuration() -> str:
    """Return a configuration of the small clips: three levels of graphs, two of them siblings."""
    return SMALL_CONFIGURATION


@pytest.fixture
def small_folder(tmp_path: Path, small_clips: dict[str, Bvh]) -> Path:
    """Return a new folder with the small clips and their configuration, library.toml."""
    return _write_small(tmp_path, small_clips)


@pytest.fixture(scope="session")
def small_library(tmp_path_factory: pytest.TempPathFactory, small_clips: dict[str, Bvh]) -> Library:
    """Return the library that the small configuration builds."""
    folder = _write_small(tmp_path_factory.mktemp("small"), small_clips)
    built = build_library(read_configuration(folder / "library.toml"), None, lambda *_: None)
    write_database(built, folder / "small.mlmg")
    return open_library(folder / "small.mlmg")


def _write_small(folder: Path, clips: dict[str, Bvh]) -> Path:
    for name, clip in clips.items():
        write(clip, folder / f"{name}.bvh")
    (folder / "library.toml").write_text(SMALL_CONFIGURATION, encoding="utf-8")
    return folder


def _small_clip(seed: int, n_frames: int, speed_cm_s: float, swing_deg: float) -> Bvh:
    random = np.random.default_rng(seed)
    time_s = np.arange(n_frames)[:, None] / 30.0
    n_turns = 3 * len(_SMALL_JOINTS)
    pose = random.normal(scale=3.0, size=n_turns)
    pace = 2.0 * np.pi * random.choice([0.6, 0.75, 0.9], size=n_turns)
    turns = pose + swing_deg * np.sin(pace * time_s + random.uniform(0.0, 6.0, size=n_turns))
    heading = np.radians(20.0) * time_s[:, 0] + random.uniform(0.0, 6.0)
    steps = speed_cm_s / 30.0 * np.stack((np.sin(heading), np.zeros(n_frames), np.cos(heading)), axis=1)
    place = np.cumsum(steps, axis=0) + random.normal(scale=200.0, size=3) * (1.0, 0.0, 1.0)
    place[:, 1] = 88.0 + np.sin(4.0 * time_s[:, 0])
    # The hips face the way they go; the vertical axis is the last of their channels.
    turns[:, :2] *= 0.3
    turns[:, 2] = np.degrees(heading)
    return Bvh(_SMALL_JOINTS, 1.0 / 30.0, np.concatenate((place, turns), axis=1))
