"""Why a command cannot be obeyed, and what is offered instead."""

from __future__ import annotations

from typing import Any

import pytest

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source


@pytest.fixture
def library(catalog: Any) -> Any:
    """Return a library in which all that sits, and one of those that stand, is not on the upper body."""
    full = {
        "Stand_1": ("STAND",),
        "Stand_2": ("STAND", "REST"),
        "Sit_1": ("SIT", "REST"),
        "Sit_2": ("SIT",),
        "Lie_1": (),
    }
    upper = {"Stand_1": (), "Wave_1": ("WAVE",)}
    return catalog({"Full-Body": full, "Upper-Body": upper}, {"Upper-Body": "Full-Body"}, start="Stand_1")


def told(script: str, library: Any) -> Diagnostic:
    (one,) = analyse(Source(script), library).diagnostics
    return one


def offered(script: str, library: Any) -> list[str]:
    one = told(script, library)
    return [script[: fix.span.start] + fix.replacement + script[fix.span.end :] for fix in one.fixes]


def test_a_tag_of_the_motion_in_the_way_is_offered_if_another_of_its_motions_is_free(library: Any) -> None:
    script = "Stand_2 with Upper-Body WAVE for 2 sec"
    assert offered(script, library) == ["STAND with Upper-Body WAVE for 2 sec"]
    assert told(script, library).help == "write `STAND`: of its motions `Stand_1` is on `Upper-Body`"


def test_it_is_offered_in_the_earlier_line_that_plays_that_motion(library: Any) -> None:
    assert offered("Stand_2 for 2 sec\nUpper-Body WAVE for 2 sec", library) == [
        "STAND for 2 sec\nUpper-Body WAVE for 2 sec"
    ]


@pytest.mark.parametrize("motion", ["Sit_1", "Lie_1", "SIT", "not STAND"])
def test_where_no_tag_helps_the_motions_are_told_during_which_it_can(motion: str, library: Any) -> None:
    one = told(f"Full-Body ({motion}) with Upper-Body WAVE for 2 sec", library)
    assert (one.code, one.fixes, one.help) == ("MS040", (), "it can during `Stand_1`")
