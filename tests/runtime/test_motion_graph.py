from bisect import bisect_left

import numpy as np
import pytest

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position, Transition, transition_cost


@pytest.fixture(params=["Full-Body", "Upper-Body", "Left-Arm", "Right-Arm"])
def graph(request: pytest.FixtureRequest, small_library: Library) -> MotionGraph:
    """Return each graph of the small library."""
    return small_library.by_name[request.param]


def test_a_transition_arrives_at_the_frame_after_its_last_blended_one() -> None:
    assert Transition(0, 31, 4, 118, 0.9, 0.2).arrival == Position(4, 119)


def test_transitions_as_plain_numbers_are_those_of_the_array(graph: MotionGraph) -> None:
    assert [tuple(edge) for edge in graph.edges] == [tuple(row) for row in graph.transitions.tolist()]
    assert all(type(edge.src_frame) is int and type(edge.cost) is float for edge in graph.edges)


@pytest.mark.parametrize("sigma", [0.003, 1.0, 7e4])
def test_a_cost_is_one_less_the_exponential_to_the_seventh_decimal(sigma: float) -> None:
    times = np.linspace(0.0, 100.0, 20001)
    costs, published = transition_cost(times * sigma, sigma), 1.0 - np.exp(-times)
    np.testing.assert_allclose(costs[times <= 16], published[times <= 16], rtol=0, atol=1e-15)
    np.testing.assert_allclose(costs, published, rtol=0, atol=1.2e-7)


@pytest.mark.parametrize("sigma", [0.003, 1.0, 7e4])
def test_of_two_bridges_the_farther_costs_more_and_none_costs_1(sigma: float) -> None:
    times = np.concatenate((np.linspace(0.0, 40.0, 4001), np.linspace(40.1, 5000.0, 50000)))
    costs = transition_cost(times * sigma, sigma)
    assert (np.diff(costs) > 0.0).all()
    assert costs[0] == 0.0
    assert transition_cost(np.array([1e6, 1e300]) * sigma, sigma).max() < 1.0


def test_motions_are_indexed_in_their_order(graph: MotionGraph) -> None:
    assert [graph.index[motion] for motion in graph.motions] == list(range(len(graph.motions)))


def test_the_transitions_of_a_motion_are_found_by_its_index(graph: MotionGraph) -> None:
    for motion in range(len(graph.motions)):
        own = graph.edges[graph.first_edge[motion] : graph.first_edge[motion + 1]]
        assert own == tuple(edge for edge in graph.edges if edge.src_motion == motion)


def test_the_next_departure_is_found_by_its_frame(graph: MotionGraph) -> None:
    for motion, frames in enumerate(graph.first_exit):
        for frame in range(int(graph.n_frames[motion])):
            later = [e.src_frame for e in graph.edges if e.src_motion == motion and e.src_frame >= frame]
            assert list(frames[bisect_left(frames, frame) :]) == later
