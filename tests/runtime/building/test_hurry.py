from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import rotations
from mlmg_runtime.blending import c1_weight, linear_weight
from mlmg_runtime.building.connect import Edges
from mlmg_runtime.building.hurry import hurry
from mlmg_runtime.point_cloud import best_fit

WINDOW = 4


def edges_of(*marks: tuple[int, int, int, int]) -> Edges:
    return Edges(*np.array(marks, dtype=np.int64).reshape(-1, 4).T, np.zeros(len(marks)))


def slow_hurry(points, weights, blend, edge: tuple[int, int, int, int]) -> float:
    """Return the longest step over the longest of the two clips: one transition, frame by frame, joint by joint."""
    a, i, b, j = edge
    first = j - WINDOW + 1
    fit = best_fit(points[a][None, i : i + WINDOW], points[b][None, first : first + WINDOW], weights)
    turn = rotations.about_axis("Y", fit.yaw_rad[0])
    shift = np.array([fit.shift[0, 0], 0.0, fit.shift[0, 1]])

    def target(frame: int) -> np.ndarray:
        return rotations.rotate(turn[None], points[b][frame]) + shift

    shown = [points[a][i - 1]] if i > 0 else []
    for p in range(WINDOW):
        weight = float(blend(np.array((p + 1) / WINDOW)))
        shown.append(weight * points[a][i + p] + (1.0 - weight) * target(first + p))
    if j + 1 < len(points[b]):
        shown.append(target(j + 1))
    largest = 0.0
    for joint in range(points[a].shape[1]):
        steps = [float(np.linalg.norm(y[joint] - x[joint])) for x, y in pairwise(shown)]
        longest = max(
            float(np.linalg.norm(clip[f + 1, joint] - clip[f, joint]))
            for clip in (points[a], points[b])
            for f in range(len(clip) - 1)
        )
        largest = max(largest, max(steps) / longest)
    return largest


@given(st.integers(0, 2**32 - 1), st.sampled_from(["c1", "linear"]))
def test_how_much_transitions_hurry_is_what_frame_by_frame_blends_say(seed: int, blend: str) -> None:
    draw = np.random.default_rng(seed)
    points = [np.cumsum(draw.normal(size=(n, 3, 3)), axis=0) for n in draw.integers(WINDOW, 12, size=3)]
    weights = draw.uniform(0.1, 2.0, size=3)
    marks = []
    for a in range(3):
        for b in range(3):
            i = int(draw.integers(0, len(points[a]) - WINDOW + 1))
            marks.append((a, i, b, int(draw.integers(WINDOW - 1, len(points[b])))))
    weight = {"c1": c1_weight, "linear": linear_weight}[blend]
    expected = [slow_hurry(points, weights, weight, mark) for mark in marks]
    found = hurry(points, weights, WINDOW, blend).of(edges_of(*marks))
    # An end of a clip is repeated where a frame is missing, which makes no step longer.
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_more_transitions_than_are_looked_at_at_once_are_told_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    draw = np.random.default_rng(1)
    points = [np.cumsum(draw.normal(size=(20, 2, 3)), axis=0) for _ in range(2)]
    marks = [(a, i, 1 - a, j) for a in (0, 1) for i in range(10) for j in range(5, 15)]
    moves = hurry(points, np.ones(2), WINDOW, "c1")
    together = moves.of(edges_of(*marks))
    monkeypatch.setattr("mlmg_runtime.building.hurry.AT_ONCE", 7)
    np.testing.assert_array_equal(moves.of(edges_of(*marks)), together)


def test_a_foot_that_stands_in_both_clips_is_hurried_by_a_blend_that_slides_it() -> None:
    body = np.cumsum(np.full((30, 1, 3), 0.5), axis=0)
    stands = np.zeros((30, 1, 3)) + 1e-3 * np.arange(30)[:, None, None]
    stance = np.array([[0.0, 0.0, 4.0]])
    points = [np.concatenate((body, stands), axis=1), np.concatenate((body, stands + stance), axis=1)]
    moves = hurry(points, np.array([1.0, 0.01]), WINDOW, "c1")
    assert moves.of(edges_of((0, 10, 1, 13)))[0] > 100
    assert moves.of(edges_of((0, 10, 0, 13)))[0] == pytest.approx(1.0)


def test_no_transitions_hurry_nothing() -> None:
    points = [np.zeros((5, 1, 3)), np.zeros((2, 1, 3))]
    assert hurry(points, np.ones(1), WINDOW, "c1").of(edges_of()).shape == (0,)


def test_steps_that_are_hardly_seen_do_not_hurry_a_foot_that_stands() -> None:
    stands = 1e-3 * np.arange(30)[:, None, None] * np.ones(3)
    clips = [stands, stands + np.array([[[0.0, 0.4, 0.0]]])]
    edge = edges_of((0, 10, 1, 13))
    assert hurry(clips, np.ones(1), WINDOW, "c1").of(edge)[0] > 50
    assert hurry(clips, np.ones(1), WINDOW, "c1", 0.3).of(edge)[0] < 1
