"""What a script becomes when it is played: how long each statement lasts, and how the last one ends."""

from __future__ import annotations

from typing import Any

import pytest

import mlmg_lang
from mlmg_runtime.library import Library


def report_of(script: str, library: Library) -> dict[str, Any]:
    plan, diagnostics = mlmg_lang.compile(script, library)
    assert plan is not None, diagnostics
    return mlmg_lang.play(plan, library).report


def last_shown(report: dict[str, Any], graph: str = "Full-Body") -> tuple[str, int]:
    """Return the motion and the frame of its clip that a graph shows in the last frame of all."""
    entry = report["tracks"][graph][-1]
    assert (entry["kind"], entry["end"]) == ("clip", report["n_frames"])
    return entry["motion"], entry["clip_begin"] + entry["end"] - 1 - entry["begin"]


@pytest.mark.parametrize(
    ("before", "motion"), [("", "Walk_01"), ("Idle_01 for 1 sec", "Walk_01"), ("wait 10 sec", "Music_01")]
)
def test_the_last_command_plays_to_the_last_frame_of_its_clip(before: str, motion: str, demo_library: Library) -> None:
    report = report_of(f"{before}\n{motion}", demo_library)
    assert last_shown(report) == (motion, demo_library.n_frames(motion) - 1)


def test_it_is_the_topmost_named_motion_that_plays_to_its_end(demo_library: Library) -> None:
    both = report_of("Walk_01 with Upper-Body Talk_01", demo_library)
    assert last_shown(both) == ("Walk_01", demo_library.n_frames("Walk_01") - 1)
    part = report_of("Walk_01 for 1 sec\nUpper-Body Talk_01", demo_library)
    assert last_shown(part, "Upper-Body") == ("Talk_01", demo_library.n_frames("Talk_01") - 1)


def test_a_last_command_with_for_ends_when_its_time_is_over(demo_library: Library) -> None:
    report = report_of("Idle_01\nWalk_01 for 45 frames", demo_library)
    command = report["commands"][-1]
    assert report["n_frames"] == command["end"] == command["arrive"] + 45


def test_a_script_that_ends_in_a_wait_ends_with_it(demo_library: Library) -> None:
    report = report_of("Walk_01\nwait 45 frames", demo_library)
    assert (report["n_frames"], report["commands"][0]["end"]) == (45, 0)


def test_a_script_that_ends_in_an_end_ends_when_the_part_is_back(demo_library: Library) -> None:
    report = report_of("Walk_01 with Upper-Body Talk_01 for 1 sec\nend Upper-Body", demo_library)
    way_back = [entry for entry in report["tracks"]["Upper-Body"] if entry["end"] > report["commands"][0]["end"]]
    assert report["n_frames"] == way_back[-1]["end"]
    motion, frame = last_shown(report)
    assert frame < demo_library.n_frames(motion) - 1


def test_a_command_without_for_that_is_not_the_last_is_left_on_arrival(demo_library: Library) -> None:
    report = report_of("Idle_01\nWALK\nIdle_01 for 1 sec", demo_library)
    walk = report["commands"][1]
    assert walk["end"] == walk["arrive"] > walk["begin"]


@pytest.mark.parametrize("statement", ["Walk_01 for {}", "Walk_01\nwait {}"])
@pytest.mark.parametrize(
    ("amount", "n_frames"),
    # 30 frames a second; of two whole numbers equally near, the even one, as Python rounds.
    [("0.99 sec", 30), ("1.01 sec", 30), ("50 ms", 2), ("0.15 sec", 4), ("0.0833 sec", 2), ("2.6 frames", 3)],
)
def test_amounts_are_rounded_to_whole_frames(statement: str, amount: str, n_frames: int, demo_library: Library) -> None:
    assert report_of(statement.format(amount), demo_library)["n_frames"] == n_frames
