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
