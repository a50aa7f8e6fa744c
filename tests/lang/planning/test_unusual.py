"""Combinations that may look unnatural: where a warning is due, and where not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source

FAR = {
    **{("Upper-Body", f"Walk_0{n}", "Talk_02"): 2.6 for n in (1, 2, 3)},
    ("Upper-Body", "Walk_02", "Talk_01"): 2.6,
    ("Upper-Body", "Walk_03", "Talk_01"): 2.5,
}


@pytest.fixture
def told(reference: Any) -> Callable[[str], list[str]]:
    """Return a function: a script -> what is said of unnatural looks."""
    library = replace(reference, far=FAR)

    def ask(script: str) -> list[str]:
        analysis = analyse(Source(script), library)
        assert analysis.resolved is not None, analysis.diagnostics
        return [one.message for one in analysis.diagnostics if one.code == "MS061"]

    return ask


@pytest.mark.parametrize(
    ("script", "times"),
    [
        ("Walk_01 with Upper-Body Talk_02 for 5 sec", 1),
        ("WALK with Upper-Body Talk_02 for 5 sec", 1),
        ("WALK with Upper-Body TALK for 5 sec", 0),
        ("Walk_02 with Upper-Body TALK for 5 sec", 1),
        ("Walk_03 with Upper-Body TALK for 5 sec", 0),
        ("Walk_02 for 5 sec\nUpper-Body TALK for 5 sec", 1),
        ("Walk_01 for 5 sec\nUpper-Body TALK for 5 sec", 0),
        ("Idle_01 for 5 sec\nUpper-Body Talk_02 for 5 sec", 0),
        ("repeat 2 { choose { Walk_02 with Upper-Body TALK for 5 sec | IDLE for 1 sec } }", 1),
        ("Walk_02 for 5 sec", 0),
    ],
)
def test_it_is_told_where_even_the_best_fit_is_far(script: str, times: int, told: Callable[[str], list[str]]) -> None:
    assert len(told(script)) == times


def test_it_says_what_does_not_fit_what_and_how_far_it_is(told: Callable[[str], list[str]]) -> None:
    (message,) = told("Walk_02 with Upper-Body TALK for 5 sec")
    assert message == (
        "this may look unnatural: `Talk_01` and `Talk_02` on `Upper-Body` do not fit `Walk_02`, "
        "2.6 times as far apart as is usual"
    )


def test_of_a_clip_that_is_too_short_to_be_compared_nothing_is_told(reference: Any) -> None:
    far = {("Upper-Body", motion, "Talk_02"): float("inf") for motion in reference.on["Full-Body"]}
    analysis = analyse(Source("Walk_01 with Upper-Body Talk_02 for 5 sec"), replace(reference, far=far))
    assert analysis.diagnostics == ()


def test_where_no_other_motion_is_left_none_is_said_to_fit_best(reference: Any, catalog: Any) -> None:
    names = {"Walk_01": (), "Talk_02": ()}
    far = {("Arm", one, other): 3.0 for one in names for other in names}
    library = catalog({"Body": names, "Arm": names}, {"Arm": "Body"}, start="Walk_01", far=far)
    script = "choose { Walk_01 for 1 sec | Talk_02 for 1 sec }\nArm Talk_02 for 5 sec"
    (told,) = [one for one in analyse(Source(script), library).diagnostics if one.code == "MS061"]
    assert told.help is None
