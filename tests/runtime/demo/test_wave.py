import numpy as np


def test_the_left_hand_is_raised_for_most_of_the_clip(clips) -> None:
    clip = clips["Wave_01"]
    assert np.mean(clip.at("LeftHand")[:, 1] > clip.at("LeftForeArm")[:, 1] + 10.0) > 0.5
    assert clip.at("LeftHand")[0, 1] < clip.at("LeftForeArm")[0, 1] > 0.0


def test_the_hand_waves_five_times(clips) -> None:
    clip = clips["Wave_01"]
    across = (clip.at("LeftHandMiddle") - clip.at("LeftHand"))[54:164, 0]
    tops = np.count_nonzero((across[1:-1] > across[:-2]) & (across[1:-1] >= across[2:]))
    assert tops == 5
    assert np.ptp(across) > 4.0


def test_nothing_but_the_left_arm_matters(clips) -> None:
    clip = clips["Wave_01"]
    for joint in ("Hips", "RightHand", "LeftFoot", "RightFoot"):
        assert np.ptp(clip.at(joint), axis=0).max() < 4.0, joint
    assert np.ptp(clip.at("LeftArm"), axis=0).max() < 4.0
    assert np.ptp(clip.at("LeftHand")[:, 1]) > 60.0
