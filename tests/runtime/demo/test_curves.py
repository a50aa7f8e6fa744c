import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.demo import curves

SHARES = np.linspace(-0.5, 1.5, 401)
TIMES = curves.frame_times(300)


@pytest.mark.parametrize("way", [curves.eased, curves.glided])
def test_a_way_is_made_whole_and_never_backwards(way) -> None:
    made = way(SHARES)
    assert np.all(made[SHARES <= 0.0] == 0.0)
    np.testing.assert_allclose(made[SHARES >= 1.0], 1.0, atol=1e-12)
    assert np.all(np.diff(made) >= -1e-12)


@pytest.mark.parametrize("way", [curves.eased, curves.glided])
def test_a_way_begins_and_ends_at_rest(way) -> None:
    near = np.array([1e-4, 1.0 - 1e-4])
    np.testing.assert_allclose(way(near), [0.0, 1.0], atol=1e-7)


def test_a_foot_glides_at_a_more_even_speed_than_a_hand_reaches() -> None:
    fastest = [np.diff(way(np.linspace(0.0, 1.0, 1001))).max() * 1000 for way in (curves.glided, curves.eased)]
    assert fastest[0] == pytest.approx(1.0 / (1.0 - 0.5 * (0.34 + 0.29)), rel=1e-4)
    assert fastest[1] == pytest.approx(1.875, rel=1e-4)


def test_a_keyed_track_is_at_each_key_in_time_and_stays_at_the_last() -> None:
    keys = [np.array([1.0, 2.0]), np.array([-3.0, 0.0]), np.array([4.0, 4.0])]
    track = curves.keyed(np.array([-9.0, 1.0, 2.5, 6.0, 99.0]), [1.0, 2.5, 6.0], keys)
    np.testing.assert_allclose(track, [keys[0], keys[0], keys[1], keys[2], keys[2]], atol=1e-12)


def test_a_lead_rounds_the_corner_without_moving_the_ends() -> None:
    sharp, round_ = (curves.keyed(TIMES, [1.0, 3.0, 5.0], [0.0, 1.0, 0.0], lead) for lead in (0.0, 0.5))
    assert sharp.max() == pytest.approx(1.0)
    assert 0.8 < round_.max() < 0.99
    assert round_[0] == round_[-1] == 0.0


def test_key_times_that_do_not_rise_are_refused() -> None:
    with pytest.raises(ValueError, match=r"must rise: \[1.0, 3.0, 2.0\]"):
        curves.keyed(TIMES, [1.0, 3.0, 2.0], [0.0, 1.0, 0.0])


def test_a_plateau_is_one_between_rise_and_fall_and_else_nought() -> None:
    track = curves.plateau(TIMES, 1.0, 2.0, 4.0, 5.0)
    assert np.all(track[(TIMES <= 1.0) | (TIMES >= 5.0)] == 0.0)
    assert np.all(track[(TIMES >= 2.0) & (TIMES <= 4.0)] == 1.0)


def test_a_relaxing_track_rests_between_events_far_apart_and_not_between_near_ones() -> None:
    track = curves.relaxing(TIMES, [2.0, 3.0, 8.0], [1.0, 0.9, 0.0], 0.5, 0.6)
    at = dict(zip(TIMES.round(4), track, strict=True))
    assert at[2.0] == pytest.approx(1.0)
    assert at[2.5] > 0.9
    assert at[5.0] == pytest.approx(0.5)
    assert at[8.0] == pytest.approx(0.0)
    assert at[9.0] == pytest.approx(0.5)


def test_a_relaxing_track_without_events_rests() -> None:
    assert np.all(curves.relaxing(TIMES, [], [], 0.5, 0.6) == 0.5)


def test_blurring_keeps_what_is_even_and_moves_no_step() -> None:
    step = (TIMES >= 5.0).astype(float)
    blurred = curves.blurred(np.stack((step, np.full(300, 7.0)), axis=-1), 0.4)
    np.testing.assert_allclose(blurred[:, 1], 7.0)
    np.testing.assert_allclose(blurred[[137, 162], 0], [0.0, 1.0])
    np.testing.assert_allclose(blurred[149, 0] + blurred[150, 0], 1.0)


@given(
    st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=60).map(np.array),
    st.floats(0.0, 0.5),
)
def test_a_smooth_floor_is_never_above_the_ceiling(ceiling: np.ndarray, width_s: float) -> None:
    assert np.all(curves.smooth_floor(ceiling, width_s) <= ceiling + 1e-9)


def test_a_smooth_floor_touches_an_even_ceiling() -> None:
    np.testing.assert_allclose(curves.smooth_floor(np.full(40, 3.0), 0.2), 3.0)


def test_a_delayed_signal_is_the_same_later() -> None:
    signal = np.sin(TIMES)
    np.testing.assert_allclose(curves.delayed(signal, 0.1)[3:], signal[:-3], atol=1e-12)
    np.testing.assert_allclose(curves.delayed(signal, 0.1)[:3], signal[0])
