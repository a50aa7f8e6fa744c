"""What cannot win is left out of parts: nothing that is played changes by it, and nothing that can win is gone."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import product
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_lang.front_end import analyse
from mlmg_lang.perform import Rehearsal, rehearse
from mlmg_lang.planning import flow
from mlmg_lang.planning.move import Move, move
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.resolved import Command, Layer, ResolvedPlan
from mlmg_lang.planning.typed import Layer as Wanted
from mlmg_lang.planning.typed import Named
from mlmg_lang.source import Source, Span
from mlmg_lang.staging import ScriptError
from mlmg_runtime.library import Library

MOTIONS = "abct"
ON = {"Body": dict.fromkeys(MOTIONS, ()), "Top": dict.fromkeys(MOTIONS + "uv", ())}
COMMANDS = (
    *("WALK", "IDLE", "TALK", "WALK with Upper-Body TALK", "IDLE with Upper-Body (TALK or SWING_HAND)"),
    *("Upper-Body SWING_HAND", "Upper-Body not TALK", "WALK with Upper-Body not SWING_HAND", "not IDLE and TALK"),
)
AFTER = ("", " for 1 sec", " for 3 sec", " once")


def wanted(graph: str, motions: str) -> Wanted:
    return Wanted(Named(graph, tuple(motions), "x", Kind.TAG, "x", Span(0, 1)), Span(0, 1))


def taken(above: str, source: str, candidates: str, library: Any) -> str | None:
    """Return what a part takes, step by step as it is played; None, if it can take nothing."""
    if source in candidates:
        return source
    for motion in sorted(candidates, key=lambda one: library.unlikeness("Top", above, one)):
        if motion == above or library.can_reach("Top", source, motion):
            return motion
    return None


@st.composite
def cases(draw: st.DrawFn) -> tuple[frozenset[tuple[str, str, str]], dict[tuple[str, str, str], float], str, str, str]:
    pairs = list(product(ON["Top"], ON["Top"]))
    cut = draw(st.frozensets(st.sampled_from([("Top", a, b) for a, b in pairs if a != b]), max_size=6))
    far = {("Top", a, b): draw(st.sampled_from([0.5, 1.0, 2.0])) for a, b in pairs}
    some = st.lists(st.sampled_from("abctuv"), min_size=1, max_size=4, unique=True).map("".join)
    bodies = st.lists(st.sampled_from(MOTIONS), min_size=1, max_size=3, unique=True).map("".join)
    return cut, far, draw(bodies), draw(some), draw(some)


@given(case=cases())
def test_what_is_left_is_what_some_course_of_things_takes(catalog: Any, case: Any) -> None:
    cut, far, bodies, running, asked = case
    library = catalog(ON, {"Top": "Body"}, start="a", cut=cut, far=far)
    names = Names(library)
    setters: frozenset[flow.Setter | None] = frozenset((None,))
    for own in (None, running):
        parts = {"Body": flow.Part(dict.fromkeys(bodies, setters), True)}
        if own is not None:
            parts["Top"] = flow.Part(dict.fromkeys(own, setters), True)
        moved = move([wanted("Top", asked)], flow.State(parts), 0, {}, (names, library))
        if not isinstance(moved, Move):
            continue
        won = {taken(above, source, asked, library) for above in bodies for source in own or above}
        ranked = {one.motion for one in moved.left_out["Top"] if one.reason == "outranked"}
        # Of what fits equally well all are kept; where the part has nowhere to go, nothing is ranked.
        assert not ranked & won
        decided = len({*far.values()}) == len(far) or all(
            far["Top", above, one] != far["Top", above, other]
            for above in bodies
            for one, other in product(asked, asked)
            if one != other
        )
        if decided and not set(own or bodies) <= set(asked):
            assert set(moved.candidates["Top"]) == won - {None}


def with_the_outranked(plan: ResolvedPlan, library: Library) -> ResolvedPlan:
    """Return a plan in which what was outranked is a candidate again."""

    def layer(one: Layer) -> Layer:
        back = {out.motion for out in one.left_out if out.reason == "outranked"}
        known = library.motions(one.graph)
        return replace(one, candidates=tuple(m for m in known if m in back or m in one.candidates))

    statements = (
        replace(one, layers=tuple(map(layer, one.layers))) if isinstance(one, Command) else one
        for one in plan.statements
    )
    return replace(plan, statements=tuple(statements))


def rehearsed(plan: ResolvedPlan, library: Library) -> Rehearsal | None:
    try:
        return rehearse(plan, library)
    except ScriptError:
        return None


def check_that_nothing_else_is_played(library: Library) -> None:
    """Check some scripts of eight random commands in which something is outranked."""
    draw, n_changed = random.Random(5), 0
    while n_changed < settings().max_examples // 3:
        script = "\n".join(draw.choice(COMMANDS) + draw.choice(AFTER) for _ in range(8))
        plan = analyse(Source(script), library).resolved
        if plan is None:
            continue
        whole = with_the_outranked(plan, library)
        if whole == plan:
            continue
        n_changed += 1
        played, played_whole = rehearsed(plan, library), rehearsed(whole, library)
        assert (played is None) == (played_whole is None), script
        if played is not None and played_whole is not None:
            assert played.timeline == played_whole.timeline, script


@pytest.mark.hypothesis
def test_on_the_demo_library_nothing_else_is_played(demo_library: Library) -> None:
    check_that_nothing_else_is_played(demo_library)


@pytest.mark.hypothesis
def test_on_real_clips_nothing_else_is_played(reference_library: Library) -> None:
    check_that_nothing_else_is_played(reference_library)


@pytest.mark.parametrize("script", ["Idle_01\nWALK", "Idle_01\nUpper-Body TALK once"])
def test_where_the_soonest_is_taken_or_a_beginning_sought_every_candidate_may_win(
    script: str, reference: Any, resolves: Any
) -> None:
    far = replace(reference, far={("Upper-Body", "Idle_01", "Talk_02"): 9.0, ("Full-Body", "Idle_01", "Walk_02"): 9.0})
    assert [len(motions) for motions in resolves(script, far)[1].values()] in ([3], [2])


def test_a_later_command_may_ask_for_what_does_not_fit_best(catalog: Any, resolves: Any) -> None:
    on = {"Body": {"a": ()}, "Top": {"a": (), "t": ("T",), "u": ("T",)}, "Hand": {"a": (), "u": (), "h": ("H",)}}
    library = catalog(on, {"Top": "Body", "Hand": "Top"}, start="a", far={("Top", "a", "u"): 9.0})
    assert resolves("a\nT", library)[1] == {"Top": ("t",)}
    assert resolves("a\nT\nH", library)[1] == {"Top": ("u",)}
