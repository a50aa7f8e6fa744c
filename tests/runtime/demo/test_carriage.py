import numpy as np

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import HANGING, TRUNK, arm
from mlmg_runtime.demo.carriage import Swing, breath, performed
from mlmg_runtime.demo.footwork import StepPlan, footwork
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT

TIMES = curves.frame_times(300)
FLEXION = 0


def march() -> StepPlan:
    plan = StepPlan()
    for index in range(10):
        foot = (RIGHT, LEFT)[index % 2]
        lift = 1.0 + 0.55 * index
        plan.step(foot, lift, lift + 0.45, (plan.places[foot][0], plan.places[1 - foot][1] + 60.0))
    return plan


def test_a_person_who_stands_still_breathes_and_wanders_a_little() -> None:
    still = performed(TIMES, footwork(TIMES, []), Noise(0))
    for angles in (still.trunk, still.left - HANGING, still.right - HANGING):
        assert 0.2 < np.ptp(angles, axis=0).max() < 8.0


def test_an_arm_swings_forward_with_the_other_leg() -> None:
    feet = footwork(TIMES, march().steps)
    walking = performed(TIMES, feet, Noise(0), swing=Swing(18.0, 11.0))
    steady = slice(75, 165)
    assert np.corrcoef(walking.left[steady, FLEXION], feet.stride[steady])[0, 1] < -0.9
    assert np.corrcoef(walking.right[steady, FLEXION], feet.stride[steady])[0, 1] > 0.9
    assert 20.0 < np.ptp(walking.left[steady, FLEXION]) < 40.0


def test_the_chest_turns_against_the_pelvis() -> None:
    walking = performed(TIMES, footwork(TIMES, march().steps), Noise(0))
    pelvis, spine = (
        walking.trunk[75:165, TRUNK.index("pelvis_turn")],
        walking.trunk[75:165, TRUNK.index("turn")],
    )
    assert np.corrcoef(pelvis, spine)[0, 1] < -0.9


def test_a_stance_that_lasts_swings_no_arm() -> None:
    plan = StepPlan()
    plan.shift(LEFT, 1.0, 1.4, (0.0, 30.0))
    stepped, still = (performed(TIMES, footwork(TIMES, steps), Noise(0)).left for steps in (plan.steps, []))
    assert np.abs(stepped - still)[:60].max() > 2.0
    assert np.abs(stepped - still)[-60:].max() < 1e-6


def test_what_is_meant_comes_on_top() -> None:
    meant = HANGING + arm(elbow=40.0)
    plain, raised = (performed(TIMES, footwork(TIMES, []), Noise(0), left=pose).left for pose in (HANGING, meant))
    np.testing.assert_allclose(raised - plain, np.tile(arm(elbow=40.0), (300, 1)), atol=1e-9)


def test_a_breath_is_drawn_quicker_than_let_go() -> None:
    lungs = breath(np.arange(0.0, 39.0, 0.01))
    assert np.mean(np.diff(lungs) > 0.0) < 0.48
    assert np.abs(lungs).max() <= 1.0
