"""Which frames `--frames` and `--fps` mean."""

import argparse

import pytest

from mlmg_lang.commands.console import UsageError
from mlmg_lang.commands.view_frames import at_most_fps, frames_at, parse_frames, thinned

STEP_S = 1 / 30


def part(text: str, n_frames: int = 100) -> range:
    return parse_frames(text).of("stroll", n_frames, STEP_S)


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("10:20", range(10, 20)),
        (":20", range(20)),
        ("90:", range(90, 100)),
        (":", range(100)),
        ("90:400", range(90, 100)),
        ("1s:2s", range(30, 60)),
        ("0.5s:70", range(15, 70)),
        ("10:1.06s", range(10, 32)),
    ],
)
def test_a_part_is_from_one_frame_or_second_up_to_another(text: str, frames: range) -> None:
    assert part(text) == frames


@pytest.mark.parametrize("text", ["7:7", "100:", "4s:", "20:10"])
def test_a_part_without_frames_is_told_with_the_extent_of_the_motion(text: str) -> None:
    with pytest.raises(UsageError, match=r"^no frame is chosen: stroll has the frames 0 to 99, 3\.33 s$"):
        part(text)


def test_moments_are_frames_or_seconds() -> None:
    assert frames_at(parse_frames("3,0,1s,2.5s"), "stroll", 100, STEP_S) == [3, 0, 30, 75]
    assert frames_at(parse_frames("1s,2s"), "stroll", 100, 0.033334) == [30, 60]
    with pytest.raises(UsageError, match=r"^frame 120: stroll has the frames 0 to 99, 3\.33 s$"):
        frames_at(parse_frames("3,4s"), "stroll", 100, STEP_S)


@pytest.mark.parametrize("text", ["a", "1-5", "1:2:3", "-3", "", "3.5", "nans", "infs", "-1s:", "s", "1m:2m"])
def test_what_is_not_understood_is_explained(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="found "):
        parse_frames(text)


@pytest.mark.parametrize(("fps", "step"), [(None, 1), (60, 1), (30, 1), (29, 2), (15, 2), (10, 3), (9.9, 4), (0.5, 60)])
def test_of_frames_too_many_a_second_every_second_third_or_so_is_taken(fps: float | None, step: int) -> None:
    assert at_most_fps(range(5, 95), fps, STEP_S) == range(5, 95, step)


def test_a_motion_that_is_too_long_is_thinned_while_it_stays_a_motion() -> None:
    assert thinned(range(1000), 1000, "x", STEP_S) == range(1000)
    assert thinned(range(1001), 1000, "x", STEP_S) == range(0, 1001, 2)
    assert thinned(range(0, 6000, 2), 1000, "x", 1 / 120) == range(0, 6000, 6)
    assert all(len(thinned(range(n), 1000, "x", 1 / 240)) <= 1000 for n in range(1, 9000, 7))


def test_one_that_would_be_no_motion_any_more_is_refused_with_what_to_ask_for_instead() -> None:
    with pytest.raises(UsageError) as caught:
        thinned(range(100, 1_000_100), 10_000, "day", STEP_S)
    message = str(caught.value)
    assert message == (
        "day is too long for one page: 1000000 frames, 9.3 h, where 10000 can be; "
        "--frames 100:10100 shows a part, --fps 0.3 all of it in fewer frames"
    )
    assert len(at_most_fps(range(100, 1_000_100), 0.3, STEP_S)) <= 10_000
    assert len(part("100:10100", 2_000_000)) == 10_000
