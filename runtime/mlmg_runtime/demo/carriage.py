"""How pelvis, trunk and arms answer the feet and the breath, in every clip alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import ARM, HANGING, TRUNK, Performance, arm, trunk
from mlmg_runtime.demo.footwork import Footwork
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT, mirror_sign

# The stride in which the arms swing as far as a `Swing` says.
_STRIDE_CM = 68.0
_BREATH_S = 3.9
_CALM_DEG = 0.4


@dataclass(frozen=True, slots=True)
class Swing:
    """How far an arm swings to either side of its middle, and how much further its elbow bends in front."""

    shoulder_deg: float
    elbow_deg: float


EASY_SWING = Swing(18.0, 16.0)


def performed(
    times_s: FloatArray,
    feet: Footwork,
    noise: Noise,
    *,
    trunk_deg: FloatArray | float = 0.0,
    left: FloatArray = HANGING,
    right: FloatArray = HANGING,
    swing: Swing = EASY_SWING,
    crouch_cm: FloatArray | float = 0.0,
) -> Performance:
    """Return what a person does who means to do this: that, and all that a body does unasked.

    Parameters
    ----------
    trunk_deg : array, shape (n_frames, 9), of `TRUNK`, or 0.
    left, right : array, shape (n_frames, 9) or (9,), of `ARM`.
    """
    answering = _answering_trunk(times_s, feet) + noise.drifts(times_s, _CALM_DEG, 3.0, len(TRUNK))
    left_answer, right_answer = (_answering_arm(times_s, feet, noise, side, swing) for side in (LEFT, RIGHT))
    return Performance(feet, answering + trunk_deg, left + left_answer, right + right_answer, crouch_cm)


def breath(times_s: FloatArray) -> FloatArray:
    """Return how full the lungs are, -1 to 1, quicker in than out; shape (n_frames,)."""
    phase = 2.0 * np.pi * times_s / _BREATH_S
    return np.asarray(np.sin(phase + 0.35 * np.sin(phase)))


def _answering_trunk(times_s: FloatArray, feet: Footwork) -> FloatArray:
    """Return what the trunk does for the feet, shape (n_frames, 9).

    The pelvis goes forward with the leading leg and drops on the side that bears nothing; the spine turns and
    leans against it; the trunk leans into gathering speed.
    """
    stride = curves.blurred(feet.stride, 0.12) / _STRIDE_CM
    weight = curves.blurred(2.0 * feet.left_share - 1.0, 0.13)
    speed = np.gradient(curves.blurred(feet.body[:, 1], 0.4)) * curves.FRAME_RATE
    gathered = np.gradient(speed) * curves.FRAME_RATE
    return trunk(
        pelvis_turn=-5.5 * stride,
        pelvis_tilt=3.0,
        pelvis_list=4.0 * weight,
        turn=10.0 * curves.delayed(stride, 0.03),
        bend=-1.0 + 0.02 * gathered + 0.7 * breath(times_s),
        lean=4.5 * weight,
    )


def _answering_arm(times_s: FloatArray, feet: Footwork, noise: Noise, side: int, swing: Swing) -> FloatArray:
    """Return what an arm does unasked, shape (n_frames, 9): it swings with the other leg, breathes, drifts.

    A stance that lasts swings nothing: only what a stride is more than the stance over a while.
    """
    ahead = -mirror_sign(side) * (feet.stride - curves.blurred(feet.stride, 1.2)) / _STRIDE_CM
    share = curves.blurred(ahead, 0.2) * (1.0 + noise.drift(times_s, 0.07, 5.0))
    elbow_share = curves.delayed(share, 0.06)
    away, elbow_away = (np.hypot(part, 0.2) - 0.2 for part in (share, elbow_share))
    wandering = noise.drifts(times_s, 2.0 * _CALM_DEG, 4.0, len(ARM)) * np.sign(np.abs(HANGING))
    return wandering + arm(
        flexion=swing.shoulder_deg * share + 4.0 * away,
        abduction=1.5 * away,
        outward=-3.0 * (share + away),
        shrug=0.8 * breath(times_s),
        elbow=swing.elbow_deg * (0.6 * elbow_share + 0.5 * elbow_away),
        thumbward=4.0 * elbow_share,
    )
