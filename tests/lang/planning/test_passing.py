"""Which commands are told to be left as soon as they are reached: those of which it is certain, and no others."""

from __future__ import annotations

from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source


def left(script: str, library: Any, start: str | None = None) -> list[tuple[int, str]]:
    """Return the line of each command that is told to be left at once, and the graph on which it is."""
    analysis = analyse(Source(script), library, start)
    hints = [one for one in analysis.diagnostics if one.code == "MS047"]
    return [(analysis.source.position(one.span.start)[0], one.message.split("`")[1]) for one in hints if one.span]


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("WALK\nIDLE", [(1, "Full-Body")]),
        ("WALK; IDLE; WALK", [(1, "Full-Body"), (1, "Full-Body")]),
        ("Upper-Body TALK\nUpper-Body SWING_HAND", [(1, "Upper-Body")]),
        ("WALK with Upper-Body TALK\nWALK with Upper-Body SWING_HAND", [(1, "Upper-Body")]),
        ("WALK with Upper-Body TALK\nIDLE", [(1, "Full-Body")]),
        ("Upper-Body TALK\nIDLE for 1 sec", [(1, "Upper-Body")]),
        ("Upper-Body TALK for 1 sec\nUpper-Body SWING_HAND\nUpper-Body TALK", [(2, "Upper-Body")]),
    ],
)
def test_a_command_is_left_at_once_if_the_next_changes_what_it_moved(
    script: str, expected: list[tuple[int, str]], reference: Any
) -> None:
    assert left(script, reference) == expected


@pytest.mark.parametrize(
    ("start", "script"),
    [
        (None, "WALK"),
        (None, "WALK for 1 sec\nIDLE"),
        (None, "WALK\nwait 1 sec\nIDLE"),
        (None, "Upper-Body TALK\nend Upper-Body"),
        (None, "WALK\nWALK with Upper-Body TALK for 1 sec"),
        (None, "Walk_01\nUpper-Body TALK"),
        (None, "WALK\nWalk_02 for 1 sec"),  # it may be in Walk_02 already
        (None, "TALK\nIDLE"),  # it may be in Talk_01, which is both
        (None, "Idle_01\nWALK"),  # it starts there
        (None, "IDLE\nWALK"),  # it starts in one
        ("Talk_01", "Talk_01 with Upper-Body IDLE\nWALK"),  # the part is satisfied by the motion above it
        (None, "WALK for 1 sec\nUpper-Body (SWING_HAND or WAVE_HAND)\nIDLE"),  # so is this
        (None, "WALK\nIDLE\nWLAK"),  # what a script with a mistake means is not certain
    ],
)
def test_nothing_is_said_where_it_is_not_certain(start: str | None, script: str, reference: Any) -> None:
    assert left(script, reference, start) == []


def test_a_first_line_is_left_at_once_if_the_character_is_told_to_start_elsewhere(reference: Any) -> None:
    assert left("Idle_01\nWALK", reference) == []
    assert left("Idle_01\nWALK", reference, start="Talk_02") == [(1, "Full-Body")]


def test_a_part_below_another_is_ended_with_it(left_hand: Any) -> None:
    assert left("Left-Hand Wave_01\nUpper-Body TALK", left_hand) == [(1, "Left-Hand")]
    assert left("WALK for 1 sec\nLeft-Hand Wave_01\nWALK", left_hand) == [(2, "Left-Hand")]


def test_parts_beside_each_other_do_not_end_each_other(hands: Any) -> None:
    assert left("Left-Hand WAVE\nRight-Hand POINT", hands) == []
