from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime import bvh as bvh_files
from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh import Bvh, Joint
from mlmg_runtime.clips import bvh_from_poses, poses_from_bvh, resample, sample, skeleton_from_bvh
from mlmg_runtime.skeleton import Poses, world_positions

POSITIONS = ("Xposition", "Yposition", "Zposition")
TURNS = ("Zrotation", "Xrotation", "Yrotation")
FRAME_TIME_S = 1.0 / 30.0


def positions_of(bvh: Bvh, up: str = "y") -> FloatArray:
    return world_positions(skeleton_from_bvh(bvh), poses_from_bvh(bvh, up))


def standing(root_channels: tuple[str, ...], seed: int = 0) -> Bvh:
    """Return a body whose hips, with all channels, hang below a root that has an offset."""
    joints = (
        Joint("root", -1, (3.0, 4.0, 5.0), root_channels),
        Joint("Hips", 0, (0.0, 1.0, 0.0), (*POSITIONS, *TURNS)),
        Joint("Spine", 1, (0.0, 2.0, 0.5), TURNS),
        Joint("Leg", 1, (0.3, -1.0, 0.0), TURNS),
    )
    n_channels = sum(len(joint.channels) for joint in joints)
    return Bvh(joints, FRAME_TIME_S, np.random.default_rng(seed).normal(scale=40.0, size=(9, n_channels)))


STANDING_ROOTS = [(), TURNS, (*POSITIONS, *TURNS), ("Yposition",), ("Zposition", "Yrotation")]


@pytest.mark.parametrize("root_channels", STANDING_ROOTS)
def test_what_a_standing_root_does_is_done_by_the_hips(
    root_channels: tuple[str, ...], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = standing(root_channels)
    np.testing.assert_allclose(positions_of(bvh)[:, 1:], slow_positions(bvh)[:, 1:], atol=1e-9)


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("root_channels", STANDING_ROOTS)
def test_below_a_standing_root_the_body_is_written_where_it_is(
    root_channels: tuple[str, ...], up: str, slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = standing(root_channels)
    written = bvh_from_poses(skeleton_from_bvh(bvh), poses_from_bvh(bvh, up), FRAME_TIME_S, up)
    assert written.joints == bvh.joints
    np.testing.assert_allclose(slow_positions(written)[:, 1:], slow_positions(bvh)[:, 1:], atol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_poses_written_and_read_put_the_joints_in_the_same_places(
    seed: int, random_bvh: Callable[[int], Bvh], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = random_bvh(seed)
    written = bvh_from_poses(skeleton_from_bvh(bvh), poses_from_bvh(bvh), bvh.frame_time_s)
    assert written.joints == bvh.joints
    assert written.frame_time_s == bvh.frame_time_s
    np.testing.assert_allclose(slow_positions(written), slow_positions(bvh), atol=1e-9)


def test_of_a_z_up_file_up_becomes_y_and_the_ground_stays_right_handed(
    random_bvh: Callable[[int], Bvh], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = random_bvh(1)
    x, y, z = np.moveaxis(slow_positions(bvh), -1, 0)
    np.testing.assert_allclose(positions_of(bvh, up="z"), np.stack((x, z, -y), axis=-1), atol=1e-9)


def test_a_z_up_file_comes_back_z_up(
    random_bvh: Callable[[int], Bvh], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    bvh = random_bvh(1)
    written = bvh_from_poses(skeleton_from_bvh(bvh), poses_from_bvh(bvh, "z"), FRAME_TIME_S, "z")
    np.testing.assert_allclose(slow_positions(written), slow_positions(bvh), atol=1e-9)


def test_writing_poses_leaves_them_as_they_were(random_bvh: Callable[[int], Bvh]) -> None:
    bvh = random_bvh(1)
    poses = poses_from_bvh(bvh)
    before = poses.rotations.copy(), poses.positions.copy()
    bvh_from_poses(skeleton_from_bvh(bvh), poses, FRAME_TIME_S, "z")
    np.testing.assert_array_equal(poses.rotations, before[0])
    np.testing.assert_array_equal(poses.positions, before[1])


@pytest.mark.parametrize(
    ("channels", "expected"),
    [
        ((*POSITIONS, *TURNS), (*POSITIONS, *TURNS)),
        (TURNS, (*POSITIONS, *TURNS)),
        ((), (*POSITIONS, "Xrotation", "Yrotation", "Zrotation")),
        (
            ("Yposition", "Yrotation"),
            ("Xposition", "Zposition", "Yposition", "Yrotation", "Xrotation", "Zrotation"),
        ),
    ],
)
def test_the_travel_joint_can_go_and_turn_everywhere(
    channels: tuple[str, ...], expected: tuple[str, ...], slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    joints = (Joint("Hips", -1, (1.0, 2.0, 3.0), channels), Joint("Spine", 0, (0.0, 1.0, 0.0), TURNS))
    bvh = Bvh(joints, FRAME_TIME_S, np.random.default_rng(0).normal(size=(4, len(channels) + 3)))
    skeleton = skeleton_from_bvh(bvh)
    assert skeleton.joints[0].channels == expected
    poses = poses_from_bvh(bvh)
    turn = rotations.from_euler("YX", np.array([2.0, 0.3]))
    moved = Poses(poses.rotations.copy(), rotations.rotate(turn, poses.positions) + 7.0)
    moved.rotations[:, 0] = rotations.multiply(turn, moved.rotations[:, 0])
    written = slow_positions(bvh_from_poses(skeleton, moved, FRAME_TIME_S))
    np.testing.assert_allclose(written, rotations.rotate(turn, slow_positions(bvh)) + 7.0, atol=1e-9)


def test_written_angles_go_on_through_full_turns_and_through_the_singularity() -> None:
    joints = (Joint("Hips", -1, (0.0, 0.0, 0.0), (*POSITIONS, *TURNS)),)
    time = np.linspace(0.0, 1.0, 100)[:, None]
    frames = np.concatenate((0.0 * time + [0.0, 0.0, 0.0], [5.0, -80.0, 20.0] + time * [400.0, 190.0, -900.0]), 1)
    bvh = Bvh(joints, FRAME_TIME_S, frames)
    written = bvh_from_poses(skeleton_from_bvh(bvh), poses_from_bvh(bvh), FRAME_TIME_S)
    np.testing.assert_allclose(written.frames, frames, atol=1e-6)


def spinning(n_frames: int, rate: float) -> Poses:
    """Return poses that go 2 units and turn 3 radians a second, at an even pace."""
    time_s = np.arange(n_frames) / rate
    positions = np.stack((2.0 * time_s, 0.0 * time_s, 0.0 * time_s), axis=-1)[:, None]
    return Poses(rotations.about_axis("Y", 3.0 * time_s)[:, None], positions)


@pytest.mark.parametrize(("rate", "new_rate", "n_frames"), [(30, 60, 81), (30, 24, 33), (120, 30, 11), (30, 45, 61)])
def test_resampled_an_even_movement_keeps_its_pace(rate: float, new_rate: float, n_frames: int) -> None:
    result = resample(spinning(41, rate), rate, new_rate)
    expected = spinning(n_frames, new_rate)
    assert result.n_frames == n_frames
    np.testing.assert_allclose(result.positions, expected.positions, atol=1e-12)
    np.testing.assert_allclose(rotations.angle_between(result.rotations, expected.rotations), 0.0, atol=1e-12)


def test_a_quarter_of_the_frames_is_every_fourth_frame(random_bvh: Callable[[int], Bvh]) -> None:
    poses = poses_from_bvh(random_bvh(3))
    result = resample(poses, 120.0, 30.0)
    np.testing.assert_allclose(result.positions, poses.positions[::4], atol=1e-12)
    np.testing.assert_allclose(rotations.angle_between(result.rotations, poses.rotations[::4]), 0.0, atol=1e-12)


def test_nothing_is_resampled_to_its_own_rate_however_it_was_rounded() -> None:
    poses = spinning(10, 30.0)
    assert resample(poses, 1.0 / 0.0333333, 30.0) is poses


def test_one_frame_stays_one_frame() -> None:
    poses = spinning(1, 30.0)
    assert resample(poses, 30.0, 60.0).n_frames == 1
    np.testing.assert_allclose(sample(poses, np.array([0.0, 0.0])).positions, 0.0)


def test_the_last_frame_can_be_sampled() -> None:
    poses = spinning(5, 1.0)
    np.testing.assert_allclose(sample(poses, np.array([4.0, 3.5])).positions[:, 0, 0], [8.0, 7.0])


@pytest.mark.mocap
def test_a_clip_as_first_published_puts_the_shared_joints_where_the_cleaned_one_does(mocap: Path) -> None:
    cleaned_clips = sorted((mocap / "reference").glob("*.bvh"))
    assert cleaned_clips
    for path in cleaned_clips:
        cleaned, first = bvh_files.read(path), bvh_files.read(mocap / "reference-6channel" / path.name)
        first_names = [joint.name for joint in first.joints]
        at = [first_names.index(joint.name) for joint in cleaned.joints]
        difference = positions_of(cleaned) - positions_of(first)[:, at]
        assert np.abs(difference).max() < 2e-3, path.name


@pytest.mark.mocap
def test_a_real_clip_is_where_the_matrices_of_each_frame_put_it(
    mocap: Path, slow_positions: Callable[[Bvh], FloatArray]
) -> None:
    whole = bvh_files.read(mocap / "reference-6channel" / "Walk_01.bvh")
    bvh = replace(whole, frames=whole.frames[::40])
    np.testing.assert_allclose(positions_of(bvh)[:, 1:], slow_positions(bvh)[:, 1:], atol=1e-8)
