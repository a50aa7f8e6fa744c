from dataclasses import replace

import numpy as np
import pytest

from mlmg_runtime.view.mannequin import BODY_HEIGHT
from mlmg_runtime.view.scene import ball_centres, scene_from_bvh


def balls_of(scene):
    return [ball for capsule in scene.capsules for ball in (capsule.first, capsule.second)]


def capsule_ends(scene, frame=0):
    return ball_centres(scene.positions[frame], balls_of(scene)).reshape(-1, 2, 3)


def test_every_bone_of_a_limb_runs_inside_the_body(scene):
    centres = capsule_ends(scene)
    radii = np.array([ball.radius for ball in balls_of(scene)]).reshape(-1, 2)
    limbs = {joint for joint, name in enumerate(scene.joint_names) if name.startswith(("left", "right"))}
    for parent, child in scene.bones:
        if parent in limbs and child in limbs:
            middle = 0.5 * (scene.positions[0, parent] + scene.positions[0, child])
            share = np.linspace(0.0, 1.0, 21)[:, None, None]
            along = centres[:, 0] + share * (centres[:, 1] - centres[:, 0])
            thick = radii[:, 0] + share[..., 0] * (radii[:, 1] - radii[:, 0])
            assert (np.linalg.norm(along - middle, axis=-1) < thick).any(), scene.joint_names[child]


def test_limbs_taper_and_the_head_is_thicker_than_the_neck(scene):
    names = scene.joint_names

    def thickest(joint):
        mine = [capsule for capsule in scene.capsules if capsule.joint == names.index(joint)]
        return max(max(capsule.first.radius, capsule.second.radius) for capsule in mine)

    assert thickest("left thigh") > thickest("left shin") > thickest("left elbow") > 0.02
    assert thickest("head") > 1.5 * thickest("neck")


def test_the_crown_is_as_high_as_the_head_is(scene):
    top = max(
        centre[1] + ball.radius
        for centre, ball in zip(capsule_ends(scene).reshape(-1, 3), balls_of(scene), strict=True)
    )
    assert abs(top - scene.positions[0, :, 1].max()) < 0.02


def test_a_taller_body_is_as_much_thicker(person):
    bvh = person(unit=1.0)
    joints = tuple(
        replace(
            joint,
            offset=tuple(1.15 * part for part in joint.offset),
            end_site=joint.end_site and tuple(1.15 * part for part in joint.end_site),
        )
        for joint in bvh.joints
    )
    small = scene_from_bvh(bvh, "small")
    large = scene_from_bvh(type(bvh)(joints, bvh.frame_time_s, bvh.frames), "large")
    assert small.metres_per_unit == large.metres_per_unit == 1.0
    ratio = [b.radius / a.radius for a, b in zip(balls_of(small), balls_of(large), strict=True)]
    assert np.allclose(ratio, 1.15, atol=1e-6)


def test_any_tree_gets_a_capsule_a_bone(random_bvh):
    scene = scene_from_bvh(random_bvh(5), "a thing")
    assert len(scene.capsules) == len(scene.bones)
    assert all(ball.radius > 0.0 for ball in balls_of(scene))


def test_fingers_are_thinner_than_a_mitten(person):
    from mlmg_runtime.bvh import Bvh, Joint

    bvh = person()
    names = [joint.name for joint in bvh.joints]
    turns = ("Zrotation", "Xrotation", "Yrotation")
    fingers = []
    for at in range(5):
        fingers.append(
            Joint(f"finger {at}", names.index("left hand"), (9.0, 0.0, 2.0 * at - 4.0), turns, (7.0, 0.0, 0.0))
        )
    frames = np.hstack((bvh.frames, np.zeros((len(bvh.frames), 15))))
    scene = scene_from_bvh(Bvh((*bvh.joints, *fingers), bvh.frame_time_s, frames), "fingers")
    last = [capsule for capsule in scene.capsules if capsule.joint >= len(names)]
    assert len(last) == 5
    assert max(capsule.second.radius for capsule in last) < 0.012


@pytest.mark.mocap
def test_a_clip_s_figure_is_about_as_tall_as_people_are(mocap):
    from mlmg_runtime.bvh import read

    for clip in ("reference/Walk_01", "cmu-14/14_02", "cmu-29/29_01"):
        scene = scene_from_bvh(read(mocap / f"{clip}.bvh"), clip)
        assert 0.75 * BODY_HEIGHT < np.median(scene.positions[..., 1].max(axis=1)) < 1.15 * BODY_HEIGHT
