"""Planning over a whole script: held against trying all combinations of candidates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.front_end import analyse
from mlmg_lang.planning.ahead import narrowings, plan_ahead
from mlmg_lang.planning.estimate import Travel
from mlmg_lang.planning.forecast import forecast
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Command, ResolvedPlan
from mlmg_lang.source import Source

COMMANDS = (
    *("WALK for 1 sec", "IDLE", "TALK", "WALK with Upper-Body TALK", "IDLE for 2 sec", "Music or WALK once"),
    *("wait 1 sec", "wait 1 cycles", "end Upper-Body", "Upper-Body TALK", "SWING_HAND"),
)


def resolved(text: str, library: Any) -> ResolvedPlan:
    plan = analyse(Source(text), library).resolved
    assert plan is not None
    return plan


def combinations(plan: ResolvedPlan, names: Names) -> Iterator[ResolvedPlan]:
    """Yield a plan with every combination of root candidates."""
    options = [
        [narrowed for _, narrowed in narrowings(one, names)] if isinstance(one, Command) else [one]
        for one in plan.statements
    ]
    for statements in product(*options):
        yield replace(plan, statements=tuple(statements), ahead=True)


def price(plan: ResolvedPlan, names: Names, travel: Travel) -> float:
    """Return the seconds on the way and the costs of a plan; infinite, if it may not be possible."""
    told = forecast(plan, names, travel)
    sure = all(told.outcomes[one.span].courses for one in plan.statements if isinstance(one, Command))
    return told.whole.under_way + told.whole.cost if sure else float("inf")


def check(plan: ResolvedPlan, library: Any, travel: Travel) -> None:
    names = Names(library)
    ahead = plan_ahead(plan, names, travel)
    best = min(price(one, names, travel) for one in combinations(plan, names))
    if best == float("inf"):
        assert (ahead.planned, ahead.plan) == (False, plan)
        return
    assert ahead.planned
    assert ahead.price == pytest.approx(best)
    assert price(ahead.plan, names, travel) == pytest.approx(best)
    assert ahead.plan in list(combinations(plan, names))


@given(data=st.data(), commands=st.lists(st.sampled_from(COMMANDS), min_size=1, max_size=4))
def test_no_combination_of_candidates_is_cheaper(data, commands, left_hand_always, said_always):
    library = left_hand_always
    analysis = analyse(Source("Idle_01\n" + "\n".join(commands)), library)
    if analysis.resolved is None:
        return
    motions = library.motions("Full-Body")
    times = st.sampled_from([1.0, 2.0, 3.0, 5.0, None])
    takes = {(a, b): data.draw(times) for a in motions for b in motions} if data.draw(st.booleans()) else {}
    costs = {(a, b): data.draw(st.sampled_from([0.0, 0.5, 1.5])) for a in motions for b in motions}
    check(analysis.resolved, library, said_always(takes, costs=costs))


@pytest.mark.parametrize(
    "script",
    [
        "Idle_01 for 2 sec\nWALK for 2 sec\nIDLE for 2 sec\nWALK with Upper-Body TALK for 2 sec",
        "Idle_01\nWALK\nTALK\nIDLE\nwait 1 cycles\nWALK for 1 sec",
        "Idle_01\nUpper-Body Music\nwait 2.5 cycles\nMusic or WALK for 1 sec\nIDLE",
        "Talk_01 once\nIDLE with Left-Hand WAVE for 3 sec\nend Left-Hand\nWALK and TALK for 2 sec",
    ],
)
def test_on_the_demo_library_no_combination_of_candidates_is_cheaper(script, demo_library):
    check(resolved(script, demo_library), demo_library, MotionTravel(demo_library))


def test_a_way_that_is_longer_at_first_is_taken_where_it_is_shorter_in_all(reference, said):
    near_trap = {("Idle_01", "Walk_01"): 1.0, ("Idle_01", "Walk_02"): 2.0, ("Idle_01", "Walk_03"): 2.5}
    onward = {("Walk_01", "Talk_02"): 9.0, ("Walk_02", "Talk_02"): 1.0, ("Walk_03", "Talk_02"): 1.0}
    plan = resolved("Idle_01\nWALK for 1 sec\nTalk_02 for 1 sec", reference)
    ahead = plan_ahead(plan, Names(reference), said({**near_trap, **onward}))
    assert [one.layers[0].candidates for one in ahead.plan.statements] == [("Idle_01",), ("Walk_02",), ("Talk_02",)]
    assert ahead.price == 3.0
    greedy = forecast(plan, Names(reference), said({**near_trap, **onward}))
    assert greedy.whole.under_way == 10.0


@pytest.mark.parametrize("script", ["Idle_01\nrepeat 2 { WALK }", "Idle_01\nchoose { WALK | IDLE }"])
def test_a_script_that_repeats_or_chooses_is_left_as_it_is(script, reference, said):
    plan = resolved(script, reference)
    ahead = plan_ahead(plan, Names(reference), said())
    assert (ahead.plan, ahead.planned) == (plan, False)
    assert "repeats or chooses" in ahead.because
