import numpy as np

from mlmg_runtime.anatomy import anatomy_from_points
from mlmg_runtime.bvh import Bvh
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.skeleton import world_transforms
from mlmg_runtime.view import landmarks
from mlmg_runtime.view.points import Points, points_from_transforms


def prepared(bvh):
    skeleton = skeleton_from_bvh(bvh)
    rotation, position = world_transforms(skeleton, poses_from_bvh(bvh))
    points = points_from_transforms(skeleton, rotation, position)
    return skeleton, points, anatomy_from_points(points, 0), rotation


def turned(bvh, degrees):
    frames = bvh.frames.copy()
    frames[:, 5] = degrees
    return Bvh(bvh.joints, bvh.frame_time_s, frames)


def test_a_body_faces_where_its_feet_point(person):
    _, points, anatomy, _ = prepared(person())
    assert np.allclose(landmarks.facing(points, anatomy), (0.0, 0.0, 1.0))


def test_facing_turns_with_the_body(person):
    _, points, anatomy, _ = prepared(turned(person(), 90.0))
    forward = landmarks.facing(points, anatomy)
    assert np.allclose(forward, (1.0, 0.0, 0.0))
    assert np.isclose(landmarks.heading_rad(forward), np.pi / 2)


def test_without_feet_a_body_faces_along_z():
    points = Points((-1,), np.zeros((4, 1, 3)), np.zeros(1))
    assert np.allclose(landmarks.facing(points, anatomy_from_points(points, 0)), (0.0, 0.0, 1.0))


def test_a_heel_is_behind_the_ankle_and_as_low_as_the_toes(person):
    skeleton, points, anatomy, rotation = prepared(person(unit=1.0))
    points, heels = landmarks.with_heels(points, anatomy, rotation, 0.05)
    ankle, toe = skeleton.names.index("left foot"), skeleton.names.index("left toe")
    heel = next(heel for heel in heels if points.parents[heel] == ankle)
    assert np.allclose(points.positions[:, heel] - points.positions[:, ankle], (0.0, -0.06, -0.05))
    assert np.allclose(points.positions[:, heel, 1], points.positions[:, toe, 1])


def test_a_heel_turns_with_a_lifted_foot(person):
    bvh = person(unit=1.0)
    ankle = [joint.name for joint in bvh.joints].index("left foot")
    frames = bvh.frames.copy()
    frames[40:, 3 + 3 * ankle + 1] = 90.0
    frames[40:, 1] += 0.3
    _, points, anatomy, rotation = prepared(Bvh(bvh.joints, bvh.frame_time_s, frames))
    points, heels = landmarks.with_heels(points, anatomy, rotation, 0.05)
    heel = next(heel for heel in heels if points.parents[heel] == ankle)
    assert np.allclose(points.positions[50, heel] - points.positions[50, ankle], (0.0, 0.05, -0.06))


def test_the_jaw_is_in_front_of_the_head(person):
    skeleton, points, anatomy, rotation = prepared(turned(person(unit=1.0), 90.0))
    forward = landmarks.facing(points, anatomy)
    points, jaw = landmarks.with_jaw(points, anatomy, rotation, forward=forward, share=0.5, depth=0.04)
    head = skeleton.names.index("head")
    assert np.allclose(points.positions[:, jaw] - points.positions[:, head], (0.04, 0.09, 0.0))
