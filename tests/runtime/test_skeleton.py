from collections.abc import Callable

import numpy as np
import pytest

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh import Bvh, Joint
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.rotations import normalized, rotate
from mlmg_runtime.skeleton import (
    Poses,
    Skeleton,
    carried_positions,
    has_positions,
    world_positions,
    world_transforms,
)

TURNS = ("Zrotation", "Xrotation", "Yrotation")
ALL = ("Xposition", "Yposition", "Zposition", *TURNS)


def skeleton(*joints: tuple[str, int, tuple[str, ...]]) -> Skeleton:
    return Skeleton(tuple(Joint(name, parent, (1.0, 2.0, 3.0), channels) for name, parent, channels in joints))


BODY = skeleton(
    ("Hips", -1, ALL),
    ("Spine", 0, TURNS),
    ("Arm_L", 1, TURNS),
    ("Hand_L", 2, TURNS),
    ("Arm_R", 1, ALL),
    ("Leg", 0, TURNS),
)


def test_the_tree_is_told_from_both_ends() -> None:
    assert BODY.names == ("Hips", "Spine", "Arm_L", "Hand_L", "Arm_R", "Leg")
    assert BODY.parents == (-1, 0, 1, 2, 1, 0)
    assert BODY.children == ((1, 5), (2, 4), (3,), (), (), ())


def test_a_subtree_holds_the_joint_and_all_below_it() -> None:
    assert BODY.subtree(1) == {1, 2, 3, 4}
    assert BODY.subtree(3) == {3}
    assert BODY.subtree(0) == set(range(6))


def test_the_root_carries_the_body() -> None:
    assert BODY.travel == 0
    assert BODY.body == tuple(range(6))
    assert BODY.positioned == (0, 4)


def test_below_a_standing_root_the_hips_carry_the_body() -> None:
    standing = skeleton(("root", -1, ALL), ("Hips", 0, ALL), ("Spine", 1, ALL), ("Leg", 1, ALL))
    assert standing.travel == 1
    assert standing.body == (1, 2, 3)
    assert standing.positioned == (1, 2, 3)


def test_a_root_without_position_channels_carries_the_body_all_the_same() -> None:
    fixed = skeleton(("root", -1, TURNS), ("Spine", 0, TURNS), ("Arm", 1, ALL))
    assert fixed.travel == 0
    assert fixed.positioned == (0, 2)


def test_one_position_channel_replaces_an_offset() -> None:
    assert has_positions(Joint("a", -1, (0.0, 0.0, 0.0), ("Xrotation", "Yposition")))
    assert not has_positions(Joint("a", -1, (0.0, 0.0, 0.0), TURNS))


@pytest.mark.parametrize("seed", range(8))
def test_joints_are_where_the_matrices_of_each_frame_put_them(
    seed: int, random_bvh: Callable[[int], Bvh], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = random_bvh(seed)
    positions = world_positions(skeleton_from_bvh(bvh), poses_from_bvh(bvh))
    np.testing.assert_allclose(positions, slow_positions(bvh), atol=1e-9)


def test_world_rotations_turn_what_is_fixed_to_a_joint(
    random_bvh: Callable[[int], Bvh], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = random_bvh(0)
    tool = (0.1, -0.7, 0.4)
    held = Bvh((*bvh.joints, Joint("tool", len(bvh.joints) - 1, tool, ())), bvh.frame_time_s, bvh.frames)
    rotation, position = world_transforms(skeleton_from_bvh(bvh), poses_from_bvh(bvh))
    expected = slow_positions(held)[:, -1]
    np.testing.assert_allclose(position[:, -1] + rotate(rotation[:, -1], np.array(tool)), expected, atol=1e-9)


def test_joints_above_the_travel_joint_stand_at_the_origin() -> None:
    standing = skeleton(("root", -1, ALL), ("Hips", 0, ALL), ("Spine", 1, TURNS), ("Leg", 1, TURNS))
    rotations = np.random.default_rng(0).normal(size=(2, 4, 4))
    place = np.array([[[4.0, 5.0, 6.0]], [[7.0, 8.0, 9.0]]])
    turned, positions = world_transforms(standing, Poses(rotations, place))
    np.testing.assert_array_equal(positions[:, :2], np.stack((np.zeros((2, 3)), place[:, 0]), axis=1))
    np.testing.assert_array_equal(turned[:, 0], [[1.0, 0.0, 0.0, 0.0]] * 2)


@pytest.mark.parametrize(("joints", "carriers"), [((1, 2, 3, 4), (0, 0, 0, 0)), ((3,), (2,)), ((3, 5), (2, 0))])
def test_a_part_is_seen_from_what_carries_it_however_that_moves(joints, carriers) -> None:
    draw = np.random.default_rng(0)
    pose = normalized(draw.normal(size=(1, 6, 4)))
    turned = np.repeat(pose, 8, axis=0)
    above = [joint for joint in range(6) if joint not in joints]
    turned[:, above] = normalized(draw.normal(size=(8, len(above), 4)))
    places = draw.normal(size=(8, 2, 3))
    places[:, 1] = places[0, 1]
    world = world_transforms(BODY, Poses(turned, places))
    found = carried_positions(BODY, *world, joints)
    np.testing.assert_allclose(found, np.repeat(found[:1], 8, axis=0), atol=1e-12)
    for column, (joint, carrier) in enumerate(zip(joints, carriers, strict=True)):
        apart = np.linalg.norm(world[1][:, joint] - world[1][:, carrier], axis=-1)
        np.testing.assert_allclose(np.linalg.norm(found[:, column], axis=-1), apart)


def test_poses_share_the_memory_of_their_parts() -> None:
    poses = Poses(np.zeros((5, 2, 4)), np.zeros((5, 1, 3)))
    part = poses[1:3]
    assert part.n_frames == 2
    assert np.shares_memory(part.rotations, poses.rotations)
    assert np.shares_memory(part.positions, poses.positions)
