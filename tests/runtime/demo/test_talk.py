import numpy as np
import pytest


def lifted(clip, side: str) -> np.ndarray:
    """Return in which frames a hand is above the hips."""
    return clip.at(f"{side}Hand")[:, 1] > clip.at("Hips")[:, 1] + 5.0


def test_small_gestures_stay_before_the_body_and_below_the_shoulders(clips) -> None:
    clip = clips["Talk_01"]
    for side in ("Left", "Right"):
        hand, made = clip.at(f"{side}Hand"), lifted(clip, side)
        assert 60 < np.count_nonzero(made) < 220
        assert np.all(hand[made, 1] < clip.at("Neck")[made, 1])
        assert np.all(hand[made, 2] > clip.at("Chest")[made, 2] + 8.0)


def test_small_gestures_come_singly_and_the_hands_hang_in_between(clips) -> None:
    clip = clips["Talk_01"]
    made = lifted(clip, "Left") | lifted(clip, "Right")
    starts = np.count_nonzero(made[1:] & ~made[:-1])
    assert starts >= 3
    assert np.count_nonzero(lifted(clip, "Right") & ~lifted(clip, "Left")) > 20
    assert np.count_nonzero(lifted(clip, "Left") & ~lifted(clip, "Right")) > 20


def test_the_hands_are_high_for_most_of_the_second_talk_and_by_turns_higher(clips) -> None:
    clip = clips["Talk_02"]
    left, right = ((clip.at(f"{side}Hand") - clip.at("Neck"))[:, 1] for side in ("Left", "Right"))
    assert np.mean((left > 0.0) & (right > 0.0)) > 0.65
    assert np.count_nonzero(left > right + 10.0) > 60
    assert np.count_nonzero(right > left + 10.0) > 60


@pytest.mark.parametrize("name", ["Talk_01", "Talk_02"])
def test_a_talker_moves_the_head_more_than_one_who_stands(clips, name: str) -> None:
    def nodding(clip) -> float:
        turned = clip.rotations[:, clip.skeleton.names.index("Head")]
        return float(np.std(np.diff(turned[:, 1])))

    assert nodding(clips[name]) > 2.0 * nodding(clips["Idle_01"])
