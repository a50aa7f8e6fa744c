"""From what a person means to do to poses: footwork, and the angles of pelvis, trunk, head and arms.

All angles are in degrees and anatomical: positive is flexion, or to the person's left, or outward; left and
right arms have the same angles in mirror-image poses. The last axis of an array of them is `TRUNK` or `ARM`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo import curves
from mlmg_runtime.demo.footwork import TOE_OUT_DEG, Footwork
from mlmg_runtime.demo.inverse_kinematics import leg_pose
from mlmg_runtime.demo.skeleton import (
    HIP_OFFSET_CM,
    LEFT,
    RIGHT,
    SHIN_CM,
    SIDES,
    THIGH_CM,
    human_skeleton,
    mirror_sign,
)
from mlmg_runtime.skeleton import Poses

# The pelvis: turn to the left, tilt forward, list (the right hip drops). The spine, against the pelvis: turn,
# bend forward, lean to the left. The head, against straight ahead: glance to the left, nod, tilt to the left.
TRUNK = ("pelvis_turn", "pelvis_tilt", "pelvis_list", "turn", "bend", "lean", "glance", "nod", "tilt")
# Upper arm: flexion forward, abduction, outward rotation; shrug of the shoulder; elbow flexion; palm turned
# down (pronation); wrist: palm bent in, bent towards the thumb; curl of the fingers.
ARM = ("flexion", "abduction", "outward", "shrug", "elbow", "palm", "wrist", "thumbward", "curl")

STRAIGHTEST_KNEE_DEG = 7.0
# The head undoes this share of what pelvis and spine do to it.
_STEADY_HEAD = 0.85
_BODY_BEHIND_PRESSURE_CM = 2.0


def _angles(names: tuple[str, ...], angles_deg: dict[str, FloatArray | float]) -> FloatArray:
    unknown = set(angles_deg) - set(names)
    if unknown:
        raise TypeError(f"no such angle: {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    columns = np.broadcast_arrays(*(np.asarray(angles_deg.get(name, 0.0), dtype=float) for name in names))
    return np.stack(columns, axis=-1)


def trunk(**angles_deg: FloatArray | float) -> FloatArray:
    """Return angles of `TRUNK`, shape (..., 9), from those that are not 0; arrays are broadcast."""
    return _angles(TRUNK, angles_deg)


def arm(**angles_deg: FloatArray | float) -> FloatArray:
    """Return angles of `ARM`, shape (..., 9), from those that are not 0; arrays are broadcast."""
    return _angles(ARM, angles_deg)


def mixed(a: FloatArray, b: FloatArray, share: FloatArray) -> FloatArray:
    """Return the angles a share (n_frames,) of the way from `a` to `b`, shapes (n_frames, 9) or (9,)."""
    return np.asarray(a + share[:, None] * (b - a))


HANGING = arm(flexion=-1.0, abduction=6.5, outward=-14.0, elbow=15.0, palm=20.0, wrist=4.0, curl=24.0)


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """What a person does in one clip, one row a frame.

    Attributes
    ----------
    feet : steps, weight, and where the body floats.
    trunk : array, shape (n_frames, 9), of `TRUNK`.
    left, right : array, shape (n_frames, 9), of `ARM`.
    crouch_cm : array, shape (n_frames,), or a number. How far the hips are below where the legs are straight.
    """

    feet: Footwork
    trunk: FloatArray
    left: FloatArray
    right: FloatArray
    crouch_cm: FloatArray | float = 0.0


def poses(performance: Performance) -> Poses:
    """Return the poses of the skeleton of `human_skeleton`."""
    local = _upper_body(performance)
    hips = _hips_position(performance, local["Hips"])
    for side in (LEFT, RIGHT):
        local |= _leg(performance.feet, side, hips, local["Hips"])
    names = human_skeleton().names
    return Poses(np.stack([local[name] for name in names], axis=1), hips[:, None])


def _turned(order: str, *angles_deg: FloatArray) -> FloatArray:
    return rotations.from_euler(order, np.radians(np.stack(angles_deg, axis=-1)))


def _upper_body(performance: Performance) -> dict[str, FloatArray]:
    """Return the local rotations of everything but the legs, by joint name."""
    turn, tilt, sink, *spine_and_head = performance.trunk.T
    spine_turn, bend, lean, glance, nod, head_tilt = spine_and_head
    local = {"Hips": _turned("YXZ", turn, tilt, sink)}
    half_spine = _turned("YXZ", 0.5 * spine_turn, 0.5 * bend, -0.5 * lean)
    look_turn = glance - _STEADY_HEAD * (turn + spine_turn)
    look_down = nod - _STEADY_HEAD * (tilt + bend)
    look_tilt = -head_tilt + _STEADY_HEAD * (lean - sink)
    half_neck = _turned("YXZ", 0.5 * look_turn, 0.5 * look_down, 0.5 * look_tilt)
    local |= {"Spine": half_spine, "Chest": half_spine, "Neck": half_neck, "Head": half_neck}
    return local | _arm(performance.left, LEFT) | _arm(performance.right, RIGHT)


def _arm(angles_deg: FloatArray, side: int) -> dict[str, FloatArray]:
    """Return an arm's local rotations; a raised arm takes its shoulder blade along."""
    sign = mirror_sign(side)
    flexion, abduction, outward, shrug, elbow, palm, wrist, thumbward, curl = angles_deg.T
    raised = np.degrees(np.arccos(np.clip(_cos(flexion) * _cos(abduction), -1.0, 1.0)))
    blade = shrug + 0.2 * 0.5 * (raised - 40.0 + np.hypot(raised - 40.0, 20.0))
    zero = np.zeros_like(curl)
    finger = [_turned("ZX", -sign * share * curl, zero) for share in (0.85, 1.0, 1.15)]
    parts = {
        "Shoulder": _turned("ZX", sign * blade, zero),
        "Arm": _turned("XZY", -flexion, sign * (abduction - blade), sign * outward),
        "ForeArm": _turned("XY", -elbow, -sign * palm),
        "Hand": _turned("ZX", -sign * wrist, -thumbward),
        "HandThumb": _turned("ZX", -sign * 0.4 * curl, zero),
        "HandIndex": finger[0],
        "HandMiddle": finger[1],
        "HandPinky": finger[2],
    }
    return {SIDES[side] + name: rotation for name, rotation in parts.items()}


def _cos(angle_deg: FloatArray) -> FloatArray:
    return np.cos(np.radians(angle_deg))


def _hips_position(performance: Performance, hips: FloatArray) -> FloatArray:
    """Return where the hips are: over the feet as the body floats, as high as both legs let them."""
    feet = performance.feet
    x, z = feet.body[:, 0], feet.body[:, 1] - _BODY_BEHIND_PRESSURE_CM
    bend = np.radians(STRAIGHTEST_KNEE_DEG)
    reach = np.sqrt(THIGH_CM**2 + SHIN_CM**2 + 2.0 * THIGH_CM * SHIN_CM * np.cos(bend))
    ceilings = []
    for side in (LEFT, RIGHT):
        hip = rotations.rotate(hips, _hip_offset(side))
        away = np.hypot(x + hip[:, 0] - feet.ankles[:, side, 0], z + hip[:, 2] - feet.ankles[:, side, 2])
        ceilings.append(feet.ankles[:, side, 1] - hip[:, 1] + np.sqrt(np.maximum(reach**2 - away**2, 0.0)))
    y = curves.smooth_floor(np.minimum(*ceilings), 0.07) - performance.crouch_cm
    return np.stack((x, y, z), axis=-1)


def _hip_offset(side: int) -> FloatArray:
    return np.array(HIP_OFFSET_CM) * (mirror_sign(side), 1.0, 1.0)


def _leg(feet: Footwork, side: int, hips: FloatArray, hips_rotation: FloatArray) -> dict[str, FloatArray]:
    toe_out = np.radians(mirror_sign(side) * TOE_OUT_DEG)
    hip = hips + rotations.rotate(hips_rotation, _hip_offset(side))
    forward = np.broadcast_to((np.sin(toe_out), 0.0, np.cos(toe_out)), hip.shape)
    leg = leg_pose(hip, feet.ankles[:, side], forward, THIGH_CM, SHIN_CM)
    knee = rotations.about_axis("X", leg.knee_rad)
    shin = rotations.multiply(leg.hip, knee)
    pitch = feet.pitch_rad[:, side]
    foot = rotations.from_euler("YX", np.stack((np.full_like(pitch, toe_out), -pitch), axis=-1))
    parts = {
        "UpLeg": rotations.multiply(rotations.inverse(hips_rotation), leg.hip),
        "Leg": knee,
        "Foot": rotations.multiply(rotations.inverse(shin), foot),
        "ToeBase": rotations.about_axis("X", -feet.toes_rad[:, side]),
    }
    return {SIDES[side] + name: rotation for name, rotation in parts.items()}
