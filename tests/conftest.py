"""What all tests share: the way to the real clips, and the flag that rewrites golden files."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

from mlmg_lang.commands.console import one_thread_a_product

one_thread_a_product()  # as in the commands: else as many as there are processors wait by spinning, beside other tests

from mlmg_runtime.building.build import build_library  # noqa: E402
from mlmg_runtime.building.reading.read_configuration import read_configuration  # noqa: E402
from mlmg_runtime.built_library import BuiltLibrary  # noqa: E402
from mlmg_runtime.database import write_database  # noqa: E402
from mlmg_runtime.demo.library import demo_library as build_demo_library  # noqa: E402
from mlmg_runtime.library import Library, open_library  # noqa: E402

# A machine shared with others is slow at times; how long an example takes is no part of a test.
# A few are tried each time; `make random` tries many.
settings.register_profile("mlmg", deadline=None, max_examples=25)
settings.register_profile("many", deadline=None, max_examples=500)
settings.load_profile("mlmg")

# Programs that tests start are compiled once, as they are for users, and not at each start.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="rewrite the files in tests/golden and tests/invalid")
    parser.addoption("--all-edits", action="store_true", help="try every slip of the hand, not a part of them")
    parser.addoption("--edits", type=int, default=90, help="how many random edits the language server is tried with")


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


@pytest.fixture(scope="session")
def build_reference(mocap: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., BuiltLibrary]:
    """Return a function that builds the reference library from folders of real clips.

    Those of all folders but the first are stepping stones: on every graph, without a tag.
    """
    configuration = (Path(__file__).parent / "reference.toml").read_text(encoding="utf-8")

    def build(*folders: str) -> BuiltLibrary:
        clips = ", ".join(f'"{(mocap / folder).as_posix()}/*.bvh"' for folder in folders)
        stones = "\n".join(
            f"{clip.stem} = []" for folder in folders[1:] for clip in sorted((mocap / folder).glob("*.bvh"))
        )
        path = tmp_path_factory.mktemp("reference") / "library.toml"
        path.write_text(configuration.replace("CLIPS", clips).replace("# STONES", stones), encoding="utf-8")
        return build_library(read_configuration(path), None, lambda *_: None)

    return build


@pytest.fixture(scope="session")
def reference_built(build_reference: Callable[..., BuiltLibrary]) -> BuiltLibrary:
    """Return the reference library as it was built."""
    return build_reference("reference")


@pytest.fixture(scope="session")
def reference_library(reference_built: BuiltLibrary, tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Return the reference library, written and opened."""
    path = tmp_path_factory.mktemp("opened") / "reference.mlmg"
    write_database(reference_built, path)
    return open_library(path)
