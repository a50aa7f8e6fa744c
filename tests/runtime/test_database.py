import errno
import os
import random
import signal
import sqlite3
import subprocess
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime import database
from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.built_library import BuiltLibrary
from mlmg_runtime.database import read_graphs, write_database
from mlmg_runtime.errors import LibraryError
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.library_file import APPLICATION_ID, FORMAT_VERSION, open_database


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory, small_clips, small_configuration: str) -> BuiltLibrary:
    """Return the small library before it is written."""
    from mlmg_runtime.bvh import write

    folder = tmp_path_factory.mktemp("built")
    for name, clip in small_clips.items():
        write(clip, folder / f"{name}.bvh")
    (folder / "library.toml").write_text(small_configuration, encoding="utf-8")
    return build_library(read_configuration(folder / "library.toml"), None, lambda *_: None)


@pytest.fixture
def path(tmp_path: Path, built: BuiltLibrary) -> Path:
    """Return a library file of one's own."""
    write_database(built, tmp_path / "own.mlmg")
    return tmp_path / "own.mlmg"


def refusal(path: Path) -> str:
    with pytest.raises(LibraryError) as caught:
        use(open_library(path))
    return str(caught.value)


def use(library: Library) -> None:
    """Do with a library what playing does."""
    for graph in library.by_name.values():
        for edge in graph.edges:
            assert graph.motions[edge.src_motion]
            assert graph.motions[edge.dst_motion]
        for motion in graph.motions:
            assert library.poses(motion).n_frames == library.n_frames(motion)


def test_graphs_come_back_as_they_were_written(built: BuiltLibrary, path: Path) -> None:
    with open_database(path) as connection:
        graphs = [graph for graph, _ in read_graphs(connection)]
    for found, expected in zip(graphs, built.graphs, strict=True):
        for field in ("name", "parent", "joints", "window", "sigma", "blend", "motions", "tags"):
            assert getattr(found, field) == getattr(expected, field)
        for field in ("weights", "n_frames", "transitions", "forbidden", "oms", "hops"):
            np.testing.assert_array_equal(getattr(found, field), getattr(expected, field))


def test_clips_come_back_to_a_hundred_thousandth_of_a_degree_and_exactly_where_they_were(
    built: BuiltLibrary, path: Path
) -> None:
    from mlmg_runtime.rotations import angle_between

    library = open_library(path)
    assert library.skeleton == built.skeleton
    for name, poses in built.poses.items():
        found = library.poses(name)
        np.testing.assert_array_equal(found.positions, poses.positions)
        assert np.degrees(angle_between(found.rotations, poses.rotations)).max() < 2e-5
        np.testing.assert_allclose(np.linalg.norm(found.rotations, axis=-1), 1.0, atol=1e-15)


def test_the_file_says_what_it_is_and_in_which_version(path: Path) -> None:
    connection = sqlite3.connect(path)
    assert connection.execute("PRAGMA application_id").fetchone() == (APPLICATION_ID,)
    assert connection.execute("PRAGMA user_version").fetchone() == (FORMAT_VERSION,)
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert path.read_bytes().startswith(b"SQLite format 3\0")
    connection.close()


def test_nothing_is_left_beside_the_file(path: Path) -> None:
    open_library(path).poses("Stand")
    assert os.listdir(path.parent) == [path.name]


def test_a_missing_file_is_the_operating_systems_to_tell(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"none\.mlmg"):
        open_library(tmp_path / "none.mlmg")
    assert os.listdir(tmp_path) == []


def test_a_folder_is_the_operating_systems_to_tell(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError, match=tmp_path.name):
        open_library(tmp_path)


NO_LIBRARY = "not a readable library ({}); expected a file that `mlmg build` wrote: build it again"


@pytest.mark.parametrize("content", [b"[library]\nclips = []\n", bytes(range(256)) * 40])
def test_a_file_of_another_kind_is_told_in_one_sentence(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "library.mlmg"
    path.write_bytes(content)
    assert refusal(path) == f"{path}: {NO_LIBRARY.format('file is not a database')}"


@pytest.mark.parametrize("content", [b"[library]\nclips = []\n", b""])
def test_a_configuration_is_said_to_be_one_that_is_to_be_built_first(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "dance.toml"
    path.write_bytes(content)
    assert refusal(path) == (
        f"{path}: a configuration, not a library: build it first, by `mlmg build dance.toml -o dance.mlmg`, "
        "and name dance.mlmg here"
    )


def test_a_library_may_end_as_configurations_do(path: Path) -> None:
    assert open_library(path.rename(path.with_suffix(".toml"))).graphs


def test_another_programs_database_is_told_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "bookmarks.sqlite"
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE motion (name TEXT)")
    connection.close()
    assert refusal(path) == f"{path}: an SQLite file, but no library; expected a file that `mlmg build` wrote"


def test_an_empty_file_is_told_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "empty.mlmg"
    path.touch()
    assert refusal(path).startswith(f"{path}: ")
    assert refusal(path).endswith("expected a file that `mlmg build` wrote")


@pytest.mark.parametrize("version", [FORMAT_VERSION - 1, FORMAT_VERSION + 1])
def test_a_library_of_another_version_is_told_with_both_versions(path: Path, version: int) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute(f"PRAGMA user_version = {version}")
    connection.close()
    assert refusal(path) == (
        f"{path}: library format {version}, expected {FORMAT_VERSION}: build it again with this version"
    )


@pytest.mark.parametrize("share", [0.001, 0.02, 0.3, 0.5, 0.8, 0.99, 0.9999])
def test_a_file_cut_short_is_told_in_one_sentence(path: Path, share: float) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    message = refusal(path)
    assert message.startswith(f"{path}: not a readable library (")
    assert message.endswith("); expected a file that `mlmg build` wrote: build it again")


def test_a_damaged_file_is_told_in_one_sentence_or_does_no_harm(path: Path) -> None:
    whole = path.read_bytes()
    draw = random.Random(3)
    harmless = 0
    for _ in range(150):
        damaged = bytearray(whole)
        at = draw.randrange(100, len(whole))
        length = min(draw.choice([1, 4, 200, 4096]), len(whole) - at)
        damaged[at : at + length] = draw.randbytes(length)
        path.write_bytes(damaged)
        with suppress(LibraryError):
            use(open_library(path))
            harmless += 1
    assert harmless < 100


@pytest.mark.parametrize("table", ["property", "clip", "graph", "motion"])
def test_a_library_that_lacks_a_table_is_told_in_one_sentence(path: Path, table: str) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute(f"DROP TABLE {table}")
    connection.close()
    assert refusal(path) == f"{path}: {NO_LIBRARY.format(f'no such table: {table}')}"


def test_a_library_is_opened_without_reading_its_clips(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE clip SET rotations = x'', positions = x''")
    connection.close()
    library = open_library(path)
    assert library.n_frames("Stand") == 120
    assert library.can_reach("Full-Body", "Stand", "Reach")
    with pytest.raises(LibraryError) as caught:
        library.poses("Stand")
    assert str(caught.value) == f"{path}: {NO_LIBRARY.format('the checksum of the clip Stand differs')}"


def test_a_library_that_is_read_cannot_be_written_by_accident(path: Path) -> None:
    before = path.read_bytes()
    with pytest.raises(LibraryError, match="attempt to write a readonly database"), open_database(path) as connection:
        connection.execute("DELETE FROM clip")
    assert path.read_bytes() == before


def test_names_of_files_and_motions_may_hold_any_character(tmp_path: Path, built: BuiltLibrary) -> None:
    path = tmp_path / "a b?%20#走 '1'.mlmg"
    write_database(built, path)
    assert open_library(path).poses("Stand").n_frames == 120


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(
    path: Path, built: BuiltLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = path.read_bytes()

    def fail(*_: object) -> None:
        raise OSError("the disk is full")

    for stage in ("_write_properties", "_write_clips", "_write_graphs"):
        with monkeypatch.context() as patched:
            patched.setattr(database, stage, fail)
            with pytest.raises(OSError, match="the disk is full"):
                write_database(built, path)
        assert path.read_bytes() == before
        assert os.listdir(path.parent) == [path.name]


def test_a_full_disk_is_the_operating_systems_to_tell(
    path: Path, built: BuiltLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = path.read_bytes()
    monkeypatch.setattr(database, "_SCHEMA", f"PRAGMA max_page_count = 20; {database._SCHEMA}")
    with pytest.raises(OSError, match="No space left") as caught:
        write_database(built, path)
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(path))
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == [path.name]


KILLED = """\
import os, pickle, signal, sys
from mlmg_runtime import database
write_graphs = database._write_graphs
def killed(*arguments):
    write_graphs(*arguments)
    os.kill(os.getpid(), signal.SIGKILL)
database._write_graphs = killed
with open(sys.argv[1], "rb") as file:
    built = pickle.load(file)
from pathlib import Path
database.write_database(built, Path(sys.argv[2]))
"""


def test_a_write_that_is_killed_leaves_the_old_file(path: Path, built: BuiltLibrary, tmp_path: Path) -> None:
    import pickle

    before = path.read_bytes()
    (tmp_path / "built.pickle").write_bytes(pickle.dumps(built))
    arguments = [sys.executable, "-c", KILLED, str(tmp_path / "built.pickle"), str(path)]
    assert subprocess.run(arguments, check=False).returncode == -signal.SIGKILL
    assert path.read_bytes() == before
    use(open_library(path))


def test_written_again_a_library_replaces_the_old_one(path: Path, built: BuiltLibrary) -> None:
    from dataclasses import replace

    write_database(replace(built, start="Sway"), path)
    assert open_library(path).start == "Sway"


@pytest.mark.parametrize(
    ("library", "configuration", "is_kept"),
    [
        ("own.mlmg", "library.toml", True),
        ("own.mlmg", "clips/walks/library.toml", True),
        ("build/today/own.mlmg", "library.toml", True),
        ("build/own.mlmg", "clips/library.toml", False),
    ],
)
def test_the_way_to_the_configuration_is_kept_if_it_leads_only_down_or_up(
    built: BuiltLibrary, tmp_path: Path, library: str, configuration: str, is_kept: bool
) -> None:
    files = []
    for folder in (tmp_path / "one", tmp_path / "two" / "deeper"):
        for path in (folder / library, folder / configuration):
            path.parent.mkdir(parents=True, exist_ok=True)
        (folder / configuration).touch()
        write_database(replace(built, configuration=folder / configuration), folder / library)
        known = open_library(folder / library).configuration
        assert is_kept == (known is not None)
        assert known is None or known.samefile(folder / configuration)
        files.append((folder / library).read_bytes())
    assert files[0] == files[1]
