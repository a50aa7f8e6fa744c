"""Plants found in made-up steps and in whole clips."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.feet import find_plants
from mlmg_runtime.legs import Leg, find_legs
from mlmg_runtime.skeleton import world_positions

LEG = Leg(hip=0, knee=1, ankle=2, toes=3)
RATE = 30.0


def steps(n_stand=20, n_swing=12, n_steps=3, stride=120.0):
    """Return a leg of 85 cm that stands and swings in turn, shape (n, 4, 3), and when it stands."""
    swing = (np.arange(n_swing) + 1.0) / (n_swing + 1.0)
    along, height, stands = [], [], []
    for number in range(n_steps):
        along += [stride * number] * n_stand + (stride * (number + swing)).tolist()
        height += [0.0] * n_stand + (12.0 * np.sin(np.pi * swing)).tolist()
        stands += [True] * n_stand + [False] * n_swing
    points = np.zeros((len(along), 4, 3))
    points[:, :, 2] = np.array(along)[:, None] + (0.0, 0.0, 0.0, 12.0)
    points[:, :, 1] = np.array(height)[:, None] + (93.0, 50.0, 8.0, 2.0)
    return points, np.array(stands)


def test_a_foot_is_planted_while_it_stands():
    points, stands = steps()
    planted = find_plants(points, [LEG], RATE)[:, 0]
    assert not planted[~stands][2:-2].all()
    # The frames beside a swing are already half in it.
    assert planted[stands].mean() > 0.9
    assert planted[~stands].mean() < 0.2


@given(scale=st.floats(1e-3, 1e3), rise=st.floats(-5.0, 5.0), turn=st.floats(-4.0, 4.0))
def test_plants_depend_neither_on_the_unit_nor_on_where_the_floor_is_nor_on_the_heading(scale, rise, turn):
    points, _ = steps()
    c, s = np.cos(turn), np.sin(turn)
    moved = scale * (points @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) + (3.0, rise, -8.0))
    np.testing.assert_array_equal(find_plants(moved, [LEG], RATE), find_plants(points, [LEG], RATE))


def test_a_foot_that_stands_on_its_toes_or_on_its_heel_is_planted():
    for joint in (LEG.ankle, LEG.toes):
        points, stands = steps()
        tapping = 4.0 * np.sin(np.arange(len(points)))
        points[stands, joint, 2] += tapping[stands]
        assert find_plants(points, [LEG], RATE)[stands, 0].mean() > 0.9


def test_a_foot_that_is_held_still_in_the_air_is_not_planted():
    points, stands = steps()
    other = points.copy()
    other[:, 2:, 1] += 20.0
    legs = [LEG, Leg(4, 5, 6, 7)]
    planted = find_plants(np.concatenate((points, other), axis=1), legs, RATE)
    assert planted[stands, 0].mean() > 0.9
    assert not planted[:, 1].any()


def test_a_foot_that_slides_along_the_floor_is_not_planted():
    points, _ = steps(n_steps=1, n_swing=1, n_stand=40)
    points[:, :, 0] += 2.0 * np.arange(len(points))[:, None]
    assert not find_plants(points, [LEG], RATE).any()


def test_a_plant_is_not_torn_by_a_frame_and_a_frame_makes_no_plant():
    points, stands = steps(n_swing=20)
    points[8, 2:, 1] += 15.0
    at = int(np.flatnonzero(~stands)[9])
    points[at : at + 2, 2:] = points[at, 2:] * (1.0, 0.0, 1.0) + (0.0, 2.0, 0.0)
    planted = find_plants(points, [LEG], RATE)[:, 0]
    assert planted[5:12].all()
    assert not planted[at - 2 : at + 3].any()


@pytest.mark.parametrize("n_frames", [0, 1, 2])
def test_short_clips_have_plants_too(n_frames):
    points, _ = steps()
    assert find_plants(points[:n_frames], [LEG], RATE).tolist() == [[True]] * n_frames


def share_planted(library, motion):
    poses = library.poses(motion)
    legs = find_legs(library.skeleton, poses)
    points = world_positions(library.skeleton, poses)
    planted = find_plants(points, legs, library.frame_rate)
    toes = points[:, [leg.toes for leg in legs]][..., [0, 2]]
    slide = np.linalg.norm(np.diff(toes, axis=0), axis=-1)[planted[1:] & planted[:-1]]
    return planted.mean(), slide.mean()


@pytest.mark.parametrize(
    ("motion", "least", "most"), [("Idle_02", 0.9, 1.0), ("Walk_01", 0.4, 0.75), ("Talk_01", 0.9, 1.0)]
)
def test_in_the_demo_library_feet_are_planted_most_of_the_time_and_then_do_not_move(demo_library, motion, least, most):
    share, slide_cm = share_planted(demo_library, motion)
    assert least <= share <= most
    assert slide_cm < 0.05


@pytest.mark.parametrize(
    ("motion", "least", "most"), [("Idle_02", 1.0, 1.0), ("Walk_01", 0.45, 0.7), ("Talk_02", 1.0, 1.0)]
)
def test_in_real_clips_feet_are_planted_while_they_stand(reference_library, motion, least, most):
    share, slide_cm = share_planted(reference_library, motion)
    assert least <= share <= most
    assert slide_cm < 0.15
