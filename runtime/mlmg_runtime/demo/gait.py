"""The three walks: stand, first step, many cycles, last step, stand.

They begin in the neutral stance and end with one foot before the other: see `clips`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import Performance, arm, mixed
from mlmg_runtime.demo.carriage import EASY_SWING, Swing, performed
from mlmg_runtime.demo.footwork import HALF_STANCE_CM, HALT_CM, Step, StepPlan, footwork
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT, mirror_sign


@dataclass(frozen=True, slots=True)
class Pace:
    """How a person walks for a while: so many steps, each of a length and a time."""

    n_steps: int
    length_cm: float
    step_s: float


_FIRST_LIFT_S = 0.95
_GOING = (Pace(1, 46.0, 0.60), Pace(1, 60.0, 0.55))
_EASY = Pace(2, 63.5, 0.51)
_HALTING = (Pace(1, 52.0, 0.55), Pace(1, HALT_CM, 0.66))

_HALF_WIDTH_CM = 5.0
# The share of a step's time for which both feet stand.
_DOUBLE_SUPPORT = 0.16

_GREETING = arm(flexion=12.0, abduction=120.0, outward=58.0, elbow=58.0, palm=-10.0, curl=8.0)


def walk_01() -> Performance:
    """Return a walk at an easy pace, 1.25 m/s."""
    return _walk(342, Noise(11), [*_GOING, replace(_EASY, n_steps=14), *_HALTING])


def walk_02() -> Performance:
    """Return a brisk walk, 1.5 m/s between an easy start and an easy end, with bent arms."""
    paces = [*_GOING, _EASY, Pace(12, 72.0, 0.48), _EASY, *_HALTING]
    return _walk(358, Noise(12), paces, Swing(22.0, 30.0))


def walk_03() -> Performance:
    """Return a walk, 1.15 m/s, in which the left hand is raised and waves, once a step."""
    n_frames, step_s = 322, 0.54
    walk = _walk(n_frames, Noise(13), [*_GOING, Pace(12, 62.0, step_s), *_HALTING])
    times_s = curves.frame_times(n_frames)
    raised = curves.plateau(times_s, 1.9, 3.1, 7.2, 8.4)
    phase = 2.0 * np.pi * times_s / step_s
    to_and_fro = np.sin(phase)
    # On its way up and down the arm is bent.
    passing = (4.0 * raised * (1.0 - raised))[:, None] * arm(flexion=16.0, abduction=-18.0, elbow=46.0)
    waving = arm(outward=16.0 * to_and_fro, elbow=12.0 * to_and_fro, thumbward=12.0 * np.sin(phase - 0.6))
    return replace(walk, left=mixed(walk.left, _GREETING + waving, raised) + passing)


def walk_steps(paces: Sequence[Pace], noise: Noise) -> list[Step]:
    """Return the steps of a walk straight ahead, right foot first, from the neutral stance to a halt."""
    length = np.concatenate([np.full(pace.n_steps, pace.length_cm) for pace in paces])
    step_s = np.concatenate([np.full(pace.n_steps, pace.step_s) for pace in paces])
    length[:-1] += noise.jitter(1.0, len(length) - 1)
    step_s *= 1.0 + noise.jitter(0.01, len(length))
    half_width = _HALF_WIDTH_CM + noise.jitter(0.4, len(length))
    half_width[-2:] = HALF_STANCE_CM
    lift_s = _FIRST_LIFT_S + np.concatenate(([0.0], np.cumsum(step_s)[:-1]))
    land_s = lift_s + (1.0 - _DOUBLE_SUPPORT) * step_s
    plan = StepPlan()
    for index in range(len(length)):
        foot = (RIGHT, LEFT)[index % 2]
        place = (mirror_sign(foot) * half_width[index], plan.places[1 - foot][1] + length[index])
        plan.step(foot, lift_s[index], land_s[index], place)
    return plan.steps


def _walk(n_frames: int, noise: Noise, paces: Sequence[Pace], swing: Swing = EASY_SWING) -> Performance:
    times_s = curves.frame_times(n_frames)
    feet = footwork(times_s, walk_steps(paces, noise), evenness_s=0.25)
    return performed(times_s, feet, noise, swing=swing)
