import tracemalloc

import numpy as np
import pytest

from mlmg_runtime.bvh import Bvh
from mlmg_runtime.view import scene as scenes
from mlmg_runtime.view.captions import story_from_report
from mlmg_runtime.view.mannequin import Ball
from mlmg_runtime.view.scene import ball_centres, metres_per_unit, scene_from_bvh


def test_joints_are_where_forward_kinematics_puts_them(person, slow_positions):
    bvh = person()
    scene = scene_from_bvh(bvh, "x")
    expected = 0.01 * slow_positions(bvh)
    shift = scene.positions[:, 0, 1] - expected[:, 0, 1]
    assert np.allclose(shift, shift[0], atol=1e-6)
    expected[..., 1] += shift[0]
    assert np.allclose(scene.positions[:, : len(bvh.joints)], expected, atol=1e-6)


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254, 0.001])
def test_the_unit_of_a_file_is_told_from_the_body(person, unit):
    scene = scene_from_bvh(person(unit), "x")
    assert scene.metres_per_unit == unit
    assert np.allclose(scene.positions, scene_from_bvh(person(1.0), "x").positions, atol=1e-5)


def test_a_body_that_no_unit_makes_plausible_is_made_1_7_m_tall():
    assert metres_per_unit(500.0) == pytest.approx(0.0034)


def test_the_body_stands_on_the_ground_wherever_the_file_has_it(person):
    low, high = (scene_from_bvh(person(height=height), "x") for height in (-3.0, 7.0))
    assert np.allclose(low.positions, high.positions, atol=1e-5)
    assert 0.0 < low.positions[..., 1].min() < 0.06


def test_a_z_up_file_gives_the_same_scene(person):
    bvh = person()
    frames = bvh.frames.copy()
    frames[:, :3] = frames[:, :3] * [1.0, -1.0, 1.0]
    frames[:, [1, 2]] = frames[:, [2, 1]]
    frames[:, 1] *= -1.0
    frames[:, 2] *= -1.0
    frames[:, 4] = 90.0
    z_up = Bvh(bvh.joints, bvh.frame_time_s, frames)
    assert np.allclose(scene_from_bvh(z_up, "x", up="z").positions, scene_from_bvh(bvh, "x").positions, atol=1e-4)


def test_positions_are_read_only(scene):
    with pytest.raises(ValueError, match="read-only"):
        scene.positions[0] = 0.0


def test_bones_join_joints_and_tips(scene):
    children = {child for _, child in scene.bones}
    assert len(children) == len(scene.bones)
    assert {scene.joint_names.index("left toe"), scene.joint_names.index("head")} <= children
    assert max(children) < scene.positions.shape[1] - 3


def test_joints_of_graphs_are_those_that_exist(scene):
    names = scene.joint_names
    assert scene.joints_of_graphs == {"Upper-Body": {names.index("chest"), names.index("left arm")}}


def test_a_ball_stands_between_its_points():
    positions = np.array([[[0.0, 0.0, 0.0], [4.0, 0.0, 8.0]]])
    assert np.allclose(ball_centres(positions, [Ball(0, 1, 0.25, 1.0)]), [[[1.0, 0.0, 2.0]]])


def test_one_frame_is_enough(person):
    assert scene_from_bvh(person(n_frames=1), "x").n_frames == 1


def test_a_long_motion_worked_out_in_pieces_is_the_same(person, monkeypatch):
    whole = scene_from_bvh(person(), "x")
    monkeypatch.setattr(scenes, "_FRAMES_AT_ONCE", 7)
    assert np.array_equal(scene_from_bvh(person(), "x").positions, whole.positions)


def test_some_frames_of_a_motion_are_what_they_are_in_the_whole(person, report):
    story = story_from_report(report)
    whole = scene_from_bvh(person(), "x", story=story)
    some = scene_from_bvh(person(), "x", story=story, frames=range(5, 50, 10))
    assert np.array_equal(some.positions, whole.positions[5:50:10])
    assert (some.n_frames, some.frame_time_s) == (5, pytest.approx(10 / 30))
    assert [some.time_s(frame) for frame in (0, 4)] == pytest.approx([5 / 30, 45 / 30])
    assert [command.text for command in some.story.commands] == ["WALK for 1 sec", "Sub TALK </script>"]
    assert (some.capsules, some.heading_rad) == (whole.capsules, whole.heading_rad)


def test_frames_from_all_over_a_long_motion_tell_the_ground_and_the_heading(person, monkeypatch):
    whole = scene_from_bvh(person(), "x")
    monkeypatch.setattr(scenes, "_SAMPLED_FRAMES", 10)
    sampled = scene_from_bvh(person(), "x")
    assert np.allclose(sampled.positions, whole.positions, atol=1e-5)
    assert sampled.heading_rad == pytest.approx(whole.heading_rad)


def test_the_memory_that_a_long_motion_takes_is_that_of_its_positions(person, monkeypatch):
    monkeypatch.setattr(scenes, "_SAMPLED_FRAMES", 50)
    monkeypatch.setattr(scenes, "_FRAMES_AT_ONCE", 50)
    bvh = person(n_frames=5000)
    tracemalloc.start()
    try:
        scene = scene_from_bvh(bvh, "x")
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 1.5 * scene.positions.nbytes
