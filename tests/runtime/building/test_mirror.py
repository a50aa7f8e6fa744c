from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime import bvh, rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.building.mirror import mirrored, partner_joints
from mlmg_runtime.bvh import Joint
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.skeleton import Poses, Skeleton, world_positions, world_transforms

POSITIONS = ("Xposition", "Yposition", "Zposition")
ACROSS = np.array([-1.0, 1.0, 1.0])


def named(*names: str) -> Skeleton:
    return Skeleton(tuple(Joint(name, index - 1, (0.0, 1.0, 0.0), ()) for index, name in enumerate(names)))


def body(odd: bool) -> Skeleton:
    """Return a body with two arms, two legs and fingers; `odd` gives the local frames of the right arm other axes."""
    hand = (9.0, 0.5, 1.0)
    right_hand = (-0.5, 9.0, 1.0) if odd else (-9.0, 0.5, 1.0)
    finger = (2.0, 0.0, -1.0)
    right_finger = (0.0, 2.0, -1.0) if odd else (-2.0, 0.0, -1.0)
    rows = [
        ("Hips", -1, (0.0, 0.0, 0.0), POSITIONS),
        ("Spine", 0, (0.0, 20.0, 1.0), ()),
        ("LeftArm", 1, (15.0, 20.0, 0.0), ()),
        ("LeftHand", 2, hand, ()),
        ("LeftIndex", 3, finger, ()),
        ("LeftThumb", 3, (finger[0], finger[1], -finger[2]), ()),
        ("RightArm", 1, (-15.0, 20.0, 0.0), ()),
        ("RightHand", 6, right_hand, ()),
        ("RightIndex", 7, right_finger, ()),
        ("RightThumb", 7, (right_finger[0], right_finger[1], -right_finger[2]), ()),
        ("LeftLeg", 0, (9.0, -40.0, 0.0), ()),
        ("RightLeg", 0, (-9.0, -40.0, 0.0), ()),
    ]
    return Skeleton(tuple(Joint(*row) for row in rows))


def moving(skeleton: Skeleton, seed: int) -> Poses:
    random = np.random.default_rng(seed)
    turned = rotations.normalized(random.normal(size=(7, len(skeleton.joints), 4)))
    return Poses(turned, random.normal(scale=100.0, size=(7, len(skeleton.positioned), 3)))


def places_in_mirror(skeleton: Skeleton, poses: Poses) -> FloatArray:
    """Return where each joint should be: where its partner was, on the other side of the plane x = 0."""
    return np.asarray(world_positions(skeleton, poses)[:, list(partner_joints(skeleton))] * ACROSS)


@pytest.mark.parametrize("odd", [False, True])
def test_each_joint_goes_where_its_partner_was_mirrored_whatever_its_local_frame(odd: bool) -> None:
    skeleton = body(odd)
    poses = moving(skeleton, 1)
    found = world_positions(skeleton, mirrored(skeleton, poses))
    np.testing.assert_allclose(found, places_in_mirror(skeleton, poses), atol=1e-9)


@pytest.mark.parametrize("odd", [False, True])
def test_mirrored_twice_poses_are_what_they_were(odd: bool) -> None:
    skeleton = body(odd)
    poses = moving(skeleton, 2)
    twice = mirrored(skeleton, mirrored(skeleton, poses))
    assert np.degrees(rotations.angle_between(twice.rotations, poses.rotations)).max() < 1e-5
    np.testing.assert_allclose(twice.positions, poses.positions, atol=1e-9)


def test_mirroring_leaves_the_poses_given_as_they_were() -> None:
    skeleton = body(False)
    poses = moving(skeleton, 3)
    before = poses.rotations.copy(), poses.positions.copy()
    mirrored(skeleton, poses)
    np.testing.assert_array_equal(poses.rotations, before[0])
    np.testing.assert_array_equal(poses.positions, before[1])


def test_a_turn_to_the_left_becomes_one_to_the_right() -> None:
    skeleton = named("Hips", "Head")
    skeleton = Skeleton((replace(skeleton.joints[0], channels=POSITIONS), skeleton.joints[1]))
    left = Poses(rotations.about_axis("Y", np.full((1, 2), 0.3)), np.zeros((1, 1, 3)))
    right = mirrored(skeleton, left)
    expected = rotations.about_axis("Y", np.full((1, 2), -0.3))
    np.testing.assert_allclose(rotations.angle_between(right.rotations, expected), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("LeftArm", "RightArm"),
        ("leftArm", "rightArm"),
        ("LEFT_ARM", "RIGHT_ARM"),
        ("Hand_L", "Hand_R"),
        ("hand.l", "hand.r"),
        ("L_Hand", "R_Hand"),
        ("LHand", "RHand"),
        ("mixamorig:LeftHand", "mixamorig:RightHand"),
        ("Bip01 L Foot", "Bip01 R Foot"),
        ("LowerArm_L", "LowerArm_R"),
        ("LOWER_ARM_L", "LOWER_ARM_R"),
        ("LOWERARM_L", "LOWERARM_R"),
        ("Right_L", "Right_R"),
    ],
)
def test_the_partner_of_a_joint_is_told_by_its_name(left: str, right: str) -> None:
    assert partner_joints(named("Hips", left, right)) == (0, 2, 1)


@pytest.mark.parametrize("name", ["Spine", "Head", "LowerBack", "Reference", "Collar", "LeftTail"])
def test_a_joint_without_a_partner_is_its_own(name: str) -> None:
    assert partner_joints(named("Hips", name)) == (0, 1)


def along_x() -> Skeleton:
    """Return a body whose bones lie along x in its local frames: to the left along x, to the right against it."""
    rows = [
        ("Hips", -1, (0.0, 0.0, 0.0), POSITIONS),
        ("Spine", 0, (16.0, 0.0, 0.0), ()),
        ("Chest", 1, (9.0, -0.4, 0.0), ()),
        ("Head", 2, (23.0, 0.0, 0.0), ()),
        *(
            row
            for sign, letter, at in ((1.0, "L", 3), (-1.0, "R", 6))
            for row in (
                (f"UpperArm_{letter}", 2, (13.0, -0.2, 5.0 * sign), ()),
                (f"LowerArm_{letter}", at + 1, (24.0 * sign, 0.0, 0.0), ()),
                (f"Hand_{letter}", at + 2, (22.0 * sign, 0.0, 0.0), ()),
            )
        ),
        ("UpperLeg_L", 0, (-2.0, -6.5, 0.0), ()),
        ("UpperLeg_R", 0, (-2.0, 6.5, 0.0), ()),
    ]
    return Skeleton(tuple(Joint(*row) for row in rows))


def standing(raised_rad: float) -> tuple[Skeleton, Poses]:
    """Return that body upright, the right arm stretched out aside, the left one raised from there."""
    skeleton = along_x()
    turned = np.tile([1.0, 0.0, 0.0, 0.0], (3, len(skeleton.joints), 1))
    at = {name: joint for joint, name in enumerate(skeleton.names)}
    # In the frame of the hips the left lies against y, in that of the chest along z; x points up in both.
    chest = np.array([0.5, 0.5, 0.5, 0.5])
    turned[:, at["Hips"]] = rotations.about_axis("Z", np.array(np.pi / 2.0))
    turned[:, at["Spine"]] = rotations.multiply(rotations.inverse(turned[0, at["Hips"]]), chest)
    aside = rotations.about_axis("Y", np.array(-np.pi / 2.0))
    raised = rotations.about_axis("Y", np.array(raised_rad - np.pi / 2.0))
    turned[:, at["UpperArm_L"]] = raised
    turned[:, at["UpperArm_R"]] = rotations.multiply(rotations.about_axis("Z", np.array(np.pi)), aside)
    return skeleton, Poses(turned, np.zeros((3, 1, 3)))


@pytest.mark.parametrize("raised_rad", [0.0, 1.0, 2.0])
def test_local_rotations_in_the_mirror_are_those_of_the_other_side_whatever_way_the_frames_lie(
    raised_rad: float,
) -> None:
    skeleton, poses = standing(raised_rad)
    turned = np.degrees(rotations.angle_between(mirrored(skeleton, poses).rotations, poses.rotations)).max(axis=0)
    arms = [skeleton.names.index(name) for name in ("UpperArm_L", "UpperArm_R")]
    np.testing.assert_allclose(turned[arms], np.degrees(raised_rad), atol=1e-5)
    assert np.delete(turned, arms).max() < 1e-5


def test_sides_that_are_unlike_are_refused() -> None:
    joints = list(body(False).joints)
    joints[11] = replace(joints[11], offset=(-9.0, 40.0, 0.0))
    skeleton = Skeleton(tuple(joints))
    with pytest.raises(ValueError, match="the bones below `Hips` do not mirror each other; expected the OFFSETs"):
        mirrored(skeleton, moving(skeleton, 4))
    joints = list(body(False).joints)
    joints[7] = replace(joints[7], offset=(-25.0, 0.5, 1.0))
    skeleton = Skeleton(tuple(joints))
    with pytest.raises(ValueError, match="the bones below `LeftArm` and `RightArm` do not mirror each other"):
        mirrored(skeleton, moving(skeleton, 4))


@pytest.mark.mocap
@pytest.mark.parametrize("clip", ["reference/Walk_03", "cmu-29/29_02", "reference-6channel/Talk_01"])
def test_on_a_real_body_each_joint_goes_near_where_its_partner_was_mirrored(mocap: Path, clip: str) -> None:
    document = bvh.read(mocap / f"{clip}.bvh")
    document = replace(document, frames=document.frames[:60])
    skeleton, poses = skeleton_from_bvh(document), poses_from_bvh(document)
    found = mirrored(skeleton, poses)
    stature = np.ptp(world_positions(skeleton, poses)[0, skeleton.travel :, 1])
    apart = np.linalg.norm(world_positions(skeleton, found) - places_in_mirror(skeleton, poses), axis=-1)
    # The two sides of a real body differ a little; what is measured here is that of the skeleton itself.
    assert apart[:, skeleton.travel :].max() < 0.03 * stature
    twice = mirrored(skeleton, found)
    drift = rotations.angle_between(world_transforms(skeleton, twice)[0], world_transforms(skeleton, poses)[0])
    assert np.degrees(drift).max() < 1e-4


@pytest.mark.mocap
@pytest.mark.parametrize("clip", ["reference/*", "library/dataset-1_bye_*", "cmu-29/29_02", "cmu-135/135_09"])
def test_on_a_real_body_the_spine_in_the_mirror_is_turned_as_before_and_sides_as_far_as_they_differ(
    mocap: Path, clip: str
) -> None:
    paths = sorted(mocap.glob(f"{clip}.bvh"))
    assert paths
    for path in paths:
        document = bvh.read(path)
        skeleton, poses = skeleton_from_bvh(document), poses_from_bvh(document)
        turned = np.degrees(rotations.angle_between(mirrored(skeleton, poses).rotations, poses.rotations))
        middle = [j for j in skeleton.body[1:] if partner_joints(skeleton)[j] == j]
        assert turned[:, middle].mean(axis=0).max() < 60.0
        # Arms may be far from that: one waves, and the other hangs.
        legs = [j for j, name in enumerate(skeleton.names) if "Leg" in name or "Foot" in name]
        assert turned[:, legs].mean(axis=0).max() < 90.0
