import numpy as np
import pytest

from mlmg_runtime.library import Library, open_library


def test_graphs_are_named_with_the_whole_body_first_and_parents_before_children(small_library: Library) -> None:
    assert small_library.graphs == ("Full-Body", "Upper-Body", "Left-Arm", "Right-Arm")
    assert small_library.root is small_library.by_name["Full-Body"]


@pytest.mark.parametrize(
    ("graph", "above"),
    [
        ("Full-Body", []),
        ("Upper-Body", ["Full-Body"]),
        ("Left-Arm", ["Upper-Body", "Full-Body"]),
        ("Right-Arm", ["Upper-Body", "Full-Body"]),
    ],
)
def test_the_graphs_above_a_graph_are_told_nearest_first(small_library: Library, graph: str, above: list[str]) -> None:
    assert small_library.ancestors(graph) == above
    assert small_library.parent(graph) == (above[0] if above else None)


def test_motions_and_tags_are_those_of_the_configuration_in_its_order(small_library: Library) -> None:
    assert list(small_library.motions("Full-Body")) == ["Stand", "Stroll", "Sway", "Reach"]
    assert list(small_library.motions("Right-Arm")) == ["Stroll", "Stand", "Wave", "Reach"]
    assert list(small_library.tags("Full-Body", "Stroll")) == ["WALK", "GO"]
    assert list(small_library.tags("Upper-Body", "Stroll")) == ["SWING"]
    assert list(small_library.tags("Upper-Body", "Wave")) == []


def test_what_can_reach_what_is_what_transitions_allow(small_library: Library) -> None:
    for name, graph in small_library.by_name.items():
        for source in graph.motions:
            for target in graph.motions:
                found = {graph.index[source]}
                for _ in graph.motions:
                    found |= {edge.dst_motion for edge in graph.edges if edge.src_motion in found}
                assert small_library.can_reach(name, source, target) == (graph.index[target] in found)


def test_a_motion_has_the_frames_of_its_clip_on_whatever_graph_it_is(small_library: Library) -> None:
    for motion, n_frames in {"Stand": 120, "Stroll": 110, "Sway": 100, "Reach": 90, "Wave": 80}.items():
        assert small_library.n_frames(motion) == small_library.poses(motion).n_frames == n_frames


def test_a_clip_is_read_once_and_cannot_be_changed(small_library: Library) -> None:
    poses = small_library.poses("Stand")
    assert small_library.poses("Stand") is poses
    for array in (poses.rotations, poses.positions):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_the_rest_is_what_was_built(small_library: Library) -> None:
    assert (small_library.start, small_library.up, small_library.frame_rate) == ("Stand", "y", 30.0)
    assert small_library.warnings == ()
    assert set(small_library.reports) == set(small_library.graphs)
    assert small_library.reports["Full-Body"]["n_transitions"] == len(small_library.root.transitions)


def test_two_openings_of_a_file_give_the_same_library(small_library: Library) -> None:
    again = open_library(str(small_library.path))
    assert again.skeleton == small_library.skeleton
    np.testing.assert_array_equal(again.root.transitions, small_library.root.transitions)
    np.testing.assert_array_equal(again.poses("Wave").rotations, small_library.poses("Wave").rotations)


def test_shown_to_a_person_a_library_says_in_one_line_what_it_is(small_library: Library) -> None:
    assert repr(small_library) == (
        f"Library(path={small_library.path!r}, frame_rate=30.0, up='y', start='Stand', warnings=())"
    )
