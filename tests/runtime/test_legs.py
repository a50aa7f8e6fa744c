"""Legs found in made-up skeletons, in that of the demo library and in real ones."""

from dataclasses import replace

import numpy as np
import pytest

from mlmg_runtime.bvh import Joint, read
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.demo.skeleton import human_skeleton
from mlmg_runtime.legs import find_legs
from mlmg_runtime.skeleton import Poses, Skeleton

TURNS = ("Zrotation", "Xrotation", "Yrotation")


def still(skeleton):
    """Return one pose in which all joints are where their offsets put them."""
    rotations = np.zeros((1, len(skeleton.joints), 4))
    rotations[..., 0] = 1.0
    return Poses(rotations, np.array([[skeleton.joints[joint].offset for joint in skeleton.positioned]]))


def names_of_legs(skeleton, poses=None):
    names = skeleton.names
    legs = find_legs(skeleton, poses or still(skeleton))
    return [(names[leg.hip], names[leg.knee], names[leg.ankle], names[leg.toes]) for leg in legs]


DEMO_LEGS = [(f"{side}UpLeg", f"{side}Leg", f"{side}Foot", f"{side}ToeBase") for side in ("Left", "Right")]


def renamed(skeleton, name):
    return Skeleton(tuple(replace(joint, name=name(index)) for index, joint in enumerate(skeleton.joints)))


def without(skeleton, beginnings):
    """Return a skeleton without the joints below those whose names begin so, and without these."""
    gone = {
        below
        for joint, name in enumerate(skeleton.names)
        if name.startswith(beginnings)
        for below in skeleton.subtree(joint)
    }
    kept = [joint for joint in range(len(skeleton.joints)) if joint not in gone]
    index = {old: new for new, old in enumerate([-1, *kept], start=-1)}
    return Skeleton(tuple(replace(skeleton.joints[old], parent=index[skeleton.joints[old].parent]) for old in kept))


def test_the_person_of_the_demo_library_has_two_legs():
    assert names_of_legs(human_skeleton()) == DEMO_LEGS


def test_legs_are_told_by_the_shape_of_the_tree_where_names_say_nothing():
    skeleton = human_skeleton()
    found = find_legs(renamed(skeleton, lambda index: f"joint{index}"), still(skeleton))
    assert found == find_legs(skeleton, still(skeleton))


def test_legs_are_told_by_the_names_of_the_feet_where_the_tree_is_not_a_humans():
    assert names_of_legs(without(human_skeleton(), ("LeftShoulder", "RightShoulder", "Neck"))) == DEMO_LEGS


@pytest.mark.parametrize("style", ["mixamorig:{}", "{}_01", "bip {}"])
def test_feet_are_known_by_a_part_of_their_names(style):
    skeleton = without(human_skeleton(), ("LeftShoulder", "RightShoulder", "Neck"))
    named = renamed(skeleton, lambda index: style.format(skeleton.names[index]).replace("Foot", "ANKLE"))
    assert len(find_legs(named, still(named))) == 2


def test_a_leg_may_end_at_its_ankle():
    assert names_of_legs(without(human_skeleton(), ("LeftToe", "RightToe"))) == [
        (*leg[:3], leg[2]) for leg in DEMO_LEGS
    ]


def test_a_body_without_knees_has_no_legs(small_library):
    assert find_legs(small_library.skeleton, small_library.poses("Stand")) == ()


def test_a_thigh_and_a_shin_are_of_about_one_length():
    rows = human_skeleton().joints
    longer = tuple(
        replace(joint, offset=tuple(3.0 * x for x in joint.offset))
        if joint.name in ("LeftFoot", "RightFoot")
        else joint
        for joint in rows
    )
    assert find_legs(Skeleton(longer), still(Skeleton(longer))) == ()


@pytest.mark.parametrize("joints", [(Joint("Foot", -1, (0.0, 0.0, 0.0), TURNS),), human_skeleton().joints[:5]])
def test_what_has_no_legs_has_none(joints):
    assert find_legs(Skeleton(joints), still(Skeleton(joints))) == ()


@pytest.mark.parametrize(
    ("clip", "expected"),
    [
        ("reference/*", "UpperLeg_{0} LowerLeg_{0} Foot_{0} Toes_{0}"),
        ("reference-6channel/*", "UpperLeg_{0} LowerLeg_{0} Foot_{0} Toes_{0}"),
        ("library/*dance*", "UpperLeg_{0} LowerLeg_{0} Foot_{0} Toes_{0}"),
        ("cmu-14/14_02*", "{1}UpLeg {1}Leg {1}Foot {1}ToeBase"),
        ("cmu-29/29_02*", "{1}UpLeg {1}Leg {1}Foot {1}ToeBase"),
        ("cmu-135/135_02*", "{1}UpLeg {1}Leg {1}Foot {1}ToeBase"),
    ],
)
def test_real_skeletons_have_two_legs_each(mocap, clip, expected):
    bvh = read(min(path for path in mocap.glob(clip) if path.suffix == ".bvh"))
    skeleton = skeleton_from_bvh(bvh)
    sides = [("L", "Left"), ("R", "Right")]
    legs = [tuple(expected.format(*side).split()) for side in sides]
    assert names_of_legs(skeleton, poses_from_bvh(bvh)[:20]) == legs
    nameless = renamed(skeleton, str)
    assert find_legs(nameless, poses_from_bvh(bvh)[:20]) == find_legs(skeleton, poses_from_bvh(bvh)[:20])
