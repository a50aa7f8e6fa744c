import numpy as np
import pytest

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.footwork import HALF_STANCE_CM, Footwork, Step, StepPlan, footwork
from mlmg_runtime.demo.skeleton import ANKLE_HEIGHT_CM, LEFT, RIGHT

TIMES = curves.frame_times(240)


@pytest.fixture(scope="module")
def stroll() -> Footwork:
    plan = StepPlan()
    plan.shift(RIGHT, 2.0, 2.4, (0.0, 50.0))
    plan.step(LEFT, 2.5, 2.95, (HALF_STANCE_CM, 50.0))
    return footwork(TIMES, plan.steps)


def test_a_plan_knows_where_the_feet_stand() -> None:
    plan = StepPlan()
    plan.shift(LEFT, 1.0, 1.4, (2.0, 16.0))
    plan.shift(LEFT, 2.0, 2.4, (0.0, -6.0))
    assert plan.steps[1] == Step(LEFT, 2.0, 2.4, (HALF_STANCE_CM + 2.0, 10.0))
    assert plan.places == [(HALF_STANCE_CM + 2.0, 10.0), (-HALF_STANCE_CM, 0.0)]


def test_without_steps_nothing_moves() -> None:
    still = footwork(TIMES, [])
    assert np.ptp(still.ankles, axis=0).max() == 0.0
    assert np.ptp(still.body, axis=0).max() < 1e-9
    np.testing.assert_allclose(still.ankles[0, :, 1], ANKLE_HEIGHT_CM)
    np.testing.assert_allclose(still.body[0], [0.0, 4.5], atol=1e-9)


def test_a_foot_moves_over_the_ground_only_in_its_step(stroll: Footwork) -> None:
    moved = np.abs(np.diff(stroll.prints, axis=0)).max(axis=-1) > 0.0
    in_step = [(TIMES[1:] > lift) & (TIMES[:-1] < land) for lift, land in ((2.5, 2.95), (2.0, 2.4))]
    assert not np.any(moved & ~np.stack(in_step, axis=-1))
    np.testing.assert_allclose(stroll.prints[-1], [[HALF_STANCE_CM, 50.0], [-HALF_STANCE_CM, 50.0]])


def test_a_foot_rolls_over_its_ball_before_and_over_its_heel_after_a_step(stroll: Footwork) -> None:
    lift, land = round(2.5 * 30), round(2.95 * 30)
    pitch = np.degrees(stroll.pitch_rad[:, LEFT])
    assert pitch[lift] < -20.0
    assert pitch[land] > 5.0
    assert np.all(pitch[[lift - 9, land + 4, -1]] == 0.0)


def test_the_weight_goes_to_the_foot_that_stays_before_the_other_is_lifted(stroll: Footwork) -> None:
    left_share = dict(zip(TIMES.round(4), stroll.left_share, strict=True))
    assert left_share[1.0] == left_share[7.0] == 0.5
    assert left_share[2.0] == left_share[2.2] == left_share[2.4] == 1.0
    assert left_share[2.5] == left_share[2.9] == 0.0


def test_the_body_leans_to_the_standing_foot_and_rests_between_the_feet_at_the_end(stroll: Footwork) -> None:
    assert stroll.body[round(2.1 * 30), 0] > 1.0
    assert stroll.body[round(2.9 * 30), 0] < -1.0
    np.testing.assert_allclose(stroll.body[-1], [0.0, 54.5], atol=0.05)
    assert np.abs(np.diff(stroll.body[[0, 1, -2, -1]], axis=0)[[0, 2]]).max() < 0.01


def test_a_lean_takes_weight_only_while_both_feet_stand() -> None:
    plan = StepPlan()
    plan.shift(RIGHT, 3.0, 3.4, (0.0, 10.0))
    leaning = footwork(TIMES, plan.steps, lean=np.full(240, 0.2))
    assert leaning.left_share[30] == pytest.approx(0.7)
    assert leaning.left_share[96] == pytest.approx(1.0)
