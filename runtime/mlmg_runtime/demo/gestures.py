"""Gestures of the arms: from the hanging hand to a pose, a few beats there, and back.

Each has the phases that McNeill (1992) tells apart: preparation, stroke, hold, retraction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import ARM, HANGING, arm

# The hand before the belly; held out, palm up; out to the side; at the chest; beside the head; high.
BELLY = arm(flexion=16.0, abduction=12.0, outward=-28.0, elbow=76.0, palm=40.0, curl=22.0)
OFFER = arm(flexion=30.0, abduction=10.0, outward=0.0, elbow=66.0, palm=-45.0, wrist=-8.0, curl=18.0)
OPEN = arm(flexion=14.0, abduction=20.0, outward=24.0, elbow=66.0, palm=-40.0, wrist=-10.0, curl=14.0)
CHEST = arm(flexion=34.0, abduction=20.0, outward=-52.0, elbow=108.0, palm=30.0, wrist=6.0, curl=20.0)
BESIDE_HEAD = arm(flexion=12.0, abduction=84.0, outward=68.0, elbow=112.0, palm=0.0, wrist=-6.0, curl=16.0)
HIGH = arm(flexion=22.0, abduction=122.0, outward=46.0, elbow=52.0, palm=-6.0, wrist=-8.0, curl=12.0)

# On the way up to these, the bent arm passes before the shoulder.
LIFTING = arm(flexion=34.0, abduction=26.0, outward=12.0, elbow=104.0, palm=10.0, curl=22.0)

PREPARATION_S = 0.62
STROKE_S = 0.30
SETTLE_S = 0.20
BEAT_S = 0.46
RETRACTION_S = 0.80

# The hand goes back before it strikes, and gives a little at each beat.
_WIND_UP = arm(flexion=7.0, elbow=12.0, wrist=-8.0)
_BEAT = arm(flexion=2.5, elbow=11.0, wrist=-7.0)
# A limb moves like a whip: the elbow after the shoulder, the wrist after the elbow, the fingers last.
_LEAD_S = 0.14
_LAG_S = dict.fromkeys(ARM, 0.0) | {
    "elbow": 0.03,
    "palm": 0.05,
    "wrist": 0.08,
    "thumbward": 0.08,
    "curl": 0.12,
}


@dataclass(frozen=True, slots=True, eq=False)
class Gesture:
    """A pose that an arm strikes at `stroke_s`, holds for some beats, and leaves for the next or to hang."""

    stroke_s: float
    pose: FloatArray
    n_beats: int = 1

    @property
    def end_s(self) -> float:
        """Return when the hold ends."""
        return self.stroke_s + SETTLE_S + self.n_beats * BEAT_S


def whipped(times_s: FloatArray, key_times_s: Sequence[float], poses: Sequence[FloatArray]) -> FloatArray:
    """Return the angles of an arm, shape (n_frames, 9), that eases from pose to pose, joint after joint."""
    columns = np.stack(poses).T
    lags = _LAG_S.values()
    tracks = [
        curves.keyed(times_s - lag, key_times_s, list(column), _LEAD_S)
        for lag, column in zip(lags, columns, strict=True)
    ]
    return np.stack(tracks, axis=-1)


def gesturing(times_s: FloatArray, gestures: Sequence[Gesture], by: FloatArray | None = None) -> FloatArray:
    """Return the angles of an arm, shape (n_frames, 9), that makes gestures and hangs where there is time.

    Parameters
    ----------
    times_s : array, shape (n_frames,).
    gestures : rising in time.
    by : array, shape (9,). What the arm passes on its way from hanging and back to it, if anything.
    """
    keys = [(-10.0, HANGING)]
    for gesture in gestures:
        prepared_s = gesture.stroke_s - STROKE_S
        if prepared_s - PREPARATION_S - keys[-1][0] > RETRACTION_S:
            keys += _hanging(keys[-1][0], prepared_s, by)
        keys += [(prepared_s, gesture.pose + _WIND_UP), (gesture.stroke_s, gesture.pose)]
        for beat in range(gesture.n_beats):
            begin_s = gesture.stroke_s + SETTLE_S + beat * BEAT_S
            keys += [(begin_s, gesture.pose), (begin_s + 0.5 * BEAT_S, gesture.pose + _BEAT)]
        keys.append((gesture.end_s, gesture.pose))
    keys += _hanging(keys[-1][0], keys[-1][0] + 100.0, by)
    key_times, poses = zip(*keys, strict=True)
    return whipped(times_s, key_times, poses)


def _hanging(left_s: float, prepared_s: float, by: FloatArray | None) -> list[tuple[float, FloatArray]]:
    """Return the keys of an arm that goes to hang at `left_s` and is in position again at `prepared_s`."""
    down_s, up_s = left_s + RETRACTION_S, prepared_s - PREPARATION_S
    if by is None:
        return [(down_s, HANGING), (up_s, HANGING)]
    going = (left_s + 0.4 * RETRACTION_S, by)
    coming = (up_s + 0.5 * PREPARATION_S, by)
    return [going, (down_s, HANGING), (up_s, HANGING), coming]


def nods(times_s: FloatArray, gestures: Sequence[Gesture], size_deg: float = 4.0) -> FloatArray:
    """Return how far the head nods, shape (n_frames,): at each stroke, and less at each beat."""
    track = np.zeros_like(times_s)
    for gesture in gestures:
        track += size_deg * curves.bump((times_s - gesture.stroke_s + 0.35) / 0.7)
        for beat in range(gesture.n_beats):
            track += 0.5 * size_deg * curves.bump((times_s - gesture.stroke_s - (beat + 0.7) * BEAT_S) / BEAT_S)
    return track
