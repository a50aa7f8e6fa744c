"""The two idles: standing about, and standing with both hands raised."""

from __future__ import annotations

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import HANGING, Performance, arm, trunk
from mlmg_runtime.demo.carriage import performed
from mlmg_runtime.demo.footwork import HALT_CM, StepPlan, footwork
from mlmg_runtime.demo.gestures import BESIDE_HEAD, LIFTING, whipped
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT


def idle_01() -> Performance:
    """Return standing: the weight goes from leg to leg, one foot forward and the other after it."""
    noise = Noise(1)
    times_s = curves.frame_times(310)
    plan = StepPlan()
    plan.shift(LEFT, 4.4, 4.85, (0.0, HALT_CM))
    plan.shift(RIGHT, 8.7, 9.2, (0.0, HALT_CM))
    lean_left, lean_right = (
        curves.plateau(times_s, 1.2, 2.2, 3.2, 4.2),
        curves.plateau(times_s, 6.4, 7.3, 7.8, 8.5),
    )
    lean = 0.3 * lean_left - 0.2 * lean_right + noise.drift(times_s, 0.02, 2.5)
    feet = footwork(times_s, plan.steps, lean=lean)
    look_left, look_right = (
        curves.plateau(times_s, 1.9, 2.5, 3.7, 4.4),
        curves.plateau(times_s, 7.0, 7.7, 8.8, 9.5),
    )
    glance = 30.0 * look_left - 28.0 * look_right
    looking = trunk(glance=glance, turn=0.15 * curves.delayed(glance, 0.1), nod=0.06 * np.abs(glance))
    return performed(times_s, feet, noise, trunk_deg=looking)


def idle_02() -> Performance:
    """Return standing with the hands raised beside the head, swaying from leg to leg."""
    noise = Noise(2)
    times_s = curves.frame_times(324)
    plan = StepPlan()
    plan.shift(RIGHT, 1.3, 1.75, (0.0, -0.5 * HALT_CM))
    plan.shift(LEFT, 2.3, 2.75, (0.0, 0.5 * HALT_CM))
    raised = curves.plateau(times_s, 0.9, 2.0, 8.6, 9.6)
    sway = raised * np.sin(2.0 * np.pi * times_s / 2.4)
    feet = footwork(times_s, plan.steps, lean=0.28 * sway + raised * noise.drift(times_s, 0.03, 2.5))
    swaying = trunk(lean=3.0 * sway, bend=-2.0 * raised)
    left, right = (_raised_hand(times_s, toward) for toward in (sway, -sway))
    return performed(times_s, feet, noise, trunk_deg=swaying, left=left, right=right)


def _raised_hand(times_s: FloatArray, sway: FloatArray) -> FloatArray:
    """Return the angles of an arm that is raised beside the head, sways there, and is let down."""
    poses = [HANGING, LIFTING, BESIDE_HEAD, BESIDE_HEAD, LIFTING, HANGING]
    track = whipped(times_s, [0.9, 1.6, 2.2, 8.6, 9.2, 9.8], poses)
    return track + arm(abduction=4.0 * sway, outward=8.0 * sway, elbow=6.0 * sway, wrist=6.0 * sway)
