import numpy as np
import pytest

from mlmg_runtime.anatomy import anatomy_from_points, upper_joint
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.skeleton import world_transforms
from mlmg_runtime.view.points import Points, points_from_transforms


def tree(rows):
    """Return points that stand still from (name, parent's name, distance from it), and the names."""
    names = [name for name, _, _ in rows]
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _ in rows)
    return Points(parents, np.zeros((1, len(rows), 3)), np.array([float(d) for _, _, d in rows])), names


def named(anatomy, names):
    return {
        "trunk": [names[point] for point in anatomy.trunk],
        "legs": sorted(names[leg[0]] for leg in anatomy.legs),
        "arms": sorted(names[arm[0]] for arm in anatomy.arms),
        "head": [names[point] for point in anatomy.head],
    }


def limb(name, above, *lengths):
    rows, parent = [], above
    for index, length in enumerate(lengths):
        rows.append((f"{name}{index}", parent, length))
        parent = f"{name}{index}"
    return rows


ARMS = [*limb("l", "chest", 15, 30, 25, 9), *limb("r", "chest", 15, 30, 25, 9)]
LEGS = [*limb("p", "hips", 10, 42, 40, 13, 6), *limb("q", "hips", 10, 42, 40, 13, 6)]
TRUNK = [("hips", None, 0), ("spine", "hips", 15), ("chest", "spine", 20)]
HEAD = limb("head", "chest", 20, 10, 15)


def test_a_person_forks_at_hips_and_chest():
    points, names = tree([*TRUNK, *LEGS, *HEAD, *ARMS])
    anatomy = anatomy_from_points(points, 0)
    assert anatomy.is_human
    assert named(anatomy, names) == {
        "trunk": ["hips", "spine", "chest"],
        "legs": ["p0", "q0"],
        "arms": ["l0", "r0"],
        "head": ["head0", "head1", "head2"],
    }


def test_legs_may_hang_from_a_pelvis_bone_or_from_the_spine():
    pelvis = [("hips", None, 0), ("pelvis", "hips", 5), ("spine", "hips", 15), ("chest", "spine", 20)]
    legs = [*limb("p", "pelvis", 10, 42, 40, 13), *limb("q", "pelvis", 10, 42, 40, 13)]
    points, names = tree([*pelvis, *legs, *HEAD, *ARMS])
    assert named(anatomy_from_points(points, 0), names)["legs"] == ["p0", "q0"]
    biped = [("root", None, 0), ("hips", "root", 9), ("spine", "hips", 15), ("chest", "spine", 20)]
    points, names = tree([*biped, *LEGS, *HEAD, *ARMS])
    anatomy = anatomy_from_points(points, 0)
    assert names[anatomy.hips] == "hips"
    assert named(anatomy, names)["legs"] == ["p0", "q0"]


def test_fingers_a_tail_and_a_breast_pocket_are_no_limbs():
    fingers = [row for side in "lr" for at in range(5) for row in limb(f"{side}finger{at}", f"{side}3", 3, 2)]
    extras = [*limb("tail", "hips", 5, 5), *limb("pocket", "spine", 4)]
    points, names = tree([*TRUNK, *LEGS, *HEAD, *ARMS, *fingers, *extras])
    found = named(anatomy_from_points(points, 0), names)
    assert found["legs"] == ["p0", "q0"]
    assert found["arms"] == ["l0", "r0"]
    assert found["trunk"] == ["hips", "spine", "chest"]


@pytest.mark.parametrize("rows", [limb("snake", None, 0, 5, 5, 5), [*TRUNK, *LEGS], [("point", None, 0)]])
def test_what_has_not_two_legs_two_arms_and_a_head_is_not_human(rows):
    points, _ = tree(rows)
    assert not anatomy_from_points(points, 0).is_human


def test_reach_is_the_longest_way_to_a_tip():
    points, names = tree([*TRUNK, *LEGS, *HEAD, *ARMS])
    reach = anatomy_from_points(points, 0).reach
    assert reach[names.index("chest")] == 15 + 30 + 25 + 9
    assert reach[names.index("p4")] == 0


def test_the_upper_arm_begins_after_the_collar_bone():
    points, names = tree([*TRUNK, *LEGS, *HEAD, *ARMS])
    anatomy = anatomy_from_points(points, 0)
    assert [names[upper_joint(limb, points)] for limb in (*anatomy.arms, *anatomy.legs)] == ["l0", "r0", "p0", "q0"]


@pytest.mark.mocap
@pytest.mark.parametrize("clip", ["reference/Walk_01", "reference-6channel/Talk_01", "cmu-14/14_02", "cmu-135/135_02"])
def test_real_skeletons_are_human(mocap, clip):
    from mlmg_runtime.bvh import read

    bvh = read(mocap / f"{clip}.bvh")
    skeleton = skeleton_from_bvh(bvh)
    points = points_from_transforms(skeleton, *world_transforms(skeleton, poses_from_bvh(bvh)[:50]))
    anatomy = anatomy_from_points(points, skeleton.travel)
    assert anatomy.is_human
    assert skeleton.names[anatomy.hips] == "Hips"
    assert all("Leg" in skeleton.names[upper_joint(leg, points)] for leg in anatomy.legs)
    assert all("Arm" in skeleton.names[upper_joint(arm, points)] for arm in anatomy.arms)
    assert skeleton.names[anatomy.head[-2]] == "Head"
