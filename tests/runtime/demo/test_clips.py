import numpy as np
import pytest

from mlmg_runtime.bvh import read
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.demo.clips import demo_clips
from mlmg_runtime.skeleton import world_positions

NAMES = ["Idle_01", "Idle_02", "Walk_01", "Walk_02", "Walk_03", "Music_01", "Talk_01", "Talk_02", "Wave_01"]
BACK_TO_NEUTRAL = {"Idle_01", "Talk_01", "Wave_01"}
FEET = ("LeftFoot", "LeftToeBase", "RightFoot", "RightToeBase")
WINDOW = 20


def largest_step(point: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(point, axis=0), axis=-1).max())


def stance(clip, frame: int) -> np.ndarray:
    """Return the feet about their middle, shape (4, 3)."""
    feet = np.stack([clip.at(joint)[frame] for joint in FEET])
    return feet - feet.mean(axis=0)


def window_apart(a, begin_a: int, b, begin_b: int) -> float:
    """Return the root mean square distance, cm, of the joints of two windows, both about their feet."""
    windows = []
    for clip, begin in ((a, begin_a), (b, begin_b)):
        window = clip.positions[begin : begin + WINDOW]
        middle = np.mean([clip.at(joint)[begin : begin + WINDOW].mean(axis=0) for joint in FEET], axis=0)
        windows.append(window - middle)
    return float(np.sqrt(np.mean(np.sum((windows[0] - windows[1]) ** 2, axis=-1))))


def test_the_library_has_the_names_of_the_reference_library_and_a_wave() -> None:
    assert list(demo_clips()) == NAMES


def test_the_library_is_about_3000_frames_at_30_a_second() -> None:
    made = demo_clips().values()
    assert 2_700 < sum(len(bvh.frames) for bvh in made) < 3_300
    assert {bvh.frame_time_s for bvh in made} == {1.0 / 30.0}


def test_all_clips_have_the_same_skeleton() -> None:
    assert len({bvh.joints for bvh in demo_clips().values()}) == 1


def test_the_clips_are_the_same_to_the_byte_on_every_call() -> None:
    first, again = ([bvh.frames.tobytes() for bvh in demo_clips().values()] for _ in range(2))
    assert first == again


def test_every_number_is_finite_and_no_channel_wraps() -> None:
    for name, bvh in demo_clips().items():
        assert np.all(np.isfinite(bvh.frames)), name
        turns = bvh.frames[:, 3:]
        assert np.abs(np.diff(turns, axis=0)).max() < 60.0, name


def test_a_person_stands_upright_at_the_origin_and_looks_along_z_at_the_start(clips) -> None:
    for name, clip in clips.items():
        assert np.hypot(*clip.at("Hips")[0, [0, 2]]) < 5.0, name
        assert 165.0 < clip.at("Head")[0, 1] + 17.0 < 175.0, name
        across = clip.at("LeftArm")[0] - clip.at("RightArm")[0]
        assert across[0] > 30.0, name
        assert clip.at("LeftToeBase")[0, 2] > clip.at("LeftFoot")[0, 2] + 10.0, name


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_a_planted_foot_slides_by_less_than_a_centimetre(clips, plants, side: str) -> None:
    for name, clip in clips.items():
        found = [*plants(clip.heel(side), 0.5), *plants(clip.at(f"{side}ToeBase"), 2.5)]
        assert found, name
        for path in found:
            slid = np.linalg.norm((path - np.median(path, axis=0))[:, [0, 2]], axis=-1)
            assert slid.max() < 0.5, name


def test_one_foot_at_least_is_always_planted(clips) -> None:
    for name, clip in clips.items():
        low = [(clip.heel(side)[:, 1] < 0.5) | (clip.at(f"{side}ToeBase")[:, 1] < 2.5) for side in ("Left", "Right")]
        assert np.all(low[0] | low[1]), name


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_nothing_is_under_the_ground(clips, side: str) -> None:
    for name, clip in clips.items():
        assert clip.positions[..., 1].min() > 1.99, name
        assert clip.heel(side)[:, 1].min() > -0.01, name


def test_no_joint_jumps(clips) -> None:
    """At 30 frames a second, real walks reach 48 m/s^2 at the feet, 72 at the hands of a brisk one."""
    for name, clip in clips.items():
        acceleration = np.linalg.norm(np.diff(clip.positions, 2, axis=0), axis=-1) * 30.0**2 / 100.0
        assert acceleration.max() < 70.0, name
        assert acceleration[:, 0].max() < 12.0, name


def test_the_arms_stay_outside_the_trunk_and_the_thighs(clips) -> None:
    for name, clip in clips.items():
        for side in ("Left", "Right"):
            outward = clip.at(f"{side}Arm") - clip.at("Chest")
            for joint in ("ForeArm", "Hand"):
                off = clip.at(f"{side}{joint}") - clip.at("Hips")
                beside = off[:, 0] * np.sign(outward[:, 0])
                level = np.abs(off[:, 1]) < 25.0
                assert np.all((beside > 14.0) | (np.abs(off[:, 2]) > 10.0) | ~level), (name, joint)


def test_all_clips_begin_in_the_same_stance_and_hold_it_for_a_window(clips) -> None:
    for name, clip in clips.items():
        np.testing.assert_allclose(stance(clip, 0), stance(clips["Idle_01"], 0), atol=1e-9, err_msg=name)
        assert window_apart(clip, 0, clips["Idle_01"], 0) < 2.7, name
        for joint in FEET:
            assert largest_step(clip.at(joint)[:WINDOW]) < 1e-9, name


def test_clips_about_standing_end_as_they_begin(clips) -> None:
    for name in BACK_TO_NEUTRAL:
        clip = clips[name]
        np.testing.assert_allclose(stance(clip, -1), stance(clip, 0), atol=1e-9, err_msg=name)
        assert window_apart(clip, len(clip.positions) - WINDOW, clip, 0) < 2.2, name


def test_other_clips_end_in_a_stance_that_standing_clips_pass_through_and_hold(clips) -> None:
    for name in set(NAMES) - BACK_TO_NEUTRAL:
        clip = clips[name]
        end = len(clip.positions) - WINDOW
        assert window_apart(clip, end, clip, 0) > 3.0, name
        for other in ("Idle_01", "Talk_01"):
            begins = range(len(clips[other].positions) - WINDOW)
            assert min(window_apart(clip, end, clips[other], begin) for begin in begins) < 2.2, (name, other)


def test_no_end_is_still_for_so_long_that_a_person_could_freeze_in_it(clips) -> None:
    """Two windows in a row of nothing would let a motion graph stay in them for good."""
    for name, clip in clips.items():
        last = clip.positions[-2 * WINDOW :]
        assert np.linalg.norm(last - last[-1], axis=-1).max() > 1.5, name


def test_the_feet_of_each_clip_but_the_wave_move_both(clips) -> None:
    """A blend of two clips whose feet never move could not but slide them."""
    for name in set(NAMES) - {"Wave_01"}:
        assert min(largest_step(clips[name].at(joint)) for joint in FEET) > 0.8, name


@pytest.mark.mocap
def test_the_motions_are_about_as_quick_as_real_ones(mocap, clips) -> None:
    joints = {
        "Hips": "Hips",
        "Head": "Head",
        "LeftHand": "Hand_L",
        "LeftFoot": "Foot_L",
        "LeftToeBase": "Toes_L",
    }
    for name in ("Walk_01", "Walk_02", "Walk_03"):
        bvh = read(mocap / "reference" / f"{name}.bvh")
        skeleton = skeleton_from_bvh(bvh)
        real = world_positions(skeleton, poses_from_bvh(bvh))
        for ours, theirs in joints.items():
            ratio = largest_step(clips[name].at(ours)) / largest_step(real[:, skeleton.names.index(theirs)])
            assert 0.55 < ratio < 1.4, (name, ours)
