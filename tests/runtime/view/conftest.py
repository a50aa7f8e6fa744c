"""What the tests of the viewer share: a made-up person, and what a run told about it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mlmg_runtime.bvh import Bvh, Joint
from mlmg_runtime.view.captions import story_from_report
from mlmg_runtime.view.scene import Scene, scene_from_bvh

# Name, parent, offset in metres, End Site: a body in a T-pose that looks along z.
_BODY = (
    ("a", None, (0.0, 0.0, 0.0), None),
    ("left thigh", "a", (0.1, -0.05, 0.0), None),
    ("left shin", "left thigh", (0.0, -0.42, 0.0), None),
    ("left foot", "left shin", (0.0, -0.40, 0.0), None),
    ("left toe", "left foot", (0.0, -0.06, 0.13), (0.0, 0.0, 0.06)),
    ("right thigh", "a", (-0.1, -0.05, 0.0), None),
    ("right shin", "right thigh", (0.0, -0.42, 0.0), None),
    ("right foot", "right shin", (0.0, -0.40, 0.0), None),
    ("right toe", "right foot", (0.0, -0.06, 0.13), (0.0, 0.0, 0.06)),
    ("spine", "a", (0.0, 0.12, 0.0), None),
    ("chest", "spine", (0.0, 0.2, 0.0), None),
    ("neck", "chest", (0.0, 0.2, 0.0), None),
    ("head", "neck", (0.0, 0.1, 0.0), (0.0, 0.18, 0.0)),
    ("left collar", "chest", (0.03, 0.15, 0.0), None),
    ("left arm", "left collar", (0.14, 0.0, 0.0), None),
    ("left elbow", "left arm", (0.28, 0.0, 0.0), None),
    ("left hand", "left elbow", (0.25, 0.0, 0.0), None),
    ("right collar", "chest", (-0.03, 0.15, 0.0), None),
    ("right arm", "right collar", (-0.14, 0.0, 0.0), None),
    ("right elbow", "right arm", (-0.28, 0.0, 0.0), None),
    ("right hand", "right elbow", (-0.25, 0.0, 0.0), None),
)
_N_FRAMES = 60


def _scaled(offset: tuple[float, float, float], unit: float) -> tuple[float, float, float]:
    x, y, z = (part / unit for part in offset)
    return x, y, z


@pytest.fixture(scope="session")
def person() -> Callable[..., Bvh]:
    """Return a function that makes two seconds of a person who slides 3 m along z and raises the left arm.

    `unit` is the length of the file's unit in metres; `height` where the hips are, in metres; `n_frames` how many
    frames there are, at 30 a second.
    """

    def make(unit: float = 0.01, height: float = 1.0, n_frames: int = _N_FRAMES) -> Bvh:
        names = [name for name, *_ in _BODY]
        turns = ("Zrotation", "Xrotation", "Yrotation")
        joints = []
        for name, parent, offset, end in _BODY:
            channels = turns if parent else ("Xposition", "Yposition", "Zposition", *turns)
            above = names.index(parent) if parent else -1
            joints.append(Joint(name, above, _scaled(offset, unit), channels, _scaled(end, unit) if end else None))
        frames = np.zeros((n_frames, 3 + 3 * len(joints)))
        frames[:, 1] = height / unit
        frames[:, 2] = np.linspace(0.0, 3.0, n_frames) / unit
        frames[:, 3 + 3 * names.index("left arm")] = np.linspace(0.0, 60.0, n_frames)
        return Bvh(tuple(joints), 1.0 / 30.0, frames)

    return make


@pytest.fixture(scope="session")
def report() -> dict[str, Any]:
    """Return the report of a run of 60 frames on two graphs."""
    return {
        "library": "small.mlmg",
        "frame_rate": 30.0,
        "n_frames": _N_FRAMES,
        "seed": 0,
        "commands": [
            {"text": "Idle_01", "span": [1, 1, 1, 8], "begin": 0, "arrive": 0, "end": 0},
            {"text": "WALK for 1 sec", "span": [2, 1, 2, 15], "begin": 0, "arrive": 20, "end": 30},
            {"text": "Sub TALK </script>", "span": [3, 1, 3, 9], "begin": 30, "arrive": 40, "end": 60},
        ],
        "tracks": {
            "Full-Body": [
                {"kind": "clip", "begin": 0, "end": 10, "motion": "Idle_01", "clip_begin": 0, "speed": 1.0},
                {"kind": "transition", "begin": 10, "end": 20, "from": ["Idle_01", 9], "to": ["Walk_01", 8]},
                {"kind": "clip", "begin": 20, "end": 60, "motion": "Walk_01", "clip_begin": 9, "speed": 1.1},
            ],
            "Upper-Body": [
                {"kind": "transition", "begin": 30, "end": 40, "from": ["Walk_01", 9], "to": ["Talk_01", 8]},
                {"kind": "clip", "begin": 40, "end": 50, "motion": "Talk_01", "clip_begin": 9, "speed": 1.0},
                {"kind": "transition", "begin": 50, "end": 55, "from": ["Talk_01", 9], "to": ["Talk_01", 2]},
                {"kind": "blend", "begin": 55, "end": 57, "from": ["Talk_01", 7], "to": None},
                {"kind": "blend", "begin": 57, "end": 58},
            ],
        },
        "joints": {"Upper-Body": ["chest", "left arm", "no such joint"]},
    }


@pytest.fixture(scope="session")
def scene(person: Callable[..., Bvh], report: dict[str, Any]) -> Scene:
    """Return the person as a scene with the report's story."""
    return scene_from_bvh(person(), "stroll", story=story_from_report(report))
