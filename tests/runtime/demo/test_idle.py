import numpy as np


def test_the_hands_hang_in_the_first_idle(clips) -> None:
    clip = clips["Idle_01"]
    for side in ("Left", "Right"):
        assert np.all(clip.at(f"{side}Hand")[:, 1] < clip.at("Hips")[:, 1])


def test_the_first_idle_shifts_its_weight_and_looks_round(clips) -> None:
    clip = clips["Idle_01"]
    middle = 0.5 * (clip.at("LeftFoot") + clip.at("RightFoot"))
    off = (clip.at("Hips") - middle)[:, 0]
    assert off.max() > 2.0
    assert off.min() < -2.0
    turned = np.degrees(2.0 * np.arcsin(clip.rotations[:, clip.skeleton.names.index("Head"), 2]))
    assert turned.max() > 20.0
    assert turned.min() < -20.0


def test_the_chest_breathes(clips) -> None:
    clip = clips["Idle_01"]
    shoulders = (clip.at("LeftArm") + clip.at("RightArm") - 2.0 * clip.at("Chest"))[:, 1] / 2.0
    spectrum = np.abs(np.fft.rfft(shoulders - shoulders.mean(), 3000))
    assert 3.0 < 100.0 / int(spectrum.argmax()) < 5.0
    assert 0.2 < np.ptp(shoulders) < 3.0


def test_both_hands_are_beside_the_head_for_most_of_the_second_idle(clips) -> None:
    clip = clips["Idle_02"]
    raised = np.ones(len(clip.positions), dtype=bool)
    for side, outward in (("Left", 1.0), ("Right", -1.0)):
        hand = clip.at(f"{side}Hand") - clip.at("Neck")
        raised &= (hand[:, 1] > 0.0) & (outward * hand[:, 0] > 15.0)
    assert np.mean(raised) > 0.6
    assert not raised[0]
    assert not raised[-1]


def test_the_raised_hands_sway_and_come_back_to_where_they_were(clips) -> None:
    clip = clips["Idle_02"]
    hand = (clip.at("LeftHand") - clip.at("Neck"))[95:245]
    assert np.ptp(hand[:, 0]) > 4.0
    apart = [np.linalg.norm(hand[lag : lag + 70] - hand[:70], axis=-1).max() for lag in range(60, 80)]
    assert min(apart) < 5.0
