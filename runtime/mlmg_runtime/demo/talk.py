"""The two talks: with small gestures before the belly, and with hands raised high."""

from __future__ import annotations

from collections.abc import Sequence

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import Performance, trunk
from mlmg_runtime.demo.carriage import performed
from mlmg_runtime.demo.footwork import HALT_CM, StepPlan, footwork
from mlmg_runtime.demo.gestures import (
    BELLY,
    BESIDE_HEAD,
    CHEST,
    HIGH,
    LIFTING,
    OFFER,
    OPEN,
    Gesture,
    gesturing,
    nods,
)
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT


def talk_01() -> Performance:
    """Return talking with small gestures: the right hand, both, the left, both; in between the hands hang."""
    times_s = curves.frame_times(360)
    plan = StepPlan()
    plan.shift(LEFT, 6.2, 6.65, (0.0, HALT_CM))
    plan.shift(RIGHT, 10.0, 10.45, (0.0, HALT_CM))
    left = [Gesture(5.2, OFFER, 1), Gesture(8.9, CHEST, 1), Gesture(10.1, OPEN, 0)]
    right = [
        Gesture(1.7, BELLY, 1),
        Gesture(2.9, OFFER, 0),
        Gesture(5.25, OFFER, 1),
        Gesture(10.15, OFFER, 0),
    ]
    look_right, look_left = (
        curves.plateau(times_s, 1.0, 1.6, 3.0, 3.6),
        curves.plateau(times_s, 7.4, 8.0, 9.2, 9.9),
    )
    glance = 14.0 * look_left - 11.0 * look_right
    return _talking(times_s, Noise(21), plan, left=left, right=right, glance=glance)


def talk_02() -> Performance:
    """Return talking with the hands raised high: by turns one wide above the head, the other beside it."""
    times_s = curves.frame_times(312)
    plan = StepPlan()
    plan.shift(RIGHT, 1.2, 1.65, (0.0, -0.5 * HALT_CM))
    plan.shift(LEFT, 2.3, 2.75, (0.0, 0.5 * HALT_CM))
    left = [Gesture(1.80 + 1.5 * turn, (HIGH, BESIDE_HEAD)[turn % 2]) for turn in range(5)]
    right = [Gesture(1.86 + 1.5 * turn, (BESIDE_HEAD, HIGH)[turn % 2]) for turn in range(5)]
    look_left, look_right = (
        curves.plateau(times_s, 1.2, 2.0, 4.0, 4.6),
        curves.plateau(times_s, 4.4, 5.0, 7.0, 8.0),
    )
    glance = 10.0 * look_left - 12.0 * look_right
    return _talking(times_s, Noise(22), plan, left=left, right=right, glance=glance, by=LIFTING)


def _talking(
    times_s: FloatArray,
    noise: Noise,
    plan: StepPlan,
    *,
    left: Sequence[Gesture],
    right: Sequence[Gesture],
    glance: FloatArray,
    by: FloatArray | None = None,
) -> Performance:
    """Return what a talker does: gestures, a nod with each, and a head that goes with the words."""
    feet = footwork(times_s, plan.steps, lean=noise.drift(times_s, 0.06, 2.5))
    nod = nods(times_s, [*left, *right])
    words = noise.drifts(times_s, 1.0, 1.2, 3).T
    speaking = trunk(glance=glance + words[0], nod=nod + words[1], tilt=words[2], turn=0.3 * glance, bend=0.35 * nod)
    left_arm, right_arm = (gesturing(times_s, gestures, by) for gestures in (left, right))
    return performed(times_s, feet, noise, trunk_deg=speaking, left=left_arm, right=right_arm)
