"""The person of the demo library: 29 joints, 172 cm tall, at rest standing with hanging arms, facing +z."""

from __future__ import annotations

from mlmg_runtime.bvh.document import POSITION_CHANNELS, Joint
from mlmg_runtime.skeleton import Skeleton

LEFT, RIGHT = 0, 1
SIDES = ("Left", "Right")

THIGH_CM = 43.0
SHIN_CM = 42.0
ANKLE_HEIGHT_CM = 8.0
HIP_OFFSET_CM = (9.2, -2.0, 0.0)
# From the ankle, on a foot that stands flat: the joint of the toes, and where the heel touches the ground.
BALL_OFFSET_CM = (0.0, -6.0, 13.0)
HEEL_OFFSET_CM = (0.0, -ANKLE_HEIGHT_CM, -5.0)

_ROTATION = ("Zrotation", "Xrotation", "Yrotation")

_Offset = tuple[float, float, float]
_Row = tuple[str, str, _Offset, _Offset | None]

_TRUNK: tuple[_Row, ...] = (
    ("Spine", "Hips", (0.0, 9.0, -1.0), None),
    ("Chest", "Spine", (0.0, 17.0, 0.0), None),
    ("Neck", "Chest", (0.0, 24.0, -0.5), None),
    ("Head", "Neck", (0.0, 10.0, 1.5), (0.0, 17.0, 0.0)),
)
# Of the left side; the right side is its mirror image. At rest the palms face the thighs.
_ARM: tuple[_Row, ...] = (
    ("Shoulder", "Chest", (3.0, 19.0, 1.0), None),
    ("Arm", "Shoulder", (14.5, 0.0, -1.5), None),
    ("ForeArm", "Arm", (0.0, -29.0, 0.0), None),
    ("Hand", "ForeArm", (0.0, -26.0, 0.0), None),
    ("HandThumb", "Hand", (-1.0, -3.0, 2.8), (-1.0, -5.0, 3.5)),
    ("HandIndex", "Hand", (0.0, -9.0, 2.6), (0.0, -8.0, 0.4)),
    ("HandMiddle", "Hand", (0.0, -9.3, 0.4), (0.0, -8.8, 0.0)),
    ("HandPinky", "Hand", (0.0, -8.0, -3.2), (0.0, -6.5, -0.5)),
)
_LEG: tuple[_Row, ...] = (
    ("UpLeg", "Hips", HIP_OFFSET_CM, None),
    ("Leg", "UpLeg", (0.0, -THIGH_CM, 0.0), None),
    ("Foot", "Leg", (0.0, -SHIN_CM, 0.0), None),
    ("ToeBase", "Foot", BALL_OFFSET_CM, (0.0, -0.5, 7.0)),
)


def human_skeleton() -> Skeleton:
    """Return the skeleton: cm, y up, the left of the body at +x; only the hips have position channels."""
    rows = [
        *_TRUNK,
        *_of_side(_ARM, LEFT),
        *_of_side(_ARM, RIGHT),
        *_of_side(_LEG, LEFT),
        *_of_side(_LEG, RIGHT),
    ]
    joints = [Joint("Hips", -1, (0.0, 0.0, 0.0), (*POSITION_CHANNELS, *_ROTATION))]
    index = {"Hips": 0}
    for name, parent, offset, end_site in rows:
        index[name] = len(joints)
        joints.append(Joint(name, index[parent], offset, _ROTATION, end_site))
    return Skeleton(tuple(joints))


def mirror_sign(side: int) -> float:
    """Return 1 for the left side, -1 for the right: the sign of x, and of turns about y and z."""
    return 1.0 if side == LEFT else -1.0


def _of_side(rows: tuple[_Row, ...], side: int) -> list[_Row]:
    own = {name for name, _, _, _ in rows}
    return [
        (
            SIDES[side] + name,
            SIDES[side] + parent if parent in own else parent,
            _mirrored(offset, side),
            None if end_site is None else _mirrored(end_site, side),
        )
        for name, parent, offset, end_site in rows
    ]


def _mirrored(offset: _Offset, side: int) -> _Offset:
    return (mirror_sign(side) * offset[0], offset[1], offset[2])
