"""Legs that reach for somewhere else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import rotations
from mlmg_runtime.playing.reaching import reach

UPPER, LOWER = 43.0, 41.0
SEEDS = st.integers(0, 2**32 - 1)


def legs(seed, n=20, least_bent=0.2):
    """Return legs bent about x by turns anywhere: hip, knee, ankle and hinge, shape (n, 3) each."""
    random = np.random.default_rng(seed)
    turn = rotations.normalized(random.normal(size=(n, 4)))
    bent = random.uniform(least_bent, 1.8, size=n)
    hip = random.normal(scale=50.0, size=(n, 3))
    knee = hip + rotations.rotate(turn, np.array([0.0, -UPPER, 0.0]))
    shin = rotations.rotate(rotations.about_axis("X", bent), np.array([0.0, -LOWER, 0.0]))
    return hip, knee, knee + rotations.rotate(turn, shin), rotations.rotate(turn, np.array([1.0, 0.0, 0.0]))


def reached(hip, knee, ankle, goal, hinge):
    """Return where the knee and the ankle come to be."""
    swing, bend = reach(hip, knee, ankle, goal, hinge)
    new_knee = hip + rotations.rotate(swing, knee - hip)
    return new_knee, new_knee + rotations.rotate(bend, ankle - knee)


@given(seed=SEEDS)
def test_an_ankle_gets_where_it_is_to_be_and_the_bones_keep_their_lengths(seed):
    hip, knee, ankle, hinge = legs(seed)
    random = np.random.default_rng(seed + 1)
    way = (ankle - hip) / np.linalg.norm(ankle - hip, axis=-1, keepdims=True)
    goal = hip + (way + random.normal(scale=0.3, size=way.shape)) * random.uniform(0.35, 0.5) * (UPPER + LOWER)
    new_knee, new_ankle = reached(hip, knee, ankle, goal, hinge)
    np.testing.assert_allclose(np.linalg.norm(new_knee - hip, axis=-1), UPPER)
    np.testing.assert_allclose(np.linalg.norm(new_ankle - new_knee, axis=-1), LOWER)
    within = np.linalg.norm(goal - hip, axis=-1) <= np.linalg.norm(ankle - hip, axis=-1)
    np.testing.assert_allclose(new_ankle[within], goal[within], atol=1e-6)


@given(seed=SEEDS)
def test_a_leg_that_is_where_it_is_to_be_is_left_as_it_is(seed):
    hip, knee, ankle, hinge = legs(seed)
    for turn in reach(hip, knee, ankle, ankle, hinge):
        assert np.degrees(rotations.angle_between(turn, np.array([1.0, 0.0, 0.0, 0.0]))).max() < 1e-4


@given(seed=SEEDS)
def test_a_knee_stays_in_the_plane_in_which_it_is_bent(seed):
    hip, knee, ankle, hinge = legs(seed)
    goal = hip + 0.9 * (ankle - hip)
    new_knee, _ = reached(hip, knee, ankle, goal, hinge)
    np.testing.assert_allclose(np.sum((new_knee - hip) * hinge, axis=-1), 0.0, atol=1e-6)
    # It bends on, and not to the other side.
    assert np.all(np.sum(np.cross(new_knee - hip, goal - new_knee) * hinge, axis=-1) > 0.0)


def test_a_straight_leg_bends_about_its_hinge():
    hip, knee, ankle, hinge = (row[:1] for row in legs(3))
    ankle = knee + LOWER * (knee - hip) / UPPER
    goal = hip + 0.95 * (ankle - hip)
    new_knee, new_ankle = reached(hip, knee, ankle, goal, hinge)
    np.testing.assert_allclose(new_ankle, goal, atol=1e-6)
    assert np.sum(np.cross(new_knee - hip, new_ankle - new_knee) * hinge) > 0.0


def test_a_leg_stretches_smoothly_for_what_is_out_of_reach_and_never_snaps_straight():
    hip, knee, ankle, hinge = (np.repeat(row[:1], 400, axis=0) for row in legs(5))
    way = (ankle - hip) / np.linalg.norm(ankle - hip, axis=-1, keepdims=True)
    wanted = np.linspace(60.0, 100.0, 400)
    _, new_ankle = reached(hip, knee, ankle, hip + way * wanted[:, None], hinge)
    distance = np.linalg.norm(new_ankle - hip, axis=-1)
    assert distance.max() < UPPER + LOWER
    steps = np.diff(distance)
    assert np.all(steps > 0.0)
    assert np.all(np.diff(steps)[wanted[2:] > np.linalg.norm((ankle - hip)[0])] < 1e-9)
    np.testing.assert_allclose(np.cross(new_ankle - hip, way), 0.0, atol=1e-6)


@pytest.mark.parametrize("share", [0.0, 1e-9])
def test_what_is_too_near_is_reached_for_with_the_knee_as_bent_as_can_be(share):
    hip, knee, ankle, hinge = legs(7)
    _, new_ankle = reached(hip, knee, ankle, hip + share * (ankle - hip) + 1e-6, hinge)
    np.testing.assert_allclose(np.linalg.norm(new_ankle - hip, axis=-1), UPPER - LOWER)
