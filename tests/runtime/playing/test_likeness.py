import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime.library import Library
from mlmg_runtime.playing.likeness import AT_ONCE, Likeness
from mlmg_runtime.point_cloud import point_cloud, window_distances
from mlmg_runtime.skeleton import world_positions

FRAMES = st.integers(0, 130)


@settings(max_examples=4 * settings().max_examples)
@given(
    name=st.sampled_from(["Full-Body", "Upper-Body", "Left-Arm"]),
    motion=st.sampled_from(["Stand", "Reach"]),
    first=FRAMES,
    last=st.none() | FRAMES,
    before=st.none() | FRAMES,
)
def test_of_all_pairs_of_windows_that_are_asked_for_none_is_more_alike(
    small_library: Library, name: str, motion: str, first: int, last: int | None, before: int | None
) -> None:
    graph = small_library.by_name[name]
    points = world_positions(small_library.skeleton, small_library.poses(motion))[:, list(graph.joints)]
    cloud = point_cloud(points, graph.weights, graph.window)
    distances = window_distances(cloud, cloud)
    pairs = [
        (distances[late, early], late, early)
        for late in range(first, cloud.n_windows if last is None else min(last + 1, cloud.n_windows))
        for early in range(late - graph.window + 1)
        if before is None or early + graph.window <= before
    ]
    found = Likeness(small_library).most_alike(graph, motion, first, last, before)
    assert (found is None) == (not pairs)
    if found is not None:
        distance, leave, enter = min(pairs)
        assert found.distance == pytest.approx(distance)
        assert (found.leave, found.enter) == (leave, enter)


def test_what_has_been_worked_out_is_not_worked_out_again(small_library: Library, monkeypatch) -> None:
    graph = small_library.root
    assert graph.n_frames[0] > AT_ONCE
    likeness = Likeness(small_library)
    before = likeness.most_alike(graph, "Stand", 0)
    monkeypatch.setattr("mlmg_runtime.playing.likeness.window_distances", None)
    assert likeness.most_alike(graph, "Stand", 0) == before
    assert likeness.most_alike(graph, "Stand", 20, 50) is not None
