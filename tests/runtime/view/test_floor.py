import numpy as np
import pytest

from mlmg_runtime.view.floor import floor
from mlmg_runtime.view.palette import BACKGROUND
from mlmg_runtime.view.studio import Studio

TARGET = np.array([0.0, 0.9, 0.0])


@pytest.fixture
def studio():
    return Studio((120, 120), 0.3, pitch_rad=0.35)


def picture(studio, height, radius=0.2, target=TARGET):
    centres = np.array([[[target[0], height, target[2]]] * 2])
    return floor(studio, target, centres, np.array([[radius, radius]])).sum(axis=-1)


def pixel(studio, place):
    """Return row and column of a place in the world."""
    seen = (np.asarray(place) - studio.eye(TARGET)) @ studio.axes.T
    return int(60 - studio.focal * seen[1] / -seen[2]), int(60 + studio.focal * seen[0] / -seen[2])


def test_a_shadow_lies_where_the_light_is_cut_off(studio):
    bare, shaded = picture(studio, 60.0), picture(studio, 1.0)
    light = studio.light
    where = np.array([0.0, 1.0, 0.0]) - light / light[1]
    assert shaded[pixel(studio, where)] < 0.6 * bare[pixel(studio, where)]
    assert shaded[pixel(studio, (-0.6, 0.0, 0.6))] == pytest.approx(bare[pixel(studio, (-0.6, 0.0, 0.6))], rel=0.02)


def test_what_touches_the_floor_darkens_it_more_than_what_hangs_above(studio):
    standing, hanging = picture(studio, 0.2), picture(studio, 0.5)
    below = pixel(studio, (0.0, 0.0, 0.0))
    assert standing[below] < hanging[below]


def test_lines_are_at_whole_metres_of_the_world():
    studio = Studio((200, 200), 0.0, pitch_rad=1.2, distance_m=4.0)
    target = np.array([0.5, 0.0, 0.5])
    bare = picture(studio, 60.0, target=target)
    # In the middle of a cell there is none; half a metre to the left there is one.
    left = 100 - round(studio.focal * 0.5 / studio.distance_m)
    assert bare[100, left - 1 : left + 2].max() > 1.3 * bare[100, 100]


def test_far_away_and_above_the_horizon_is_background(studio):
    image = floor(Studio((60, 60), 0.0, pitch_rad=0.0), TARGET, np.full((1, 2, 3), 60.0), np.full((1, 2), 0.1))
    assert np.array_equal(image[0, 0], BACKGROUND)
    assert np.array_equal(image[29, 0], BACKGROUND)
