"""How whole scripts go: loops, draws, durations, and the chances of what plays."""

from __future__ import annotations

from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.planning.estimate import Estimate, Moment, Playing, exactly, mixed, together
from mlmg_lang.planning.forecast import MAX_WORLDS, Forecast, Outcome, forecast
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source

ROOT = "Full-Body"


def foretold(text: str, library: Any, travel: Any) -> Forecast:
    resolved = analyse(Source(text), library).resolved
    assert resolved is not None
    return forecast(resolved, Names(library), travel)


def outcome(text: str, library: Any, travel: Any, marked: str) -> Outcome:
    """Return how the statement that begins with some words goes."""
    outcomes = foretold(text, library, travel).outcomes
    return next(one for span, one in outcomes.items() if text[span.start :].startswith(marked))


def motions(outcome: Outcome) -> dict[str, float]:
    """Return the chances of what the root may play before a statement."""
    chances: dict[str, float] = {}
    for world, chance in outcome.before.items():
        motion = world.running[0][1].motion
        chances[motion] = chances.get(motion, 0.0) + chance
    return {motion: pytest.approx(chance) for motion, chance in chances.items()}


def test_statements_take_their_time_one_after_the_other(reference, said):
    whole = foretold("Idle_01 for 2 sec\nWalk_01 for 3 sec\nwait 4 sec\nTalk_01 for 1 sec", reference, said()).whole
    assert whole.takes == exactly(2 + 1 + 3 + 4 + 1 + 1)
    assert whole.under_way == 2.0
    assert whole.rest == exactly(0.0)


def test_the_last_command_plays_to_its_last_frame(reference, said):
    whole = foretold("Walk_01", reference, said()).whole
    assert (whole.takes, whole.rest) == (exactly(0.0), exactly(7.0))


def test_the_last_command_of_a_loop_plays_to_its_last_frame_but_once(reference, said):
    whole = foretold("repeat 3 { Walk_01\nTalk_01 }", reference, said()).whole
    assert whole.rest == exactly(7.0)


def test_cycles_are_those_of_what_is_taken(reference, said):
    assert outcome("Walk_01 for 2 cycles\nIDLE", reference, said(), "Walk_01").lasts == exactly(20.0)


def test_waiting_counts_the_cycles_of_the_command_before(reference, said):
    class Cycles(said):
        def cycle(self, motion: str) -> Estimate:
            return exactly({"Idle_01": 3.0, "Talk_01": 4.0}[motion])

    script = "Idle_01 with Upper-Body Talk_01 for 1 sec\nwait 1 cycles\nUpper-Body Talk_01\nwait 1 cycles\nIdle_01"
    waits = [one.lasts.mean for one in foretold(script, reference, Cycles()).outcomes.values() if not one.courses]
    assert waits == [3.0, 4.0]


def test_a_branch_counts_by_its_weight(reference, said):
    script = "Idle_01\nchoose { 3: wait 4 sec | Walk_01 for 7 sec }\nTalk_02 for 1 sec"
    told = foretold(script, reference, said())
    assert told.whole.takes == Estimate(0.75 * 4 + 0.25 * 8 + 1 + 1, 4.0 + 2, 8.0 + 2)
    assert motions(outcome(script, reference, said(), "Talk_02")) == {"Idle_01": 0.75, "Walk_01": 0.25}


def test_a_branch_that_is_never_drawn_counts_for_nothing(reference, said):
    script = "Idle_01\nchoose { 0: wait 4 sec | wait 1 sec }\nTalk_02 for 1 sec"
    assert foretold(script, reference, said()).whole.takes == exactly(3.0)


def test_a_loop_begins_the_first_time_with_what_came_before_and_then_with_its_own_end(reference, said):
    script = "Idle_01\nrepeat 4 { Walk_01 for 1 sec\nTalk_01 for 1 sec }\nIdle_02 for 1 sec"
    assert motions(outcome(script, reference, said(), "Walk_01")) == {"Idle_01": 0.25, "Talk_01": 0.75}
    assert foretold(script, reference, said()).whole.takes == exactly(4 * 4 + 2)


def test_what_is_repeated_no_times_takes_no_time(reference, said):
    assert foretold("Idle_01\nrepeat 0 { Walk_01 }\nwait 2 sec", reference, said()).whole.takes == exactly(2.0)


def test_nothing_known_is_lost_while_time_passes_that_is_known(reference, said):
    script = "Idle_01 for 2 sec\nwait 3 sec\nWalk_01 for 1 sec"
    (world,) = outcome(script, reference, said(), "Walk_01").before
    assert world.get(ROOT) == Playing("Idle_01", Moment.FIRST, held_s=5.0)


def test_after_a_pass_a_motion_is_at_its_last_exit(reference, said):
    script = "Walk_01 once\nIdle_01 for 1 sec"
    (world,) = outcome(script, reference, said(), "Idle_01").before
    assert world.get(ROOT) == Playing("Walk_01", Moment.PASSED, held_s=0.0)


def test_the_end_of_a_part_takes_the_way_back_where_it_runs(reference, said):
    script = "Idle_01\nchoose { Upper-Body Talk_01 for 1 sec | wait 1 sec }\nend Upper-Body\nwait 1 sec"
    ended = outcome(script, reference, said(), "end")
    assert (ended.arrives.mean, ended.arrives.least, ended.arrives.most) == (0.25, 0.0, 0.5)


def test_only_the_likeliest_worlds_are_followed(catalog, said):
    tags = {f"M_{number}": ("ALL",) for number in range(200)}
    library = catalog({"Body": {"Idle_01": (), **tags}}, {})
    chances = {motion: 1.0 + number for number, motion in enumerate(tags)}
    told = outcome("Idle_01\nALL for 1 sec\nIdle_01 for 1 sec", library, said(chances=chances), "Idle_01 for")
    kept = {world.running[0][1].motion for world in told.before}
    assert kept == {f"M_{number}" for number in range(200 - MAX_WORLDS, 200)}
    assert sum(told.before.values()) == pytest.approx(1.0)


def test_of_several_things_at_once_the_longest_counts():
    assert together([Estimate(2.0, 1.0, 3.0), Estimate(1.5, 1.2, 9.0)]) == Estimate(2.0, 1.2, 9.0)


def test_of_one_thing_or_another_the_average_counts_and_the_extremes_of_both():
    assert mixed([(1.0, Estimate(2.0, 1.0, 3.0)), (3.0, Estimate(6.0, 5.0, 7.0))]) == Estimate(5.0, 1.0, 7.0)
    assert mixed([(1.0, exactly(2.0)), (0.0, exactly(50.0))]) == exactly(2.0)
