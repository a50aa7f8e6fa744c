import numpy as np

BEAT_FRAMES = 18


def test_the_hips_fall_and_rise_once_a_beat(clips) -> None:
    height = clips["Music_01"].at("Hips")[60:384, 1]
    spectrum = np.abs(np.fft.rfft(height - height.mean()))
    assert len(height) / spectrum[1:].argmax().__add__(1) == BEAT_FRAMES
    assert np.ptp(height) > 3.0


def test_the_feet_land_on_the_beat(clips) -> None:
    clip = clips["Music_01"]
    for side in ("Left", "Right"):
        still = np.linalg.norm(np.diff(clip.at(f"{side}Foot")[:, [0, 2]], axis=0), axis=-1) < 0.05
        lands = np.flatnonzero(still[1:] & ~still[:-1]) + 1
        assert len(lands) >= 10
        off_beat = (lands - 45 + BEAT_FRAMES // 2) % BEAT_FRAMES - BEAT_FRAMES // 2
        assert np.abs(off_beat).max() <= 2


def test_the_dance_stays_on_the_spot(clips) -> None:
    hips = clips["Music_01"].at("Hips")[:, [0, 2]]
    assert np.linalg.norm(hips - hips[0], axis=-1).max() < 45.0


def test_the_hips_sway_from_side_to_side(clips) -> None:
    assert np.ptp(clips["Music_01"].at("Hips")[60:384, 0]) > 10.0


def test_the_arms_go_up_in_every_second_bar(clips) -> None:
    clip = clips["Music_01"]
    for side in ("Left", "Right"):
        up = clip.at(f"{side}Hand")[:, 1] > clip.at("Head")[:, 1]
        assert np.count_nonzero(up[1:] & ~up[:-1]) == 2
        assert 80 < np.count_nonzero(up) < 200


def test_the_dance_repeats_after_two_bars(clips) -> None:
    clip = clips["Music_01"]
    placed = clip.positions - clip.at("Hips")[:, None] * (1.0, 0.0, 1.0)
    first, again = placed[80:200], placed[80 + 8 * BEAT_FRAMES : 200 + 8 * BEAT_FRAMES]
    apart = np.sqrt(np.mean(np.sum((first - again) ** 2, axis=-1)))
    assert 0.2 < apart < 2.5
