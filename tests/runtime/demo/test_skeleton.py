import numpy as np
import pytest

from mlmg_runtime import rotations
from mlmg_runtime.demo.skeleton import SIDES, human_skeleton

# What a person's joints can do, in degrees, about X, then Z, then Y of the turned frame: a trunk joint bends
# forward, leans and turns; in a left limb, X lifts backward, Z lifts to the left, Y turns to the left.
TRUNK_LIMITS = {
    "Spine": ((-20, 45), (-20, 20), (-25, 25)),
    "Chest": ((-20, 45), (-20, 20), (-25, 25)),
    "Neck": ((-30, 35), (-25, 25), (-40, 40)),
    "Head": ((-30, 35), (-25, 25), (-40, 40)),
}
HINGE = (-1e-6, 1e-6)
LEFT_LIMITS = {
    "Shoulder": ((-15, 15), (-10, 35), (-20, 20)),
    "ForeArm": ((-150, 0), HINGE, (-85, 85)),
    "Hand": ((-25, 35), (-75, 75), (-10, 10)),
    "HandThumb": ((-20, 20), (-60, 20), (-20, 20)),
    "HandIndex": ((-10, 10), (-90, 20), (-10, 10)),
    "HandMiddle": ((-10, 10), (-90, 20), (-10, 10)),
    "HandPinky": ((-10, 10), (-90, 20), (-10, 10)),
    "UpLeg": ((-120, 20), (-30, 45), (-40, 40)),
    "Leg": ((0, 140), HINGE, HINGE),
    "Foot": ((-32, 50), (-25, 25), (-20, 20)),
    "ToeBase": ((-65, 30), HINGE, HINGE),
}


def within(angles_deg: np.ndarray, limits: tuple[tuple[float, float], ...]) -> bool:
    low, high = np.array(limits).T
    return bool(np.all((angles_deg > low - 1e-5) & (angles_deg < high + 1e-5)))


def test_a_person_has_hands_and_toes_and_two_like_sides() -> None:
    skeleton = human_skeleton()
    assert 25 <= len(skeleton.joints) <= 32
    assert {"LeftHand", "LeftHandIndex", "RightHandThumb", "LeftToeBase", "RightToeBase"} <= set(skeleton.names)
    by_name = {joint.name: joint for joint in skeleton.joints}
    for name, joint in by_name.items():
        if name.startswith("Left"):
            twin = by_name["Right" + name.removeprefix("Left")]
            assert twin.offset == (-joint.offset[0], *joint.offset[1:])
            assert (twin.end_site is None) == (joint.end_site is None)


def test_only_the_hips_travel_and_every_joint_turns_in_all_ways() -> None:
    for joint in human_skeleton().joints:
        turns = [channel for channel in joint.channels if channel.endswith("rotation")]
        assert len(turns) == 3
        assert (len(joint.channels) == 6) == (joint.name == "Hips")


def test_only_the_tips_have_end_sites() -> None:
    skeleton = human_skeleton()
    for index, joint in enumerate(skeleton.joints):
        assert (joint.end_site is None) == bool(skeleton.children[index])


@pytest.mark.parametrize("joint", TRUNK_LIMITS)
def test_the_trunk_stays_within_human_limits(clips, joint: str) -> None:
    for name, clip in clips.items():
        angles = np.degrees(rotations.to_euler("XZY", clip.local(joint)))
        assert within(angles, TRUNK_LIMITS[joint]), name


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("joint", LEFT_LIMITS)
def test_the_limbs_stay_within_human_limits(clips, side: str, joint: str) -> None:
    mirror = np.array([1.0, 1.0, 1.0] if side == "Left" else [1.0, -1.0, -1.0])
    for name, clip in clips.items():
        angles = mirror * np.degrees(rotations.to_euler("XZY", clip.local(side + joint)))
        assert within(angles, LEFT_LIMITS[joint]), name


@pytest.mark.parametrize("side", SIDES)
def test_the_upper_arms_stay_within_human_limits(clips, side: str) -> None:
    outward = 1.0 if side == "Left" else -1.0
    for name, clip in clips.items():
        arm = rotations.multiply(clip.local(f"{side}Shoulder"), clip.local(f"{side}Arm"))
        x, y, z = rotations.rotate(arm, np.array([0.0, -1.0, 0.0])).T
        assert np.all(y < np.cos(np.radians(180.0 - 165.0))), name
        assert np.all(np.degrees(np.arcsin(-z)) < 50.0), name
        assert np.all(np.degrees(np.arcsin(-outward * x)) < 35.0), name
        twist_deg = np.degrees(2.0 * np.arctan2(arm[:, 2], arm[:, 0]) + np.pi) % 360.0 - 180.0
        assert np.all(np.abs(twist_deg) < 100.0), name


def test_all_joints_but_the_hips_and_upper_arms_have_a_limit() -> None:
    limited = {*TRUNK_LIMITS, *(side + joint for side in SIDES for joint in LEFT_LIMITS)}
    assert set(human_skeleton().names) - limited == {"Hips", "LeftArm", "RightArm"}
