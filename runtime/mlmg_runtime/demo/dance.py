"""The dance: on the spot, 100 beats a minute, in bars of four beats; the knees give on every beat."""

from __future__ import annotations

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import HANGING, Performance, arm, trunk
from mlmg_runtime.demo.carriage import performed
from mlmg_runtime.demo.footwork import HALT_CM, Step, StepPlan, footwork
from mlmg_runtime.demo.gestures import whipped
from mlmg_runtime.demo.noise import Noise
from mlmg_runtime.demo.skeleton import LEFT, RIGHT, mirror_sign

BEAT_S = 0.6
_FIRST_BEAT_S = 1.5
# The share of a beat for which a foot is in the air before it lands on the beat.
_AIR = 0.55
_SIDE_CM = 20.0
_ROCK_CM = 17.0

# A bar: on each beat, which foot lands how far to its left (x) and forward (z). It ends where it began.
_SIDE_TO_SIDE = (
    (RIGHT, (-_SIDE_CM, 0.0)),
    (LEFT, (-_SIDE_CM, 0.0)),
    (LEFT, (_SIDE_CM, 0.0)),
    (RIGHT, (_SIDE_CM, 0.0)),
)
_ROCK = (
    (RIGHT, (0.0, _ROCK_CM)),
    (RIGHT, (0.0, -_ROCK_CM)),
    (LEFT, (0.0, _ROCK_CM)),
    (LEFT, (0.0, -_ROCK_CM)),
)
_MOVES = (*_SIDE_TO_SIDE, *_ROCK, *_SIDE_TO_SIDE, *_ROCK, *_SIDE_TO_SIDE, (LEFT, (0.0, HALT_CM)))
_LAST_BEAT = len(_MOVES) - 1
_FIRST_BEATS_OF_ROCKS = (4, 12)

_LOW = arm(flexion=12.0, abduction=16.0, outward=-12.0, elbow=78.0, palm=15.0, curl=52.0)
_UP = arm(flexion=22.0, abduction=112.0, outward=42.0, elbow=66.0, palm=0.0, curl=40.0)


def music_01() -> Performance:
    """Return the dance: from side to side, in turn with rocking steps forward in which the arms go up."""
    noise = Noise(41)
    times_s = curves.frame_times(440)
    beat = (times_s - _FIRST_BEAT_S) / BEAT_S
    dancing = curves.plateau(beat, -2.0, 0.0, _LAST_BEAT - 1.0, _LAST_BEAT + 1.0)
    left, right = (_arm_keys(beat) + dancing[:, None] * _pumping(beat, side) for side in (LEFT, RIGHT))
    return performed(
        times_s,
        footwork(times_s, _steps(), relax_s=0.5),
        noise,
        trunk_deg=dancing[:, None] * _groove(beat),
        left=left,
        right=right,
        crouch_cm=dancing * (3.4 + 2.4 * np.cos(2.0 * np.pi * beat) + noise.drift(times_s, 0.3, 4.0)),
    )


def _steps() -> list[Step]:
    plan = StepPlan()
    for beat, (foot, by) in enumerate(_MOVES):
        land_s = _FIRST_BEAT_S + beat * BEAT_S
        plan.shift(foot, land_s - _AIR * BEAT_S, land_s, by)
    return plan.steps


def _groove(beat: FloatArray) -> FloatArray:
    """Return what the trunk does, shape (n_frames, 9): it gives on each beat, sways and turns over two."""
    each, every_second = 2.0 * np.pi * beat, np.pi * beat
    return trunk(
        pelvis_list=5.0 * np.sin(every_second),
        pelvis_turn=6.0 * np.cos(every_second),
        pelvis_tilt=3.0 * np.cos(each),
        turn=-11.0 * np.cos(every_second - 0.3),
        lean=6.0 * np.sin(every_second - 0.3),
        bend=3.0 + 2.5 * np.cos(each - 0.4),
        nod=4.0 * np.cos(each - 0.6),
        tilt=3.0 * np.sin(every_second - 0.5),
    )


def _arm_keys(beat: FloatArray) -> FloatArray:
    """Return the angles of an arm, shape (n_frames, 9): before the belly, in the rocking bars overhead."""
    key_beats, poses = [-1.6, 0.0], [HANGING, _LOW]
    for first in _FIRST_BEATS_OF_ROCKS:
        key_beats += [first - 0.8, first + 0.4, first + 3.0, first + 4.2]
        poses += [_LOW, _UP, _UP, _LOW]
    key_beats += [_LAST_BEAT - 1.0, _LAST_BEAT + 0.6]
    poses += [_LOW, HANGING]
    return whipped(beat * BEAT_S, [BEAT_S * key for key in key_beats], poses)


def _pumping(beat: FloatArray, side: int) -> FloatArray:
    """Return what comes on top, shape (n_frames, 9): elbows pump on each beat, the arms go by turns."""
    turn = mirror_sign(side) * np.cos(np.pi * beat)
    pump = np.cos(2.0 * np.pi * beat - 0.5)
    return arm(
        flexion=14.0 * turn,
        abduction=4.0 * pump,
        outward=6.0 * turn,
        elbow=9.0 * pump + 8.0 * turn,
        wrist=6.0 * pump,
    )
