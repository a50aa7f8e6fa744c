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
from mlmg_lang.planning.resolved import Command, Repeat, ResolvedPlan
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


def loop_combinations(plan: ResolvedPlan, names: Names) -> Iterator[ResolvedPlan]:
    """Yield a plan of commands, choices and loops of commands with every combination of candidates for each round."""
    options: list[list[Any]] = []
    for one in plan.statements:
        if not isinstance(one, Repeat):
            options.append([narrowed for _, narrowed in narrowings(one, names)])
            continue
        bodies = list(product(*([narrowed for _, narrowed in narrowings(each, names)] for each in one.body)))
        options.append([replace(one, rounds=rounds) for rounds in product(bodies, repeat=one.count)])
    for statements in product(*options):
        yield replace(plan, statements=tuple(statements), ahead=True)


@pytest.mark.parametrize(
    "script",
    [
        "Idle_01\nrepeat 2 { WALK for 1 sec; IDLE for 1 sec }\nTALK",
        "Idle_01 for 1 sec\nWALK\nchoose { 3: IDLE for 1 sec | TALK; wait 1 cycles }\nWALK\nIDLE",
        "repeat 3 { WALK; choose { Music for 1 sec | } }\nTALK",
        "repeat 2 { end Upper-Body; WALK with Upper-Body TALK for 1 sec }\nIDLE",
    ],
)
def test_no_combination_for_rounds_and_around_choices_is_cheaper(script, demo_library):
    plan, names, travel = resolved(script, demo_library), Names(demo_library), MotionTravel(demo_library)
    ahead = plan_ahead(plan, names, travel)
    prices = [price(one, names, travel) for one in loop_combinations(plan, names)]
    assert ahead.planned
    assert ahead.price == pytest.approx(min(prices))
    assert price(ahead.plan, names, travel) == pytest.approx(min(prices))
    assert min(prices) < max(prices)


def test_each_round_of_a_loop_has_a_choice_of_its_own(reference, said):
    times = {("Idle_01", "Walk_01"): 1.0, ("Walk_01", "Talk_01"): 1.0, ("Talk_01", "Walk_02"): 1.0}
    ways = {
        (a, b): times.get((a, b), 5.0) for a in reference.motions("Full-Body") for b in reference.motions("Full-Body")
    }
    plan = resolved("Idle_01\nrepeat 2 { WALK; Talk_01 }", reference)
    ahead = plan_ahead(plan, Names(reference), said(ways | {("Walk_02", "Talk_01"): 1.0}))
    loop = ahead.plan.statements[1]
    assert isinstance(loop, Repeat)
    assert [body[0].layers[0].candidates for body in loop.rounds] == [("Walk_01",), ("Walk_02",)]
    assert loop.body[0].layers[0].candidates == ("Walk_01", "Walk_02")
    assert [one.motion for one in loop.body[0].layers[0].left_out] == ["Walk_03"]
    assert ahead.price == 4.0


def test_what_stands_before_a_choice_is_chosen_for_what_may_come_after(reference, said):
    onward = {("Walk_01", "Talk_02"): 9.0, ("Walk_01", "Music_01"): 1.0, ("Walk_02", "Music_01"): 4.0}
    times = {("Idle_01", "Walk_01"): 1.0, ("Idle_01", "Walk_02"): 1.0, ("Walk_02", "Talk_02"): 1.0}
    times |= {("Idle_01", "Walk_03"): 20.0}
    for weights, taken in (((3, 1), "Walk_01"), ((1, 3), "Walk_02")):
        script = "Idle_01\nWALK\nchoose { {}: Music_01 | {}: Talk_02 }".replace("{}", "%d") % weights
        ahead = plan_ahead(resolved(script, reference), Names(reference), said({**onward, **times}))
        assert ahead.plan.statements[1].layers[0].candidates == (taken,)
        assert ahead.plan.statements[2] == resolved(script, reference).statements[2]


@pytest.mark.parametrize(
    ("script", "planned"),
    [
        ("repeat 500 { Idle_01 }", True),
        ("repeat 501 { Idle_01 }", False),
        ("repeat 50 { repeat 10 { Idle_01 }; Walk_01 }", False),
        ("repeat 167 { choose { Idle_01 | Idle_01 } }", False),
        ("repeat 1000000 { }\nIdle_01", True),
        ("repeat 0 { Walk_01 }\nIdle_01", True),
        ("repeat 1 { WALK; repeat 0 { WALK } }\nIdle_01", True),
        ("Idle_01\n" * 501, True),
    ],
)
def test_only_very_long_scripts_with_loops_are_left_as_they_are(script, planned, reference, said):
    plan = resolved(script, reference)
    ahead = plan_ahead(plan, Names(reference), said())
    assert (ahead.planned, ahead.plan is plan) == (planned, not planned)
    assert ("more than 500 statements" in ahead.because) == (not planned)
