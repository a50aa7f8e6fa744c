import numpy as np
import pytest

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import ARM, HANGING
from mlmg_runtime.demo.gestures import BELLY, HIGH, LIFTING, OFFER, Gesture, gesturing, nods, whipped

TIMES = curves.frame_times(240)
ELBOW, WRIST = ARM.index("elbow"), ARM.index("wrist")


def at(time_s: float) -> int:
    return round(time_s * curves.FRAME_RATE)


def test_an_arm_hangs_strikes_holds_and_hangs_again() -> None:
    track = gesturing(TIMES, [Gesture(3.0, BELLY, 0)])
    np.testing.assert_allclose(track[[0, at(1.8), at(4.6), -1]], np.tile(HANGING, (4, 1)), atol=1e-9)
    np.testing.assert_allclose(track[at(3.0), : WRIST - 2], BELLY[: WRIST - 2], atol=1e-9)


def test_gestures_near_each_other_are_joined_without_hanging_between() -> None:
    near, far = (gesturing(TIMES, [Gesture(2.0, BELLY), Gesture(again, OFFER)])[:, ELBOW] for again in (3.3, 5.5))
    assert near[at(2.0) : at(3.3)].min() > 50.0
    assert far[at(2.0) : at(5.5)].min() == pytest.approx(HANGING[ELBOW], abs=1e-6)


def test_beats_bend_the_elbow_as_often_as_asked() -> None:
    elbow = gesturing(TIMES, [Gesture(2.0, OFFER, 3)])[at(2.2) : at(3.65), ELBOW]
    inner = elbow[1:-1]
    assert np.count_nonzero((inner > elbow[:-2]) & (inner >= elbow[2:]) & (inner > OFFER[ELBOW] + 5.0)) == 3


def test_the_wrist_follows_the_elbow() -> None:
    keys = [HANGING, HANGING + 30.0]
    track = whipped(TIMES, [2.0, 3.0], keys) - HANGING
    assert track[at(2.4), ELBOW] > track[at(2.4), WRIST] > 0.0


def test_a_raised_arm_passes_what_it_is_told_to_pass() -> None:
    straight, bent = (gesturing(TIMES, [Gesture(3.0, HIGH)], by)[:, ELBOW] for by in (None, LIFTING))
    assert bent[at(2.1) : at(2.7)].max() > straight[at(2.1) : at(2.7)].max() + 20.0
    np.testing.assert_allclose(bent[[0, at(3.0), -1]], straight[[0, at(3.0), -1]], atol=1.0)


def test_the_head_nods_at_the_stroke() -> None:
    nod = nods(TIMES, [Gesture(3.0, OFFER, 0)], 5.0)
    assert nod.max() == pytest.approx(5.0, rel=0.01)
    assert abs(int(nod.argmax()) - at(3.0)) <= 1
    assert nod[at(2.6)] < 1e-9 > nod[at(3.4)]
