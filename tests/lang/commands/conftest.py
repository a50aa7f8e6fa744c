"""A library of three small clips, as a user would have it: a folder of BVH files and a library.toml."""

from __future__ import annotations

import io
import shutil
from contextlib import redirect_stderr
from pathlib import Path

import numpy as np
import pytest

from mlmg_lang.commands import mlmg
from mlmg_runtime import bvh
from mlmg_runtime.bvh.document import POSITION_CHANNELS, Bvh, Joint

CONFIGURATION = """\
[library]
clips = ["*.bvh"]
start = "Stand"

[[graph]]
name = "Full-Body"

[[graph]]
name = "Upper-Body"
joints = ["Spine"]
threshold = { quantile = 0.3 }

[tags.Full-Body]
Stand = ["IDLE"]
Step = ["WALK"]
Reach = ["TALK"]

[tags.Upper-Body]
Step = ["SWING"]
Reach = ["TALK"]
"""
TURNS = ("Zrotation", "Xrotation", "Yrotation")


def clip(seed: int, n_frames: int = 90) -> Bvh:
    """Return a body of four joints that sways smoothly, in no way twice."""
    joints = (
        Joint("Hips", -1, (0.0, 0.0, 0.0), POSITION_CHANNELS + TURNS),
        Joint("Spine", 0, (0.0, 20.0, 0.0), TURNS),
        Joint("Head", 1, (0.0, 30.0, 0.0), TURNS, (0.0, 20.0, 0.0)),
        Joint("Foot", 0, (0.0, -80.0, 0.0), TURNS, (0.0, 0.0, 10.0)),
    )
    random = np.random.default_rng(seed)
    phases, speeds = random.uniform(0, 6, (2, 15))
    frames = 12.0 * np.sin(phases + (0.05 + 0.02 * speeds) * np.arange(n_frames)[:, None])
    frames[:, :3] += (0.0, 90.0, 0.0)
    return Bvh(joints, 1 / 30, frames)


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with clips, a configuration and the library that is built of them, to be copied."""
    made = tmp_path_factory.mktemp("made")
    for seed, name in enumerate(("Stand", "Step", "Reach")):
        bvh.write(clip(seed), made / f"{name}.bvh")
    (made / "library.toml").write_text(CONFIGURATION, encoding="utf-8")
    with redirect_stderr(io.StringIO()):
        assert mlmg.main(["build", str(made / "library.toml"), "-o", str(made / "my.mlmg")]) == 0
    return made


@pytest.fixture
def folder(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with clips and a configuration, and stand in it; no setting of the user's counts."""
    for path in made.iterdir():
        if path.name != "my.mlmg":
            shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("MLMG_LIBRARY", raising=False)
    return tmp_path


@pytest.fixture
def built(made: Path, folder: Path) -> Path:
    """Return the folder with its library."""
    shutil.copy(made / "my.mlmg", folder)
    return folder
