import numpy as np
import pytest

WALKS = ("Walk_01", "Walk_02", "Walk_03")


def steady(clip) -> slice:
    """Return the frames of the even middle part of a walk."""
    n_frames = len(clip.positions)
    return slice(int(0.38 * n_frames), int(0.66 * n_frames))


def cycle_frames(clip) -> int:
    """Return after how many frames the walk repeats: where the knees are most like themselves."""
    knees = np.stack([clip.knee_deg(side) for side in ("Left", "Right")], axis=-1)[steady(clip)]
    return min(range(24, 42), key=lambda lag: float(np.mean((knees[lag:] - knees[:-lag]) ** 2)))


def about_hips(clip) -> np.ndarray:
    return clip.positions - clip.at("Hips")[:, None] * (1.0, 0.0, 1.0)


@pytest.mark.parametrize(("name", "speed"), [("Walk_01", 1.25), ("Walk_02", 1.5), ("Walk_03", 1.15)])
def test_a_walk_goes_straight_ahead_at_its_speed(clips, name: str, speed: float) -> None:
    hips = clips[name].at("Hips")
    middle = hips[steady(clips[name])]
    assert (middle[-1, 2] - middle[0, 2]) / (len(middle) - 1) * 0.3 == pytest.approx(speed, rel=0.04)
    assert np.abs(hips[:, 0]).max() < 6.0


@pytest.mark.parametrize("name", WALKS)
def test_a_walk_begins_and_ends_standing(clips, name: str) -> None:
    speed = np.diff(clips[name].at("Hips")[:, 2])
    assert np.abs(speed[:10]).max() < 0.4 > np.abs(speed[-10:]).max()


@pytest.mark.parametrize("name", WALKS)
def test_the_knee_is_almost_straight_at_the_strike_and_bends_by_about_60_degrees_in_the_air(clips, name) -> None:
    clip = clips[name]
    for side in ("Left", "Right"):
        knee = clip.knee_deg(side)[steady(clip)]
        assert 55.0 < knee.max() < 72.0
        assert 3.0 < knee.min() < 15.0


@pytest.mark.parametrize("name", WALKS)
def test_a_foot_strikes_with_the_heel_and_leaves_from_the_toes(clips, name: str) -> None:
    clip = clips[name]
    for side in ("Left", "Right"):
        heel, ball = clip.heel(side)[steady(clip), 1], clip.at(f"{side}ToeBase")[steady(clip), 1] - 2.0
        strikes = np.flatnonzero((heel[1:] < 0.5) & (heel[:-1] >= 0.5)) + 1
        leaves = np.flatnonzero((ball[1:] >= 0.5) & (ball[:-1] < 0.5)) + 1
        assert min(len(strikes), len(leaves)) >= 2
        assert np.all(ball[strikes] > 2.0)
        assert np.all(heel[leaves] > 8.0)


@pytest.mark.parametrize("name", WALKS)
def test_the_hips_rise_and_fall_by_some_centimetres_twice_a_cycle(clips, name: str) -> None:
    clip = clips[name]
    height = clip.at("Hips")[steady(clip), 1]
    tops = np.flatnonzero((height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:]))
    assert 2.0 < np.ptp(height) < 6.5
    assert np.median(np.diff(tops)) == pytest.approx(0.5 * cycle_frames(clip), abs=1.5)


@pytest.mark.parametrize("name", WALKS)
def test_the_hips_sway_towards_the_standing_foot(clips, name: str) -> None:
    clip = clips[name]
    sway = clip.at("Hips")[steady(clip), 0]
    left_lower = (clip.at("RightFoot") - clip.at("LeftFoot"))[steady(clip), 1]
    assert 1.2 < np.ptp(sway) < 6.0
    assert np.corrcoef(sway, left_lower)[0, 1] > 0.5


@pytest.mark.parametrize("name", WALKS)
def test_the_right_arm_swings_with_the_left_leg(clips, name: str) -> None:
    placed = about_hips(clips[name])[steady(clips[name])]
    names = clips[name].skeleton.names
    hand, foot = placed[:, names.index("RightHand"), 2], placed[:, names.index("LeftFoot"), 2]
    assert np.corrcoef(hand, foot)[0, 1] > 0.75
    assert 20.0 < np.ptp(hand) < 75.0


@pytest.mark.parametrize("name", WALKS)
def test_the_head_is_steadier_than_the_hips(clips, name: str) -> None:
    turned = [clips[name].rotations[steady(clips[name]), joint, 2] for joint in (0, 4)]
    assert clips[name].skeleton.names[4] == "Head"
    assert np.ptp(turned[1]) < 0.6 * np.ptp(turned[0])


@pytest.mark.parametrize("name", WALKS)
def test_a_walk_loops_but_no_two_cycles_are_alike(clips, name: str) -> None:
    clip = clips[name]
    placed, lag = about_hips(clip)[steady(clip)], cycle_frames(clip)
    apart = np.sqrt(np.mean(np.sum((placed[lag:] - placed[:-lag]) ** 2, axis=-1), axis=-1))
    windows = np.sqrt(np.convolve(apart**2, np.full(20, 0.05), mode="valid"))
    assert 0.4 < windows.min() < 2.5


def test_the_left_hand_waves_above_the_head_in_the_third_walk(clips) -> None:
    clip = clips["Walk_03"]
    hand, head = clip.at("LeftHand"), clip.at("Head")
    assert np.count_nonzero(hand[:, 1] > head[:, 1] + 10.0) > 110
    across = (hand - clip.at("LeftForeArm"))[steady(clip), 0]
    turns = np.count_nonzero(np.diff(np.sign(np.diff(across))))
    assert 8 <= turns <= 14
    assert np.ptp(across) > 10.0
