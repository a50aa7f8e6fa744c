"""The names of a library, read without numpy, are those of the library."""

import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.database import write_database
from mlmg_runtime.errors import LibraryError
from mlmg_runtime.library import open_library
from mlmg_runtime.library_names import GraphNames, LibraryNames, open_names


def test_the_names_are_those_of_the_library(demo_library):
    names = open_names(demo_library.path)
    assert (names.start, names.frame_rate, names.path) == (
        demo_library.start,
        demo_library.frame_rate,
        demo_library.path,
    )
    assert names.graphs == demo_library.graphs
    for graph in names.graphs:
        assert names.parent(graph) == demo_library.parent(graph)
        assert names.motions(graph) == demo_library.motions(graph)
        for motion in names.motions(graph):
            assert names.tags(graph, motion) == demo_library.tags(graph, motion)
            assert names.n_frames(motion) == demo_library.n_frames(motion)


def test_what_reaches_and_what_is_unlike_what_is_as_in_the_library(demo_library):
    names = open_names(demo_library.path)
    for graph in names.graphs:
        for pair in product(names.motions(graph), repeat=2):
            assert names.can_reach(graph, *pair) == demo_library.can_reach(graph, *pair)
            assert not names.is_forbidden(graph, *pair)
            assert names.unlikeness(graph, *pair) == pytest.approx(demo_library.unlikeness(graph, *pair), rel=1e-12)


def test_a_motion_that_no_walk_leads_to_cannot_be_reached():
    graph = GraphNames(
        None, {"Step": (), "Wave": ()}, hops=(0, -1, 1, 0), oms=(1.0, 3.0, 5.0, 1.0), usual_oms=4.0, forbidden=bytes(4)
    )
    names = LibraryNames(Path("a.mlmg"), "Step", 30.0, {"Full-Body": graph}, {"Step": 9, "Wave": 9})
    assert not names.can_reach("Full-Body", "Step", "Wave")
    assert names.can_reach("Full-Body", "Wave", "Step")
    assert names.unlikeness("Full-Body", "Step", "Wave") == 3.0 / 4.0


def test_what_is_forbidden_is_as_in_the_library(small_folder, small_configuration):
    rule = '[[transitions]]\nforbid = [["Stand", "Stroll"], ["Sway", "Sway"]]\n'
    (small_folder / "forbids.toml").write_text(small_configuration + rule, encoding="utf-8")
    built = build_library(read_configuration(small_folder / "forbids.toml"), None, lambda *_: None)
    write_database(built, small_folder / "forbids.mlmg")
    names, library = open_names(small_folder / "forbids.mlmg"), open_library(small_folder / "forbids.mlmg")
    for graph in names.graphs:
        pairs = list(product(names.motions(graph), repeat=2))
        found = {pair for pair in pairs if names.is_forbidden(graph, *pair)}
        said = {
            "Full-Body": {("Stand", "Stroll"), ("Sway", "Sway"), ("Reach", "Reach")},
            "Upper-Body": {("Reach", "Reach"), ("Reach", "Stand"), ("Reach", "Wave")},
        }
        assert found == said.get(graph, set())
        assert found == {pair for pair in pairs if library.is_forbidden(graph, *pair)}


def test_a_graph_of_one_motion_has_nothing_usual():
    graph = GraphNames(None, {"Step": ()}, hops=(0,), oms=(7.0,), usual_oms=0.0, forbidden=bytes(1))
    assert LibraryNames(Path("a.mlmg"), "Step", 30.0, {"Full-Body": graph}, {}).unlikeness(
        "Full-Body", "Step", "Step"
    ) == pytest.approx(0.0)


def test_they_are_read_without_numpy(demo_library):
    program = (
        "import sys; from mlmg_runtime.library_names import open_names; "
        "names = open_names(sys.argv[1]); names.unlikeness(names.graphs[0], *names.motions(names.graphs[0])[:2]); "
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program, str(demo_library.path)], check=False).returncode == 0


def test_a_file_that_is_no_library_is_told_as_ever(tmp_path):
    (tmp_path / "not.mlmg").write_text("nothing")
    with pytest.raises(LibraryError, match=r"not\.mlmg"):
        open_names(tmp_path / "not.mlmg")
