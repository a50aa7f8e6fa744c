import numpy as np
import pytest

from mlmg_runtime.demo import curves
from mlmg_runtime.demo.body import HANGING, STRAIGHTEST_KNEE_DEG, Performance, arm, mixed, poses, trunk
from mlmg_runtime.demo.footwork import Footwork, StepPlan, footwork
from mlmg_runtime.demo.skeleton import LEFT, RIGHT, human_skeleton
from mlmg_runtime.skeleton import world_positions

SKELETON = human_skeleton()
TIMES = curves.frame_times(90)


def stepping() -> Footwork:
    plan = StepPlan()
    plan.shift(RIGHT, 1.0, 1.4, (-5.0, 40.0))
    plan.shift(LEFT, 1.5, 1.9, (0.0, 40.0))
    return footwork(TIMES, plan.steps)


def positions(feet: Footwork, **meant: np.ndarray) -> dict[str, np.ndarray]:
    still = {
        "trunk": trunk(nod=np.zeros(90)),
        "left": np.tile(HANGING, (90, 1)),
        "right": np.tile(HANGING, (90, 1)),
    }
    world = world_positions(SKELETON, poses(Performance(feet, **{**still, **meant})))
    return {name: world[:, index] for index, name in enumerate(SKELETON.names)}


def test_the_feet_are_where_the_footwork_has_them_whatever_the_pelvis_does() -> None:
    feet = stepping()
    for twist in (0.0, 12.0):
        world = positions(
            feet, trunk=trunk(pelvis_turn=np.full(90, twist), pelvis_list=-twist, pelvis_tilt=0.5 * twist)
        )
        np.testing.assert_allclose(world["LeftFoot"], feet.ankles[:, LEFT], atol=1e-9)
        np.testing.assert_allclose(world["RightFoot"], feet.ankles[:, RIGHT], atol=1e-9)


def test_no_leg_is_straighter_than_it_may_be() -> None:
    world = positions(stepping(), trunk=trunk(pelvis_list=6.0 * np.sin(4.0 * TIMES)))
    for side in ("Left", "Right"):
        thigh, shin = (world[f"{side}{a}"] - world[f"{side}{b}"] for a, b in (("UpLeg", "Leg"), ("Leg", "Foot")))
        cosine = np.sum(thigh * shin, axis=-1) / 43.0 / 42.0
        assert np.degrees(np.arccos(cosine)).min() > STRAIGHTEST_KNEE_DEG - 1e-6


def test_the_same_angles_make_mirror_images_of_both_arms() -> None:
    pose = np.tile(
        arm(flexion=30.0, abduction=70.0, outward=25.0, shrug=4.0, elbow=60.0, palm=20.0, wrist=9.0), (90, 1)
    )
    world = positions(footwork(TIMES, []), left=pose, right=pose)
    for joint in ("Arm", "ForeArm", "Hand", "HandIndex", "HandPinky"):
        np.testing.assert_allclose(world[f"Left{joint}"] * (-1.0, 1.0, 1.0), world[f"Right{joint}"], atol=1e-9)


@pytest.mark.parametrize(
    ("angles", "joint", "direction"),
    [
        ({"flexion": 90.0}, "ForeArm", (0.0, 0.0, 1.0)),
        ({"elbow": 90.0}, "Hand", (0.0, 0.0, 1.0)),
        ({"elbow": 90.0, "outward": 90.0}, "Hand", (1.0, 0.0, 0.0)),
        ({"wrist": 90.0}, "HandMiddle", (-1.0, 0.0, 0.0)),
        ({"wrist": 90.0, "palm": 90.0}, "HandMiddle", (0.0, 0.0, -1.0)),
        ({"thumbward": 90.0}, "HandMiddle", (0.0, 0.0, 1.0)),
    ],
)
def test_an_angle_of_the_left_arm_leads_where_its_name_says(angles, joint: str, direction) -> None:
    pose = np.tile(arm(**angles), (90, 1))
    world = positions(footwork(TIMES, []), left=pose)
    parent = SKELETON.names[SKELETON.parents[SKELETON.names.index(f"Left{joint}")]]
    moved = world[f"Left{joint}"][0] - world[parent][0]
    assert np.dot(moved / np.linalg.norm(moved), direction) > 0.98


@pytest.mark.parametrize(
    ("angles", "axis", "sign"),
    [({"bend": 20.0}, 2, 1.0), ({"lean": 15.0}, 0, 1.0), ({"pelvis_tilt": 10.0}, 2, 1.0)],
)
def test_an_angle_of_the_trunk_leads_where_its_name_says(angles, axis: int, sign: float) -> None:
    moved = [
        positions(footwork(TIMES, []), trunk=trunk(nod=np.zeros(90), **share))["Neck"][0] for share in ({}, angles)
    ]
    assert sign * (moved[1] - moved[0])[axis] > 3.0


def test_a_crouch_lowers_the_hips_and_nothing_slides() -> None:
    feet = footwork(TIMES, [])
    high, low = positions(feet), positions(feet, crouch_cm=np.full(90, 5.0))
    np.testing.assert_allclose(high["Hips"] - low["Hips"], np.tile([0.0, 5.0, 0.0], (90, 1)), atol=1e-9)
    np.testing.assert_allclose(high["LeftFoot"], low["LeftFoot"], atol=1e-9)


def test_angles_are_mixed_by_share() -> None:
    mix = mixed(HANGING, HANGING + arm(elbow=40.0), np.array([0.0, 0.25, 1.0]))
    np.testing.assert_allclose(mix - HANGING, arm(elbow=np.array([0.0, 10.0, 40.0])))


def test_an_unknown_angle_is_refused_by_name() -> None:
    with pytest.raises(TypeError, match="no such angle: knee; there are flexion"):
        arm(knee=3.0)
