"""Footwork: from a list of steps to where both feet are, which of them carries, and where the body floats.

A foot is planted between its steps, and a planted foot rolls: over its heel while the toes are up, over its
ball while the heel is. All of its movement is the sum of three parts (the print on the ground glides from
place to place, the ankle rises as the foot tips over heel or ball, a step's clearance), so no plant slides.

The body follows from the feet: it moves as a linear inverted pendulum (Kajita et al., 2001) over the point
where the feet press on the ground. The only one of its movements that neither starts nor ends with a fall is
the path of that point under a two-sided exponential filter: it leans into the first step before it is made,
sways from foot to foot, and comes to rest after the last.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.skeleton import (
    ANKLE_HEIGHT_CM,
    BALL_OFFSET_CM,
    HEEL_OFFSET_CM,
    LEFT,
    RIGHT,
    mirror_sign,
)

# How far each foot stands to its side in the neutral stance, and how far its toes point outward.
HALF_STANCE_CM = 8.5
TOE_OUT_DEG = 7.0
# A foot that is carried as far as this in a step rolls in full: from the heel and to the toes.
LONG_STEP_CM = 130.0
# How far the left foot stands before the right in the stance in which a walk ends.
HALT_CM = 16.0

# sqrt(g / height of the body's middle).
_PENDULUM_PER_S = 3.2
_HEEL_RISE_S = 0.24
_FOOT_FLAT_S = 0.10
_STRIKE_DEG = 20.0
_PUSH_DEG = 58.0
_LEAST_PUSH_DEG = 14.0
# Where a foot presses on the ground, forward of its ankle: as it lands, as it stands, as it leaves.
_PRESS_CM = (0.0, 4.5, 15.0)


@dataclass(frozen=True, slots=True)
class Step:
    """One foot leaves the ground and comes down elsewhere; a place is the ankle's (x, z) over ground, cm."""

    foot: int
    lift_s: float
    land_s: float
    place: tuple[float, float]


@dataclass(slots=True)
class StepPlan:
    """A list of steps in the making: knows where the feet stand after those it has.

    The feet start in the neutral stance, side by side below the hips.
    """

    steps: list[Step] = field(default_factory=list)
    places: list[tuple[float, float]] = field(
        default_factory=lambda: [(mirror_sign(side) * HALF_STANCE_CM, 0.0) for side in (LEFT, RIGHT)]
    )

    def step(self, foot: int, lift_s: float, land_s: float, place: tuple[float, float]) -> None:
        """Add a step that comes down at `place`."""
        self.steps.append(Step(foot, lift_s, land_s, place))
        self.places[foot] = place

    def shift(self, foot: int, lift_s: float, land_s: float, by: tuple[float, float]) -> None:
        """Add a step that comes down `by` from where the foot stands."""
        x, z = self.places[foot]
        self.step(foot, lift_s, land_s, (x + by[0], z + by[1]))


@dataclass(frozen=True, slots=True, eq=False)
class Footwork:
    """What the feet do, and how the body floats above them; all arrays have one row a frame.

    Attributes
    ----------
    ankles : shape (n_frames, 2, 3). World positions, cm; left, right.
    pitch_rad : shape (n_frames, 2). Toes up is positive.
    toes_rad : shape (n_frames, 2). How far the toes are bent up against the foot.
    prints : shape (n_frames, 2, 2). Where (x, z) the ankles are with the feet put down flat.
    left_share : shape (n_frames,). The share of the weight on the left foot, 0 to 1.
    body : shape (n_frames, 2). Where over the ground (x, z) the body is.
    """

    ankles: FloatArray
    pitch_rad: FloatArray
    toes_rad: FloatArray
    prints: FloatArray
    left_share: FloatArray
    body: FloatArray

    @property
    def stride(self) -> FloatArray:
        """Return how far the left foot is before the right, in cm, shape (n_frames,)."""
        return np.asarray(self.prints[:, LEFT, 1] - self.prints[:, RIGHT, 1])


def footwork(
    times_s: FloatArray,
    steps: Sequence[Step],
    *,
    relax_s: float = 0.45,
    lean: FloatArray | float = 0.0,
    clearance_cm: float = 3.5,
    evenness_s: float = 0.0,
) -> Footwork:
    """Return what the feet do in the given steps, which start in the neutral stance.

    Parameters
    ----------
    times_s : array, shape (n_frames,).
    steps : in the order in which they land; one foot's do not overlap.
    relax_s : how long the weight takes to go to both feet after a step, and to the carrying foot before one.
    lean : array, shape (n_frames,), added to the left foot's share of the weight while both feet stand.
    clearance_cm : how far a foot is lifted at the middle of a step, above what its roll lifts it.
    evenness_s : how far to either side the pressure is averaged along the walk; more makes an evener walk.
    """
    feet = [_foot(times_s, steps, side, clearance_cm) for side in (LEFT, RIGHT)]
    prints, pitch, ankles, toes = (np.stack(parts, axis=1) for parts in zip(*feet, strict=True))
    left_share = _left_share(times_s, steps, relax_s, lean)
    share = np.stack((left_share, 1.0 - left_share), axis=-1)
    press = prints.copy()
    press[..., 1] += np.stack([_press_forward(times_s, steps, side, relax_s) for side in (LEFT, RIGHT)], axis=-1)
    pressure = np.sum(share[..., None] * press, axis=1)
    if evenness_s:
        pressure[:, 1] = curves.blurred(pressure[:, 1], evenness_s)
    return Footwork(ankles, pitch, toes, prints, left_share, _pendulum(pressure))


def _foot(
    times_s: FloatArray, steps: Sequence[Step], side: int, clearance_cm: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return one foot's prints (n, 2), pitch (n,), ankle (n, 3), and bend of the toes (n,)."""
    own = [step for step in steps if step.foot == side]
    start = np.array([mirror_sign(side) * HALF_STANCE_CM, 0.0])
    places = np.array([start, *(step.place for step in own)])
    lift = np.array([step.lift_s for step in own])
    land = np.array([step.land_s for step in own])
    in_step = np.clip((times_s[:, None] - lift) / (land - lift), 0.0, 1.0)
    prints = start + curves.glided(in_step) @ np.diff(places, axis=0)
    pitch = _pitch(times_s, own, np.diff(places[:, 1]))
    raised, forward = _tipped(pitch)
    # Up and down at speed: a sole that skims over the ground before it comes to rest would look like sliding.
    air = np.sin(np.pi * in_step).sum(axis=-1)
    toe_out = np.radians(mirror_sign(side) * TOE_OUT_DEG)
    ankle = np.stack(
        (
            prints[:, 0] + np.sin(toe_out) * forward,
            ANKLE_HEIGHT_CM + raised + clearance_cm * air,
            prints[:, 1] + np.cos(toe_out) * forward,
        ),
        axis=-1,
    )
    return prints, pitch, ankle, np.maximum(-pitch, 0.0) * (1.0 - 0.45 * air)


def _pitch(times_s: FloatArray, own: Sequence[Step], advance_cm: FloatArray) -> FloatArray:
    """Return how a foot tips: its heel rises before a step, its toes as it comes down forward."""
    key_times, keys = [-1.0], [0.0]
    for step, advance in zip(own, advance_cm, strict=True):
        long = float(advance) / LONG_STEP_CM
        push = _LEAST_PUSH_DEG + (_PUSH_DEG - _LEAST_PUSH_DEG) * max(min(long, 1.0), 0.0)
        strike = _STRIKE_DEG * max(min(long, 1.0), -0.4)
        in_air = step.land_s - step.lift_s
        key_times += [
            max(step.lift_s - _HEEL_RISE_S, key_times[-1] + 0.03),
            step.lift_s + 0.18 * in_air,
            step.land_s - 0.06 * in_air,
            step.land_s + _FOOT_FLAT_S,
        ]
        keys += [0.0, -push, strike, 0.0]
    return np.radians(curves.keyed(times_s, [*key_times, key_times[-1] + 1.0], [*keys, 0.0]))


def _tipped(pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far up and forward the ankle goes as the foot tips over its heel or its ball."""
    over_heel = pitch_rad > 0.0
    up = np.where(over_heel, -HEEL_OFFSET_CM[1], -BALL_OFFSET_CM[1])
    forward = np.where(over_heel, -HEEL_OFFSET_CM[2], -BALL_OFFSET_CM[2])
    sine, less = np.sin(pitch_rad), np.cos(pitch_rad) - 1.0
    return up * less + forward * sine, forward * less - up * sine


def _left_share(times_s: FloatArray, steps: Sequence[Step], relax_s: float, lean: FloatArray | float) -> FloatArray:
    events = [event for step in steps for event in (step.lift_s, step.land_s)]
    carries = [value for step in steps for value in [float(step.foot == RIGHT)] * 2]
    share = curves.relaxing(times_s, events, carries, 0.5, relax_s)
    on_both = 4.0 * share * (1.0 - share)
    return np.asarray(share + on_both * lean)


def _press_forward(times_s: FloatArray, steps: Sequence[Step], side: int, relax_s: float) -> FloatArray:
    """Return how far before the ankle a foot presses: from heel to ball, the more so the longer the step."""
    landing, standing, leaving = _PRESS_CM
    events, values = [], []
    places = {side: 0.0}
    for step in steps:
        if step.foot == side:
            long = min(abs(step.place[1] - places[side]) / LONG_STEP_CM, 1.0)
            events += [step.lift_s, step.land_s]
            values += [standing + long * (leaving - standing), standing + long * (landing - standing)]
            places[side] = step.place[1]
    return curves.relaxing(times_s, events, values, standing, relax_s)


def _pendulum(pressure: FloatArray) -> FloatArray:
    reach = round(3.0 * curves.FRAME_RATE)
    kernel = np.exp(-_PENDULUM_PER_S / curves.FRAME_RATE * np.abs(np.arange(-reach, reach + 1)))
    return curves.filtered(pressure, kernel / kernel.sum())
