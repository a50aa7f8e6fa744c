"""What all tests share: the way to the real clips."""

from pathlib import Path

import pytest
from hypothesis import settings

# A machine shared with others is slow at times; how long an example takes is no part of a test.
settings.register_profile("mlmg", deadline=None)
settings.load_profile("mlmg")


@pytest.fixture(scope="session")
def mocap() -> Path:
    """Return the folder of real clips, which is no part of the project; without it, skip."""
    folder = Path(__file__).parents[2] / "shared" / "mocap"
    if not folder.is_dir():
        pytest.skip("the real clips of ../shared/mocap are absent")
    return folder
