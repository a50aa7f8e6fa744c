"""What all tests share: the way to the real clips, and the flag that rewrites golden files."""

from pathlib import Path

import pytest
from hypothesis import settings

from mlmg_runtime.demo.library import demo_library as build_demo_library
from mlmg_runtime.library import Library, open_library

# A machine shared with others is slow at times; how long an example takes is no part of a test.
settings.register_profile("mlmg", deadline=None)
settings.load_profile("mlmg")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="rewrite the files in tests/golden and tests/invalid")


@pytest.fixture(scope="session")
def mocap() -> Path:
    """Return the folder of real clips, which is no part of the project; without it, skip."""
    folder = Path(__file__).parents[2] / "shared" / "mocap"
    if not folder.is_dir():
        pytest.skip("the real clips of ../shared/mocap are absent")
    return folder


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark every test that needs the real clips, so that they can be chosen or left out together."""
    for item in items:
        if "mocap" in getattr(item, "fixturenames", ()):
            item.add_marker("mocap")


@pytest.fixture(scope="session")
def demo_library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Return the demo library, built afresh: a cache of the user's is neither used nor touched."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MLMG_CACHE", str(tmp_path_factory.mktemp("cache")))
        return open_library(build_demo_library())
