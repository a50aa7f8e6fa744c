"""The wave of the left hand: all of it below the elbow, so that anyone standing or walking can make it."""

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
# The forearm upright before the shoulder, the palm to the front.
_READY = arm(flexion=6.0, abduction=22.0, outward=12.0, elbow=138.0, palm=68.0, wrist=-14.0, curl=10.0)


def wave_01() -> Performance:
    """Return standing: the left forearm is raised, the hand waves five times, and is let down."""
    noise = Noise(31)
    times_s = curves.frame_times(220)
    feet = footwork(times_s, [], lean=noise.drift(times_s, 0.04, 2.5))
    raised = whipped(times_s, [0.9, _BEGIN_S, _END_S, _END_S + 0.9], [HANGING, _READY, _READY, HANGING])
    up = curves.plateau(times_s, _BEGIN_S - 0.35, _BEGIN_S + 0.35, _END_S - 0.3, _END_S + 0.3)
    phase = 2.0 * np.pi * (times_s - _BEGIN_S) / _WAVE_S
    waving = arm(
        thumbward=20.0 * np.sin(phase),
        elbow=5.0 * np.sin(phase + 0.8),
        palm=10.0 * np.sin(phase + 0.5),
        curl=5.0 * np.sin(phase - 0.9),
    )
    looking = trunk(tilt=5.0 * up, glance=8.0 * up)
    return performed(times_s, feet, noise, trunk_deg=looking, left=raised + up[:, None] * waving)
