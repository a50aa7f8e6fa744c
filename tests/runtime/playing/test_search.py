import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.search import find_path, find_paths

SMALL_GRAPHS = ["Full-Body", "Upper-Body", "Left-Arm", "Right-Arm"]


def check(graph, start, targets, allowed, soonest) -> None:
    """Check that the path found is one, and none is better."""
    expected = soonest(graph, start, targets, allowed)
    path = find_path(graph, start, targets, allowed)
    assert (path is None) == (expected is None)
    if path is None:
        return
    position, n_frames = start, 0
    for edge in path.transitions:
        assert edge in graph.edges
        assert edge.src_motion == position.motion
        assert edge.src_frame >= position.frame
        n_frames += edge.src_frame - position.frame + graph.window
        position = edge.arrival
        assert edge is path.transitions[-1] or allowed is None or position.motion in allowed
    assert (path.n_frames, path.arrival) == (n_frames, position)
    assert path.cost == pytest.approx(sum(edge.cost for edge in path.transitions))
    found = path.n_frames, pytest.approx(path.cost), targets.index(path.arrival.motion)
    assert (expected.n_frames, expected.cost, expected.target) == found


@settings(max_examples=4 * settings().max_examples)
@given(data=st.data())
def test_no_walk_over_all_frames_is_sooner_or_as_soon_and_cheaper(data, motion_graphs, soonest) -> None:
    graph = data.draw(motion_graphs(longest=14))
    motions = st.integers(0, len(graph.motions) - 1)
    motion = data.draw(motions)
    start = Position(motion, data.draw(st.integers(0, int(graph.n_frames[motion]))))
    targets = data.draw(st.lists(motions, min_size=1, unique=True))
    allowed = data.draw(st.none() | st.sets(motions))
    check(graph, start, targets, allowed, soonest)


@pytest.mark.parametrize("name", SMALL_GRAPHS)
def test_from_200_random_frames_of_a_library_the_path_is_as_short_as_any(
    name: str, small_library: Library, soonest
) -> None:
    graph = small_library.by_name[name]
    draw = random.Random(name)
    for _ in range(200 // len(SMALL_GRAPHS)):
        motion = draw.randrange(len(graph.motions))
        start = Position(motion, draw.randrange(int(graph.n_frames[motion])))
        targets = draw.sample(range(len(graph.motions)), draw.randint(1, 2))
        check(graph, start, targets, None, soonest)


@pytest.mark.mocap
def test_from_200_random_frames_of_real_clips_the_path_is_as_short_as_any(reference_library: Library, soonest) -> None:
    draw = random.Random(1)
    for _ in range(200):
        graph = reference_library.by_name[draw.choice(["Full-Body", "Upper-Body"])]
        motion = draw.randrange(len(graph.motions))
        start = Position(motion, draw.randrange(int(graph.n_frames[motion])))
        check(graph, start, [draw.randrange(len(graph.motions))], None, soonest)


def test_a_motion_that_plays_already_is_reached_by_a_transition_into_itself(motion_graph) -> None:
    graph = motion_graph([20, 20], 3, [(0, 5, 0, 14), (0, 4, 1, 8)])
    path = find_path(graph, Position(0, 2), [0])
    assert [edge.src_frame for edge in path.transitions] == [5]
    assert path.n_frames == 6
    assert path.arrival == Position(0, 15)


def test_of_equally_soon_targets_the_one_with_the_smoothest_transitions_is_taken(motion_graph) -> None:
    graph = motion_graph([20, 20, 20], 3, [(0, 5, 1, 8, 0.5), (0, 5, 2, 8, 0.4)])
    assert find_path(graph, Position(0, 0), [1, 2]).arrival.motion == 2


def test_of_equally_soon_and_smooth_targets_the_first_is_taken(motion_graph) -> None:
    graph = motion_graph([20, 20, 20], 3, [(0, 5, 1, 8, 0.5), (0, 5, 2, 8, 0.5)])
    assert find_path(graph, Position(0, 0), [1, 2]).arrival.motion == 1
    assert find_path(graph, Position(0, 0), [2, 1]).arrival.motion == 2


def test_two_short_hops_are_taken_rather_than_one_that_takes_longer(motion_graph) -> None:
    graph = motion_graph([30, 30, 30], 3, [(0, 4, 1, 8, 0.9), (1, 10, 2, 8, 0.9), (0, 20, 2, 9, 0.1)])
    path = find_path(graph, Position(0, 0), [2])
    assert [edge.src_frame for edge in path.transitions] == [4, 10]
    assert path.n_frames == 4 + 3 + 1 + 3


def test_where_no_walk_leads_there_is_no_path(motion_graph) -> None:
    graph = motion_graph([20, 20], 3, [(0, 5, 1, 8)])
    assert find_path(graph, Position(0, 6), [1]) is None
    assert find_path(graph, Position(1, 0), [0]) is None
    assert find_path(graph, Position(0, 20), [1]) is None


def test_a_path_enters_no_motion_that_is_not_allowed_but_its_targets(motion_graph) -> None:
    graph = motion_graph([30, 30, 30], 3, [(0, 4, 1, 8), (1, 10, 2, 8), (0, 20, 2, 9)])
    assert find_path(graph, Position(0, 0), [2], allowed={0}).n_frames == 23
    assert find_path(graph, Position(0, 0), [2], allowed={1}).n_frames == 11


@settings(max_examples=4 * settings().max_examples)
@given(data=st.data())
def test_all_paths_are_the_soonest_to_each_transition_into_a_target_in_order(data, motion_graphs, soonest) -> None:
    graph = data.draw(motion_graphs(longest=14))
    motions = st.integers(0, len(graph.motions) - 1)
    start, home = Position(data.draw(motions), 0), data.draw(motions)
    paths = list(find_paths(graph, start, [home]))
    assert [path.n_frames for path in paths] == sorted(path.n_frames for path in paths)
    frames = frames_to(graph, start)
    expected = [(edge, frames.get(Position(*edge[:2]))) for edge in graph.edges if edge.dst_motion == home]
    found = {path.transitions[-1]: path.n_frames for path in paths}
    assert found == {edge: n_frames + graph.window for edge, n_frames in expected if n_frames is not None}


def frames_to(graph: MotionGraph, start: Position) -> dict[Position, int]:
    """Return the fewest frames to each position, by letting every one reach others until none is reached sooner."""
    reached, ahead = {start: 0}, [start]
    while ahead:
        at = ahead.pop()
        onward = [(edge.arrival, graph.window) for edge in graph.edges if edge[:2] == at]
        if at.frame + 1 < graph.n_frames[at.motion]:
            onward.append((Position(at.motion, at.frame + 1), 1))
        for place, n_frames in onward:
            if place not in reached or reached[at] + n_frames < reached[place]:
                reached[place] = reached[at] + n_frames
                ahead.append(place)
    return reached
