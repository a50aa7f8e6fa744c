import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.building.candidates import find_candidates

matrices = hnp.arrays(
    np.float64, st.tuples(st.integers(0, 9), st.integers(0, 9)), elements=st.integers(0, 4).map(float)
)


def slow_minima(distances: FloatArray) -> set[tuple[int, int]]:
    """Return the entries that no neighbour undercuts; of equal neighbours, the one with the smaller indices."""
    found = set()
    rows, columns = distances.shape
    for i in range(rows):
        for j in range(columns):
            around = [(i + di, j + dj) for di in (-1, 0, 1) for dj in (-1, 0, 1) if (di, dj) != (0, 0)]
            near = [(r, c) for r, c in around if 0 <= r < rows and 0 <= c < columns]
            if all((distances[i, j], i, j) < (distances[r, c], r, c) for r, c in near):
                found.add((i, j))
    return found


@given(matrices)
def test_candidates_are_the_local_minima_of_the_matrix(distances: FloatArray) -> None:
    found = find_candidates(distances, within_motion=False, window=3)
    assert list(zip(found.i.tolist(), found.b.tolist(), strict=True)) == sorted(slow_minima(distances))
    assert found.distance.tolist() == distances[found.i, found.b].tolist()


@given(st.integers(0, 12), st.integers(1, 4), st.integers(0, 10**6))
def test_within_a_motion_only_windows_that_share_no_frame_are_candidates_each_pair_once(
    size: int, window: int, seed: int
) -> None:
    half = np.random.default_rng(seed).integers(0, 5, size=(size, size)).astype(float)
    distances = half + half.T
    found = find_candidates(distances, within_motion=True, window=window)
    expected = sorted((i, j) for i, j in slow_minima(distances) if j - i >= window)
    assert list(zip(found.i.tolist(), found.b.tolist(), strict=True)) == expected


def test_the_ends_of_clips_can_be_candidates() -> None:
    distances = np.array([[0.0, 2.0, 2.0], [2.0, 3.0, 2.0], [2.0, 2.0, 1.0]])
    found = find_candidates(distances, within_motion=False, window=2)
    assert (found.i.tolist(), found.b.tolist()) == ([0, 2], [0, 2])


@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (5, 0)])
def test_a_clip_without_a_window_has_no_candidate(shape: tuple[int, int]) -> None:
    found = find_candidates(np.empty(shape), within_motion=False, window=2)
    assert [len(column) for column in found] == [0, 0, 0]
