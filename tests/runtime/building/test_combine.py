from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.building.combine import graph_joints, graph_parents, overall_motion_similarity
from mlmg_runtime.building.configuration import GraphConfiguration, LibraryConfiguration, Threshold
from mlmg_runtime.bvh import Joint
from mlmg_runtime.errors import ConfigurationError
from mlmg_runtime.skeleton import Skeleton

TREE = {"Reference": -1, "Hips": 0, "Spine": 1, "ArmL": 2, "HandL": 3, "ArmR": 2, "HandR": 5, "Leg": 1}
POSITIONS = ("Xposition", "Yposition", "Zposition")


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    """Return a body that a standing root carries: the root is no part of it."""
    return Skeleton(
        tuple(
            Joint(name, parent, (0.0, 1.0, 0.0), POSITIONS if name == "Hips" else ()) for name, parent in TREE.items()
        )
    )


def graph(name: str, joints=None, without=(), weights=None, line: int = 7) -> GraphConfiguration:
    settings = {"window": 4, "threshold": Threshold("auto"), "metric": "point-cloud", "blend": "c1"}
    return GraphConfiguration(name, line, joints, tuple(without), weights=weights or {}, motions={"A": ()}, **settings)


def configured(*graphs: GraphConfiguration) -> LibraryConfiguration:
    return LibraryConfiguration(Path("library.toml"), (), 30.0, "y", None, graphs)


def joints_of(skeleton: Skeleton, one: GraphConfiguration) -> set[str]:
    return {skeleton.names[joint] for joint in graph_joints(configured(one), one, skeleton)}


def parents_of(skeleton: Skeleton, *graphs: GraphConfiguration) -> tuple[int | None, ...]:
    configuration = configured(*graphs)
    joints = [graph_joints(configuration, one, skeleton) for one in graphs]
    return graph_parents(configuration, joints, skeleton)


def slow_oms(distances: FloatArray, block: int) -> float:
    total, n_blocks = 0.0, 0
    for top in range(0, distances.shape[0], block):
        for left in range(0, distances.shape[1], block):
            least = np.inf
            for i in range(top, min(top + block, distances.shape[0])):
                for j in range(left, min(left + block, distances.shape[1])):
                    least = min(least, distances[i, j])
            total += least
            n_blocks += 1
    return total / n_blocks


@given(st.integers(1, 50), st.integers(1, 50), st.integers(1, 25), st.integers(0, 10**6))
def test_the_similarity_of_motions_is_the_mean_of_the_least_distance_of_each_block(
    rows: int, columns: int, block: int, seed: int
) -> None:
    distances = np.random.default_rng(seed).uniform(0.0, 100.0, size=(rows, columns))
    similarity = overall_motion_similarity(distances, block)
    assert similarity == pytest.approx(slow_oms(distances, block), rel=1e-12)
    assert overall_motion_similarity(distances.T, block) == pytest.approx(similarity, rel=1e-12)


def test_blocks_are_of_20_windows() -> None:
    distances = np.random.default_rng(1).uniform(size=(45, 61))
    assert overall_motion_similarity(distances) == pytest.approx(slow_oms(distances, 20))


def test_a_motion_without_a_window_is_like_no_other() -> None:
    assert overall_motion_similarity(np.empty((0, 8))) == np.inf


def test_a_graph_without_joints_holds_all_that_moves(skeleton: Skeleton) -> None:
    assert joints_of(skeleton, graph("All")) == set(TREE) - {"Reference"}


def test_a_graph_holds_the_subtrees_of_its_joints_less_those_it_is_without(skeleton: Skeleton) -> None:
    assert joints_of(skeleton, graph("Upper", ["Spine"])) == {"Spine", "ArmL", "HandL", "ArmR", "HandR"}
    assert joints_of(skeleton, graph("Ends", ["ArmL", "Leg"])) == {"ArmL", "HandL", "Leg"}
    assert joints_of(skeleton, graph("Trunk", ["Spine"], without=["ArmL", "HandR"])) == {"Spine", "ArmR"}
    assert joints_of(skeleton, graph("Lower", without=["Spine"])) == {"Hips", "Leg"}


def test_a_joint_that_is_not_there_is_told_with_the_line_of_its_name(skeleton: Skeleton) -> None:
    graphs = (graph("All"), graph("Upper", ["Spine"], without=["arml"], weights={"Spin": 2.0}))
    lines = {("graph", 1): 7, ("graph", 1, "without"): 9, ("graph", 1, "weights"): 10}
    wrong = replace(configured(*graphs), lines=lines)
    with pytest.raises(ConfigurationError, match=r"toml:9: .* `arml` .* did you mean `ArmL`\?"):
        graph_joints(wrong, graphs[1], skeleton)
    right = replace(graphs[1], without=())
    with pytest.raises(ConfigurationError, match=r"toml:10: .* `Spin` .* did you mean `Spine`\?"):
        graph_joints(replace(wrong, graphs=(graphs[0], right)), right, skeleton)
    lines[("graph", 1, "weights", "Spin")] = 11
    with pytest.raises(ConfigurationError, match=r"toml:11: "):
        graph_joints(replace(wrong, graphs=(graphs[0], right), lines=lines), right, skeleton)


def test_graphs_form_a_tree_by_their_joints(skeleton: Skeleton) -> None:
    graphs = (graph("All"), graph("Upper", ["Spine"]), graph("L", ["ArmL"]), graph("R", ["HandR"]))
    assert parents_of(skeleton, *graphs) == (None, 0, 1, 1)
    assert parents_of(skeleton, *graphs[::-1]) == (2, 2, 3, None)


ROWS = [
    (
        [graph("All"), graph("Upper", ["Sipne"])],
        "library.toml:7: the graph `Upper` names a joint `Sipne` that the skeleton has not; did you mean `Spine`?",
    ),
    (
        [graph("All"), graph("Upper", ["spine"])],
        "library.toml:7: the graph `Upper` names a joint `spine` that the skeleton has not; did you mean `Spine`?",
    ),
    (
        [graph("All", weights={"Fin": 1.0})],
        "library.toml:7: the graph `All` names a joint `Fin` that the skeleton has not; "
        "it has Reference, Hips, Spine, ArmL, HandL, ArmR, HandR, Leg",
    ),
    (
        [graph("All"), graph("Upper", ["Spine"], without=["Spine"])],
        "library.toml:7: no joint is left for the graph `Upper`",
    ),
    (
        [graph("All"), graph("Leg", ["Leg"], weights={"Leg": 0.0})],
        "library.toml:7: no joint is left for the graph `Leg`",
    ),
    (
        [graph("All"), graph("L", ["ArmL", "ArmR"]), graph("R", ["ArmR", "Leg"], line=9)],
        "library.toml:9: `L` and `R` share ArmR, HandR; one of two graphs must hold all joints of the other "
        "and more, or they must share none",
    ),
    (
        [graph("All"), graph("L", ["ArmL"]), graph("Left", ["ArmL"], line=9)],
        "library.toml:9: `L` and `Left` share ArmL, HandL; one of two graphs must hold all joints of the "
        "other and more, or they must share none",
    ),
    (
        [graph("All"), graph("Lower", ["Hips"], without=["Spine"], line=9)],
        "library.toml:9: `Lower` holds Hips, which carries the whole body and cannot move on its own; name joints "
        "below it",
    ),
    (
        [graph("Upper", ["Spine"]), graph("Leg", ["Leg"], line=9)],
        "library.toml:7: no graph holds the whole body; leave `joints` out of one",
    ),
]


@pytest.mark.parametrize(("graphs", "message"), ROWS)
def test_joints_that_make_no_tree_of_graphs_are_told_with_their_line(
    skeleton: Skeleton, graphs: list[GraphConfiguration], message: str
) -> None:
    with pytest.raises(ConfigurationError) as caught:
        parents_of(skeleton, *graphs)
    assert str(caught.value) == message
