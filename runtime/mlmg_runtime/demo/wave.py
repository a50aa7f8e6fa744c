"""The wave of the left hand: all of it in the arm, so that anyone standing or walking can make it."""

from __future__ import annotations

import numpy as np

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import HANGING, Performance, arm, trunk
from mlmg_runtime.demo.carriage import performed
from mlmg_runtime.demo.footwork import footwork
from mlmg_runtime.demo.gestures import whipped
from mlmg_runtime.demo.noise import Noise

_WAVE_S = 22 / curves.FRAME_RATE
_BEGIN_S = 1.8
_END_S = _BEGIN_S + 5 * _WAVE_S
# The hand beside the head, the elbow a little below the shoulder, the palm to the front.
_READY = arm(flexion=20.0, abduction=72.0, outward=62.0, elbow=96.0, palm=-4.0, wrist=-8.0, curl=10.0)
# On the way up and down the elbow bends more and stays closer to the body.
_PASSING = arm(flexion=14.0, abduction=-14.0, elbow=34.0)


def wave_01() -> Performance:
    """Return standing: the left arm is raised, the hand waves five times, and is let down."""
    noise = Noise(31)
    times_s = curves.frame_times(220)
    feet = footwork(times_s, [], lean=noise.drift(times_s, 0.04, 2.5))
    raised = whipped(times_s, [0.9, _BEGIN_S, _END_S, _END_S + 0.9], [HANGING, _READY, _READY, HANGING])
    up = curves.plateau(times_s, _BEGIN_S - 0.35, _BEGIN_S + 0.35, _END_S - 0.3, _END_S + 0.3)
    phase = 2.0 * np.pi * (times_s - _BEGIN_S) / _WAVE_S
    waving = arm(
        outward=15.0 * np.sin(phase),
        elbow=11.0 * np.sin(phase),
        thumbward=12.0 * np.sin(phase - 0.6),
        curl=5.0 * np.sin(phase - 0.9),
    )
    passing = (4.0 * up * (1.0 - up))[:, None] * _PASSING
    looking = trunk(tilt=5.0 * up, glance=8.0 * up)
    return performed(times_s, feet, noise, trunk_deg=looking, left=raised + passing + up[:, None] * waving)
