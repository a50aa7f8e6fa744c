"""When feet go over: made-up steps, and the cost summed slowly."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.blending import c1_weight
from mlmg_runtime.playing.foot_weights import FootPath, foot_weights

K = 20
BODY = c1_weight(np.arange(K + 1) / K)
FAR = np.array([8.0])


def path(planted, away, stride=60.0):
    """Return a foot that stands where `planted` and swings where not, and is `away` from where it might be."""
    swings = ~np.asarray(planted)
    along = np.cumsum(swings) / max(swings.sum(), 1) * stride
    run = np.cumsum(swings) / max(swings.sum(), 1)
    height = np.where(swings, 10.0 * np.sin(np.pi * run), 0.0)
    places = np.stack((along, height, np.full(K + 1, float(away))), axis=-1)
    return FootPath(places[None], np.asarray(planted)[None])


def frames(*runs):
    """Return K + 1 booleans from (value, how many) runs."""
    return np.concatenate([np.full(n, value) for value, n in runs])


def weights(left, entered):
    weight, dragged = foot_weights(left, entered, BODY, FAR)
    return weight[0], float(dragged[0])


def test_a_foot_goes_over_in_the_air_and_stands_as_still_as_in_the_motions():
    steps = frames((True, 6), (False, 10), (True, 5))
    weight, dragged = weights(path(steps, 0.0), path(steps, 5.0))
    assert np.all(weight[:5] > 0.98)
    assert np.all(weight[15:] < 0.02)
    assert dragged < 0.2


def test_a_foot_that_stands_all_the_time_goes_over_as_slowly_as_it_can():
    stands = frames((True, K + 1))
    weight, dragged = weights(path(stands, 0.0), path(stands, 5.0))
    assert np.max(-np.diff(np.concatenate(([1.0], weight)))) <= 1.34 / K
    assert dragged == pytest.approx(5.0)


def test_a_foot_takes_off_with_a_step_of_the_motion_that_is_entered():
    weight, dragged = weights(
        path(frames((True, K + 1)), 0.0), path(frames((True, 4), (False, 8), (True, 9)), 4.0, 6.0)
    )
    assert np.all(weight[12:] < 0.02)
    assert dragged < 4.1


def test_the_weight_falls_from_one_to_none_and_ends_there():
    for seed in range(50):
        random = np.random.default_rng(seed)
        left, entered = (path(np.repeat(random.random(7) < 0.5, 3), random.normal(scale=9.0)) for _ in range(2))
        weight, _ = weights(left, entered)
        assert np.all(np.diff(np.concatenate(([1.0], weight))) <= 1e-12)
        assert weight[-1] == 0.0


@given(scale=st.floats(1e-3, 1e3), seed=st.integers(0, 2**32 - 1))
def test_when_a_foot_goes_over_does_not_depend_on_the_unit(scale, seed):
    random = np.random.default_rng(seed)
    ways = [path(np.repeat(random.random(7) < 0.5, 3), random.normal(scale=9.0)) for _ in range(2)]
    scaled = [FootPath(scale * way.places, way.planted) for way in ways]
    expected = foot_weights(ways[0], ways[1], BODY, FAR)
    found = foot_weights(scaled[0], scaled[1], BODY, scale * FAR)
    np.testing.assert_array_equal(found[0], expected[0])
    np.testing.assert_allclose(found[1], scale * expected[1], rtol=1e-9, atol=1e-9)


def slow_cost(left, entered, weight):
    """Return what one way of going over costs, frame by frame."""
    w = [1.0, *weight]
    a, b = left.places[0], entered.places[0]
    far = FAR[0]
    cost = 0.0
    for p in range(1, K + 1):
        step = (w[p] * a[p] + (1 - w[p]) * b[p]) - (w[p - 1] * a[p - 1] + (1 - w[p - 1]) * b[p - 1])
        share = (w[p] + w[p - 1]) / 2
        on_ground = share * left.stands[0, p - 1] + (1 - share) * entered.stands[0, p - 1]
        speed = K * (w[p] - w[p - 1]) * (np.linalg.norm(a[p] - b[p]) + np.linalg.norm(a[p - 1] - b[p - 1])) / 2
        astray = (w[p] - BODY[p]) * np.linalg.norm(a[p] - b[p])
        cost += on_ground * np.hypot(step[0], step[2]) + (0.3 * speed**2 / far + 6.0 * astray**4 / far**3) / K
    return cost


def falls():
    """Yield every way of going over between two frames at the body's pace: speed up, hold, slow down."""
    speed = np.clip(np.minimum(np.linspace(0, 1, 40001), np.linspace(1, 0, 40001)) / 0.25, 0.0, 1.0)
    fallen = np.cumsum(speed) / speed.sum()
    for begin, end in combinations(range(K + 1), 2):
        share = np.clip((np.arange(1, K + 1) - begin) / (end - begin), 0.0, 1.0)
        yield 1.0 - np.interp(share, np.linspace(0, 1, 40001), fallen)


FALLS = tuple(falls())


@given(seed=st.integers(0, 2**32 - 1))
def test_no_other_time_to_go_over_costs_less(seed):
    random = np.random.default_rng(seed)
    left, entered = (path(np.repeat(random.random(7) < 0.5, 3), random.normal(scale=9.0)) for _ in range(2))
    found = slow_cost(left, entered, weights(left, entered)[0])
    assert all(found <= slow_cost(left, entered, weight) * (1.0 + 1e-3) + 1e-6 for weight in FALLS)


def test_many_transitions_at_once_are_as_each_alone():
    random = np.random.default_rng(2)
    pairs = [
        [path(np.repeat(random.random(7) < 0.5, 3), random.normal(scale=9.0)) for _ in range(2)] for _ in range(30)
    ]
    left, entered = (
        FootPath(
            np.concatenate([pair[i].places for pair in pairs]), np.concatenate([pair[i].planted for pair in pairs])
        )
        for i in range(2)
    )
    together, _ = foot_weights(left, entered, BODY, np.repeat(FAR, 30))
    for pair, weight in zip(pairs, together, strict=True):
        np.testing.assert_array_equal(weights(*pair)[0], weight)
