from collections.abc import Callable

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime.building.connect import Edges, Positions, bridges

WINDOW = 3
# Five times as far apart as smooth windows, root mean square.
USUAL_BRIDGE = 25
N_FRAMES = st.lists(st.integers(WINDOW, 12), min_size=1, max_size=4)


@st.composite
def cases(draw: st.DrawFn) -> tuple[Positions, Edges]:
    n_frames = draw(N_FRAMES)
    motions = st.integers(0, len(n_frames) - 1)
    marks = draw(st.lists(st.tuples(motions, st.integers(0, 99), motions, st.integers(0, 99)), max_size=16))
    edges = sorted(
        {(a, i % (n_frames[a] - WINDOW + 1), b, WINDOW - 1 + j % (n_frames[b] - WINDOW + 1)) for a, i, b, j in marks}
    )
    distances = draw(st.permutations(range(1, len(edges) + 1)))
    columns = np.array(edges, dtype=np.int64).reshape(-1, 4).T
    return Positions(np.array(n_frames)), Edges(*columns, np.array(distances, dtype=float))


def links(positions: Positions, edges: Edges) -> dict[tuple[int, int], set[tuple[int, int]]]:
    """Return where one can go on to from each (motion, frame)."""
    onward = {(m, f): set() for m, n in enumerate(positions.n_frames.tolist()) for f in range(n)}
    for (motion, frame), after in onward.items():
        if (motion, frame + 1) in onward:
            after.add((motion, frame + 1))
    for a, i, b, j, _ in zip(*(column.tolist() for column in edges), strict=True):
        if (b, j + 1) in onward:
            onward[a, i].add((b, j + 1))
    return onward


def slow_components(positions: Positions, edges: Edges) -> list[set[tuple[int, int]]]:
    """Return the sets of positions that can reach each other, found by walking from each."""
    onward = links(positions, edges)
    reach = {}
    for start in onward:
        found, pending = {start}, [start]
        while pending:
            for after in onward[pending.pop()] - found:
                found.add(after)
                pending.append(after)
        reach[start] = found
    return [{b for b in reach[a] if a in reach[b]} for a in onward]


def as_set(positions: Positions, component) -> set[tuple[int, int]]:
    numbered = [(m, f) for m, n in enumerate(positions.n_frames.tolist()) for f in range(n)]
    return {place for place, inside in zip(numbered, component.tolist(), strict=True) if inside}


def motions_of(positions: Positions, edges: Edges) -> set[int]:
    return {motion for motion, _ in as_set(positions, positions.component(edges))}


@given(cases())
def test_the_component_is_the_largest_set_of_positions_that_can_reach_each_other(case) -> None:
    positions, edges = case
    expected = slow_components(positions, edges)
    largest = max(map(len, expected))
    found = as_set(positions, positions.component(edges))
    if largest == 1:
        assert found == set()
    else:
        assert len(found) == largest
        assert found in expected


@given(cases())
def test_the_transitions_inside_are_those_with_both_ends_in_the_component(case) -> None:
    positions, edges = case
    component = positions.component(edges)
    inside = as_set(positions, component)
    expected = [
        (a, i) in inside and (b, j + 1) in inside
        for a, i, b, j, _ in zip(*(column.tolist() for column in edges), strict=True)
    ]
    assert positions.inside(edges, component).tolist() == expected


def none_hurries(edges: Edges) -> np.ndarray:
    return np.zeros(len(edges.distance), dtype=bool)


def those_hurry(hurrying: set[int]) -> Callable[[Edges], np.ndarray]:
    """Return what says of the transitions of some distances that they hurry; all distances differ."""
    return lambda edges: np.isin(edges.distance, list(hurrying))


def is_best_of_its_window(edges: Edges, number: int, others: np.ndarray) -> bool:
    """Return whether a transition is smoother than all of `others` near it between the same motions."""
    same = (edges.src_motion == edges.src_motion[number]) & (edges.dst_motion == edges.dst_motion[number])
    near = same & others & (np.abs(edges.src_frame - edges.src_frame[number]) < WINDOW)
    return bool(edges.distance[near].min() == edges.distance[number])


def falls_apart_without(positions: Positions, edges: Edges, kept: np.ndarray, number: int) -> bool:
    without = kept.copy()
    without[number] = False
    return not motions_of(positions, edges.where(without)) >= motions_of(positions, edges)


SIGMAS = st.sampled_from([0, 0.04, 0.1, 0.3, 1, 3, 5, 9, 17])


@settings(max_examples=4 * settings().max_examples)
@given(cases(), SIGMAS, st.sets(st.integers(1, 16)))
def test_bridges_join_all_motions_that_can_be_joined_and_keep_every_smooth_transition(case, sigma, hurrying) -> None:
    positions, edges = case
    kept = bridges(positions, edges, sigma, WINDOW, those_hurry(hurrying))
    assert kept[edges.distance <= sigma].all()
    assert motions_of(positions, edges.where(kept)) >= motions_of(positions, edges)


@settings(max_examples=4 * settings().max_examples)
@given(cases(), SIGMAS)
def test_no_bridge_is_dearer_than_usual_unless_the_motions_need_so_dear_a_one(case, sigma) -> None:
    positions, edges = case
    kept = bridges(positions, edges, sigma, WINDOW, none_hurries)
    dear = edges.distance[kept & (edges.distance > sigma)]
    if len(dear) and dear.max() > USUAL_BRIDGE * sigma:
        cheaper = kept & (edges.distance < dear.max())
        assert not motions_of(positions, edges.where(cheaper)) >= motions_of(positions, edges)


@settings(max_examples=4 * settings().max_examples)
@given(cases(), SIGMAS)
def test_motions_with_a_usual_bridge_have_no_dearer_one_unless_all_fall_apart_without_it(case, sigma) -> None:
    positions, edges = case
    kept = bridges(positions, edges, sigma, WINDOW, none_hurries)
    usual = edges.distance <= USUAL_BRIDGE * sigma
    for number in np.flatnonzero(kept & ~usual):
        same = (edges.src_motion == edges.src_motion[number]) & (edges.dst_motion == edges.dst_motion[number])
        if (same & kept & usual).any():
            assert falls_apart_without(positions, edges, kept, number)


def best_of_windows(edges: Edges, out: np.ndarray) -> np.ndarray:
    """Return the transitions that are left when each in turn, best first, rules out those near it."""
    best = np.zeros(len(edges.distance), dtype=bool)
    for number in np.argsort(edges.distance):
        others = best.copy()
        others[number] = True
        best[number] = not out[number] and is_best_of_its_window(edges, number, others)
    return best


@settings(max_examples=4 * settings().max_examples)
@given(cases(), SIGMAS, st.sets(st.integers(1, 16)))
def test_bridges_are_the_calm_best_of_their_windows_if_these_join_all_motions(case, sigma, hurrying) -> None:
    positions, edges = case
    kept = bridges(positions, edges, sigma, WINDOW, those_hurry(hurrying))
    best = best_of_windows(edges, those_hurry(hurrying)(edges))
    smooth = edges.distance <= sigma
    if motions_of(positions, edges.where(smooth | best)) >= motions_of(positions, edges):
        assert not (kept & ~smooth & ~best).any()


def test_nothing_is_bridged_where_smooth_transitions_join_all_motions() -> None:
    positions = Positions(np.array([10, 10]))
    edges = Edges(*np.array([[0, 5, 1, 3], [1, 5, 0, 3], [0, 6, 1, 4]]).T, np.array([1.0, 2.0, 9.0]))
    assert bridges(positions, edges, 2.0, WINDOW, none_hurries).tolist() == [True, True, False]
    assert bridges(positions, edges, 1.0, WINDOW, none_hurries).tolist() == [True, True, False]


def test_a_library_without_transitions_has_no_component() -> None:
    positions = Positions(np.array([4, 5]))
    nothing = Edges(*np.empty((4, 0), dtype=np.int64), np.empty(0))
    assert not positions.component(nothing).any()
    assert bridges(positions, nothing, 1.0, WINDOW, none_hurries).shape == (0,)
