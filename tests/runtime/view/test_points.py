import numpy as np

from mlmg_runtime.bvh import Joint
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.skeleton import Skeleton, world_transforms
from mlmg_runtime.view.points import points_from_transforms

TURNS = ("Zrotation", "Xrotation", "Yrotation")


def points_of(bvh):
    skeleton = skeleton_from_bvh(bvh)
    return skeleton, points_from_transforms(skeleton, *world_transforms(skeleton, poses_from_bvh(bvh)))


def test_a_tip_stands_at_its_end_site(person):
    skeleton, points = points_of(person())
    toe = skeleton.names.index("left toe")
    tip = points.parents.index(toe)
    assert np.allclose(points.positions[:, tip] - points.positions[:, toe], (0.0, 0.0, 6.0))
    assert np.isclose(points.lengths[tip], 6.0)


def test_a_hand_without_end_site_goes_straight_on(person):
    skeleton, points = points_of(person())
    elbow, hand = skeleton.names.index("left elbow"), skeleton.names.index("left hand")
    tip = points.parents.index(hand)
    forearm = points.positions[:, hand] - points.positions[:, elbow]
    assert np.allclose(points.positions[:, tip] - points.positions[:, hand], 0.42 * forearm)


def test_a_tip_turns_with_its_joint(person):
    bvh = person()
    joint = [joint.name for joint in bvh.joints].index("left toe")
    frames = bvh.frames.copy()
    frames[:, 3 + 3 * joint + 1] = 90.0
    skeleton, points = points_of(type(bvh)(bvh.joints, bvh.frame_time_s, frames))
    toe = skeleton.names.index("left toe")
    tip = points.parents.index(toe)
    assert np.allclose(points.positions[:, tip] - points.positions[:, toe], (0.0, -6.0, 0.0))


def test_joints_above_the_travel_joint_are_where_it_is(person):
    bvh = person()
    channels = ("Xposition", "Yposition", "Zposition", *TURNS)
    below = tuple(Joint(j.name, j.parent + 1, j.offset, j.channels, j.end_site) for j in bvh.joints)
    standing = Joint("standing", -1, (0.0, 0.0, 0.0), channels)
    frames = np.hstack((np.zeros((len(bvh.frames), 6)), bvh.frames))
    skeleton, points = points_of(type(bvh)((standing, *below), bvh.frame_time_s, frames))
    assert skeleton.travel == 1
    assert np.array_equal(points.positions[:, 0], points.positions[:, 1])


def test_every_joint_without_children_has_one_tip(random_bvh):
    bvh = random_bvh(3)
    _, points = points_of(bvh)
    ends = [joint for joint, children in enumerate(Skeleton(bvh.joints).children) if not children]
    assert list(points.parents[len(bvh.joints) :]) == ends
    assert points.positions.shape == (len(bvh.frames), len(bvh.joints) + len(ends), 3)
