"""Motions chosen over the whole script: what is played is never the worse for it."""

from __future__ import annotations

import random
from dataclasses import replace
from math import inf
from typing import Any

import pytest

import mlmg_lang
from mlmg_lang import looking_ahead
from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.front_end import analyse
from mlmg_lang.looking_ahead import look_ahead
from mlmg_lang.perform import rehearse
from mlmg_lang.planning.ahead import Ahead, plan_ahead
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Repeat, ResolvedPlan
from mlmg_lang.source import Source
from mlmg_lang.staging import ScriptError
from mlmg_runtime.library import Library
from mlmg_runtime.playing.timeline import Blend

MOTIONS = ("WALK", "IDLE", "TALK", "Music", "WALK or TALK", "IDLE or WALK")
AFTER = ("", " for 1 sec", " for 2 sec", " for 5 sec")
GREEDY_FALLS_SHORT = "Idle_01\nWALK for 1 sec\nIDLE for 1 sec\nWALK for 1 sec\nTALK for 2 sec\nIDLE for 1 sec"


def resolved(text: str, library: Library) -> ResolvedPlan:
    plan = analyse(Source(text), library).resolved
    assert plan is not None
    return plan


def price(plan: ResolvedPlan, library: Library, seed: int = 0) -> float:
    """Return the seconds on the way and the costs of a plan of the root graph alone, counted from its timeline."""
    try:
        rehearsal = rehearse(plan, library, seed)
    except ScriptError:
        return inf
    root = library.root.name
    blends = [one for one in rehearsal.timeline.tracks[root] if isinstance(one, Blend)]
    total, home = 0.0, plan.start
    for step in rehearsal.steps:
        total += (step.arrive - step.begin) / library.frame_rate
        if step.motions[root] != home:
            under_way = (one for one in blends if step.begin <= one.begin < step.arrive)
            total += sum(one.transition.cost for one in under_way if one.transition is not None)
        home = step.motions[root]
    return total


def check_never_worse(library: Library) -> None:
    """Check 20 scripts of eight random commands."""
    draw, gains = random.Random(11), []
    for _ in range(20):
        plan = resolved("\n".join(draw.choice(MOTIONS) + draw.choice(AFTER) for _ in range(8)), library)
        ahead = look_ahead(plan, library)
        greedy, looked = price(plan, library), price(ahead.plan, library)
        assert looked <= greedy + 0.01
        assert ahead.planned == ahead.plan.ahead == (not ahead.because)
        assert ahead.planned or ahead.plan is plan
        gains += [greedy - looked] if greedy < inf else []
    assert sum(gains) / len(gains) > 0.5


def random_script(draw: random.Random) -> str:
    """Return a script of loops and choices of random commands."""

    def some() -> str:
        return "; ".join(draw.choice(MOTIONS) + draw.choice(AFTER) for _ in range(draw.randint(1, 2)))

    loop = f"repeat {draw.randint(2, 3)} {{ {some()}; choose {{ {some()} | {draw.randint(1, 3)}: {some()} }} }}"
    return "\n".join([some(), draw.choice([loop, f"repeat {draw.randint(2, 4)} {{ {some()}; {some()} }}"]), some()])


def test_with_loops_and_choices_what_is_played_is_never_worse(demo_library):
    draw, gains = random.Random(5), []
    for seed in range(15):
        plan = resolved(random_script(draw), demo_library)
        ahead = look_ahead(plan, demo_library, seed)
        greedy, looked = price(plan, demo_library, seed), price(ahead.plan, demo_library, seed)
        assert looked <= greedy + 0.01
        assert ahead.planned or ahead.plan is plan
        gains.append(greedy - looked)
    assert sum(gain > 0.5 for gain in gains) > 2


def test_on_the_demo_library_what_is_played_is_never_worse(demo_library):
    check_never_worse(demo_library)


def test_on_real_clips_what_is_played_is_never_worse(reference_library):
    check_never_worse(reference_library)


def planned_as(plan: ResolvedPlan, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the estimates say that a plan is the cheapest."""

    def plan_ahead(*_: Any) -> Ahead:
        return Ahead(replace(plan, ahead=True), True, "", 0.0)

    monkeypatch.setattr(looking_ahead, "plan_ahead", plan_ahead)


def test_where_the_estimates_mislead_commands_are_played_one_by_one(demo_library, monkeypatch):
    plan = resolved("Idle_01 for 1 sec\nWALK for 1 sec", demo_library)
    planned_as(resolved("Idle_01 for 1 sec\nTalk_01 for 3 sec\nWALK for 1 sec", demo_library), monkeypatch)
    ahead = look_ahead(plan, demo_library)
    assert (ahead.plan, ahead.planned) == (plan, False)
    assert "as played, would come to" in ahead.because


@pytest.mark.parametrize("fails", [(True,), (True, True), (False, True)])
def test_what_cannot_be_played_is_not_taken_if_the_other_can(demo_library, monkeypatch, fails):
    plan, other = resolved("Idle_01\nWALK", demo_library), resolved("Idle_01\nTalk_01", demo_library)
    planned_as(other, monkeypatch)
    outcomes = [*fails, False][:2]

    def rehearse_or_fail(one: ResolvedPlan, library: Library, seed: int) -> Any:
        if outcomes.pop(0):
            raise ScriptError("script.ms", 1, "no way leads there")
        return rehearse(one, library, seed)

    monkeypatch.setattr(looking_ahead, "rehearse", rehearse_or_fail)
    ahead = look_ahead(plan, demo_library)
    assert ahead.planned == (fails == (True,))
    assert ahead.planned or "cannot be played" in ahead.because


@pytest.mark.parametrize("script", ["repeat 501 { WALK }", "repeat 126 { WALK; choose { TALK | IDLE } }"])
def test_a_script_that_repeats_very_often_is_played_command_by_command(demo_library, script):
    plan = resolved(script, demo_library)
    ahead = look_ahead(plan, demo_library)
    assert (ahead.plan, ahead.planned) == (plan, False)
    assert "more than 500 statements" in ahead.because


def test_each_round_of_a_loop_takes_what_was_chosen_for_it(demo_library):
    plan = resolved("Idle_01\nrepeat 4 { WALK for 1 sec; IDLE for 1 sec }\nTALK", demo_library)
    ahead = plan_ahead(plan, Names(demo_library), MotionTravel(demo_library)).plan
    loop = ahead.statements[1]
    assert isinstance(loop, Repeat)
    wanted = [one.layers[0].candidates for body in loop.rounds for one in body]
    steps = rehearse(ahead, demo_library).steps[1:-1]
    assert [(step.motions["Full-Body"],) for step in steps] == wanted
    assert {motion for one in loop.body for motion in one.layers[0].candidates} == {motion for (motion,) in wanted}


@pytest.mark.parametrize("seed", range(3))
def test_a_plan_with_choices_can_be_played_whatever_is_drawn(demo_library, seed):
    script = "repeat 3 { WALK or IDLE for 1 sec; choose { TALK for 1 sec | 2: WALK | } }\nIDLE or TALK"
    ahead = plan_ahead(resolved(script, demo_library), Names(demo_library), MotionTravel(demo_library)).plan
    assert price(ahead, demo_library, seed) < inf


def test_a_plan_is_rehearsed_with_what_the_seed_draws(demo_library, monkeypatch):
    seeds = []

    def rehearse_and_note(plan: ResolvedPlan, library: Library, seed: int) -> Any:
        seeds.append(seed)
        return rehearse(plan, library, seed)

    monkeypatch.setattr(looking_ahead, "rehearse", rehearse_and_note)
    mlmg_lang.compile("Idle_01\nchoose { WALK | TALK }", demo_library, plan="global", seed=7)
    assert seeds == [7, 7]


def test_the_report_says_which_plan_was_played(demo_library):
    greedy, _ = mlmg_lang.compile(GREEDY_FALLS_SHORT, demo_library)
    ahead, _ = mlmg_lang.compile(GREEDY_FALLS_SHORT, demo_library, plan="global")
    assert greedy is not None
    assert ahead is not None
    reports = [mlmg_lang.play(plan, demo_library).report for plan in (greedy, ahead)]
    assert [report["plan"] for report in reports] == ["greedy", "global"]
    on_the_way = [sum(one["arrive"] - one["begin"] for one in report["commands"]) for report in reports]
    assert on_the_way[1] < on_the_way[0]


def test_what_is_explained_is_what_is_played(demo_library):
    analysis = analyse(Source(GREEDY_FALLS_SHORT), demo_library)
    assert analysis.resolved is not None
    ahead = look_ahead(analysis.resolved, demo_library)
    told = explanation_from_analysis(analysis, demo_library, ahead=ahead, seed=0)
    assert told.played is not None
    assert told.gain is not None
    assert told.gain.played is not None
    assert told.played.under_way + told.played.cost == pytest.approx(price(ahead.plan, demo_library), abs=0.02)
    assert told.gain.played.under_way + told.gain.played.cost == pytest.approx(
        price(analysis.resolved, demo_library), abs=0.02
    )


def test_only_an_opened_library_can_be_planned_on_over_the_whole_script(reference):
    with pytest.raises(TypeError, match="an opened library, not for FakeCatalog"):
        mlmg_lang.compile("Idle_01\nWALK", reference, plan="global")


def test_a_script_with_mistakes_has_no_plan_of_either_kind(demo_library):
    plan, diagnostics = mlmg_lang.compile("WLAK", demo_library, plan="global")
    assert plan is None
    assert [one.code for one in diagnostics] == ["MS021"]
