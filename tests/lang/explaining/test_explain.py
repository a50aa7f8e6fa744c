"""What an explanation knows: how words were understood, what is in question, what is expected."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.explanation import Command
from mlmg_lang.explaining.mermaid import render_mermaid
from mlmg_lang.explaining.plan_json import plan_from_json, plan_to_json
from mlmg_lang.explaining.text import render_text
from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.front_end import analyse
from mlmg_lang.planning.ahead import plan_ahead
from mlmg_lang.planning.names import Names
from mlmg_lang.script_files import used_files
from mlmg_lang.source import Source

ROOT, UPPER, HAND = "Full-Body", "Upper-Body", "Left-Hand"


@pytest.fixture
def last(explained):
    """Return a function: script -> its last statement, explained."""
    return lambda text, **options: explained(text, **options).statements[-1]


def test_a_script_with_errors_has_no_explanation(made_library):
    with pytest.raises(ValueError, match="has errors"):
        explanation_from_analysis(analyse(Source("WLAK"), made_library), made_library)


def test_despite_mistakes_all_else_is_explained_as_if_they_were_not_there(made_library, explained):
    text = "IDLE for 1 sec\nWLAK\nrepeat 2 { WALK for 1 sec; TALK WLAK }\n"
    analysis = analyse(Source(text, "script.ms"), made_library)
    told = explanation_from_analysis(analysis, made_library, despite_mistakes=True)
    first, repeat = told.statements
    alone = explained("IDLE for 1 sec\n\nrepeat 2 { WALK for 1 sec }\n")
    assert told.totals == alone.totals
    assert first == alone.statements[0]
    (within,), (expected,) = repeat.body, alone.statements[1].body
    assert [layer.candidates for layer in within.layers] == [layer.candidates for layer in expected.layers]


@pytest.mark.parametrize(
    ("script", "start", "expected"),
    [
        ("WALK", None, ("Idle_01", "the start of the library")),
        ("Walk_02 for 1 sec", None, ("Walk_02", "which the script names first")),
        ("Walk_02 for 1 sec", "Talk_01", ("Talk_01", "as --start says")),
    ],
)
def test_where_the_character_starts_is_told_with_the_reason(script, start, expected, explained):
    told = explained(script, start=start)
    assert (told.start, told.start_because) == expected


def test_every_statement_knows_its_place(explained, flat):
    script = "# x\nIdle_01\nrepeat 2 { wait 1 sec; end Upper-Body }\nchoose { WALK | }"
    told = explained(script)
    spans = {one.kind: one.place.span for one in flat(told)}
    assert spans["repeat"] == (3, 1, 3, 40)
    assert spans["wait"] == (3, 12, 3, 22)
    assert spans["end"] == (3, 24, 3, 38)
    assert spans["choose"] == (4, 1, 4, 18)
    assert {one.place.file for one in flat(told)} == {"script.ms"}


def test_a_graph_without_a_match_is_passed_over(last):
    expression = last("Idle_01\nSWING_HAND").expression
    assert (expression.expression.graph, expression.graph_by) == (UPPER, "search")
    assert [(one.graph, one.because) for one in expression.passed_over] == [(ROOT, "there is no `SWING_HAND`")]


def test_a_graph_that_is_named_is_the_only_one_looked_at(last):
    expression = last("Left-Hand WAVE").expression
    assert (expression.graph_by, expression.passed_over) == ("name", ())
    assert last("WALK with Sub TALK").expression.operands[1].graph_by == "Sub"


def test_below_with_only_the_graphs_that_are_left_are_looked_at(last):
    operand = last("Walk_01 with Upper-Body TALK with WAVE").expression.operands[2]
    assert (operand.expression.graph, operand.passed_over) == (HAND, ())
    operand = last("Walk_01 with WAVE").expression.operands[1]
    assert [one.graph for one in operand.passed_over] == [UPPER]


def test_an_and_that_one_graph_fits_is_one_set(last):
    expression = last("TALK and IDLE").expression
    assert (expression.kind, expression.expression.word) == ("set", "and")
    assert expression.expression.motions == ("Talk_01",)
    assert [one.name for one in expression.expression.operands] == ["TALK", "IDLE"]


def test_an_and_that_no_graph_fits_is_shared_out(last):
    expression = last("WALK and TALK").expression
    assert expression.kind == "shared and"
    assert [(one.graph, one.motions[0]) for one in expression.assigned] == [(ROOT, "Walk_01"), (UPPER, "Talk_01")]
    assert [one.graph_by for one in expression.operands] == ["sharing", "sharing"]
    assert [one.graph for one in expression.passed_over] == [ROOT, UPPER, HAND]


def test_a_way_to_share_out_that_rule_1_forbids_is_told(last):
    (refused,) = last("Idle_02 and SWING_HAND").expression.refused
    assert refused.graphs == (ROOT, UPPER)
    assert refused.because == "`Upper-Body` cannot leave `Idle_02` (rule 1)"


def test_three_operands_may_share_two_graphs(last):
    expression = last("WALK and TALK and IDLE").expression
    assert [one.graph for one in expression.assigned] == [ROOT, UPPER]
    both = expression.operands[1].expression
    assert (both.kind, [one.name for one in both.operands]) == ("set operator", ["TALK", "IDLE"])


def test_uses_of_definitions_are_told_with_those_that_these_use_each_once(last):
    script = "let A = B with Upper-Body TALK\nlet B = C or C\nlet C = WALK\nA for 1 sec"
    assert [(use.name, use.place.line) for use in last(script).uses] == [("A", 1), ("B", 2), ("C", 3)]


def test_a_definition_of_another_file_is_told_with_that(made_library, tmp_path):
    (tmp_path / "gestures.ms").write_text("\n\nlet GREET = WALK with Upper-Body TALK\n", encoding="utf-8")
    script = tmp_path / "script.ms"
    analysis = analyse(Source('use "gestures.ms"\nGREET', str(script)), made_library, files=used_files(script))
    told = explanation_from_analysis(analysis, made_library)
    (command,) = told.statements
    assert isinstance(command, Command)
    (use,) = command.uses
    assert (use.place.file, use.place.line) == (str(tmp_path / "gestures.ms"), 3)
    assert command.expression.place.file == str(tmp_path / "gestures.ms"), "what it says stands there"
    assert command.place.file == str(script)


def test_what_is_left_out_is_told_with_the_reason(explained):
    told = explained("IDLE for 1 sec\nUpper-Body TALK")
    (left_out,) = told.statements[0].layers[0].left_out
    assert (left_out.motion, left_out.reason) == ("Idle_02", "later command")
    assert "line 2" in left_out.because
    (left_out,) = explained("IDLE with Upper-Body TALK").statements[0].layers[0].left_out
    assert (left_out.motion, left_out.reason) == ("Idle_02", "rule 1")


def test_candidates_of_the_root_stand_in_the_order_in_which_they_are_reached(last):
    layer = last("Idle_01 for 2 sec\nWALK").layers[0]
    assert layer.rule == "soonest"
    times = [one.takes.mean for one in layer.candidates]
    assert times == sorted(times)
    assert [one.chance for one in layer.candidates] == [1.0, 0.0, 0.0]


def test_candidates_of_a_part_stand_in_the_order_in_which_they_fit(last, made_library):
    layer = last("Walk_03\nUpper-Body (IDLE or TALK)").layers[0]
    assert (layer.rule, layer.rankings[0].above) == ("best fit", "Walk_03")
    graph = made_library.by_name[UPPER]
    fits = layer.rankings[0].fits
    oms = [float(graph.oms[graph.index["Walk_03"], graph.index[fit.motion]]) for fit in fits]
    assert [fit.oms for fit in fits] == oms == sorted(oms)
    (taken,) = layer.candidates
    assert (taken.motion, taken.chance) == (fits[0].motion, 1.0)
    assert {one.motion for one in layer.left_out} == {fit.motion for fit in fits[1:]}
    assert {one.reason for one in layer.left_out} == {"outranked"}


def test_what_plays_a_candidate_stays_and_needs_no_time(last):
    command = last("Walk_01 for 1 sec\nWALK for 1 sec")
    layer = command.layers[0]
    assert (layer.stays, layer.sources, command.arrives.most) == (1.0, (), 0.0)
    first = layer.candidates[0]
    assert (first.motion, first.chance, first.takes) == ("Walk_01", 1.0, None)


def test_what_is_ended_is_told_with_the_reason(last):
    (ending,) = last("Walk_01 with Upper-Body TALK for 1 sec\nWALK").ends
    assert (ending.graph, ending.chance, ending.because) == (UPPER, 1.0, "the command does not name it")
    assert 0 < ending.takes.mean <= 2.0 + 10 / 30
    (ending,) = last("Walk_01 with Upper-Body TALK for 1 sec\nIDLE with Upper-Body TALK").ends
    assert ending.because == "`Full-Body` changes its motion"


def test_what_plays_before_is_told_with_its_chances(last):
    before = last("Walk_01\nchoose { 3: Upper-Body TALK for 1 sec | Talk_02 }\nIDLE").before
    root, upper = before
    assert {one.motion: one.chance for one in root.motions} == {"Walk_01": 0.75, "Talk_02": 0.25}
    assert (upper.graph, upper.runs, upper.motions[0].motion) == (UPPER, 0.75, "Talk_01")


def test_the_last_command_plays_to_its_last_frame(explained):
    told = explained("Walk_01\nTalk_01")
    assert [one.duration.unit for one in told.statements] == ["none", "to the end"]
    assert told.statements[1].lasts.mean > 0
    whole = sum(one.arrives.mean + one.lasts.mean for one in told.statements)
    assert told.totals.takes.mean == pytest.approx(whole, abs=0.01)


def test_planning_over_the_whole_script_tells_what_it_gains(explained, made_library):
    script = "Idle_01 for 1 sec\nWALK for 1 sec\nIDLE for 1 sec\nWALK for 1 sec\nTALK for 2 sec\nIDLE for 1 sec"
    greedy, ahead = explained(script), explained(script, look_ahead=True)
    assert (greedy.plan, greedy.gain, ahead.plan) == ("greedy", None, "global")
    assert ahead.gain is not None
    assert ahead.gain.planned
    assert ahead.gain.greedy == greedy.totals
    assert ahead.totals.under_way + ahead.totals.cost < greedy.totals.under_way + greedy.totals.cost
    assert all(len(one.layers[0].candidates) == 1 for one in ahead.statements)
    walk = ahead.statements[1].layers[0]
    assert {one.motion for one in walk.left_out} == {"Walk_01", "Walk_02", "Walk_03"} - {walk.candidates[0].motion}
    assert {one.reason for one in walk.left_out} == {"look ahead"}


def test_where_it_cannot_plan_over_the_whole_script_it_says_so(explained):
    told = explained("Idle_01\nrepeat 501 { WALK }", look_ahead=True)
    assert told.gain is not None
    assert not told.gain.planned
    assert "more than 500 statements" in told.gain.because


def test_a_loop_planned_over_the_whole_script_tells_how_often_each_motion_is_taken(explained, demo_library):
    script = "IDLE for 1 sec\nrepeat 3 { WALK for 1 sec; IDLE or TALK for 1 sec }\nchoose { WALK | TALK }\nTALK"
    told = explained(script, demo_library, look_ahead=True, seed=0)
    assert told.gain is not None
    assert told.gain.planned
    _, loop, choice, _ = told.statements
    for one in loop.body:
        assert one.layers[0].rule == "look ahead"
        times = Counter(motion.motion for went in one.executions for motion in went.taken)
        assert {one.motion: round(3 * one.chance) for one in one.layers[0].candidates} == times
    assert len(loop.body[1].layers[0].candidates) > 1
    assert "to what was chosen for each round" in render_text(told)
    drawn = choice.branches[0].body[0].layers[0]
    assert (drawn.rule, len(drawn.candidates)) == ("soonest", 3)


def test_what_happened_stands_beside_what_was_expected(explained, demo_library):
    script = "Idle_01 for 1 sec\nWALK with Upper-Body TALK for 1 sec\nend Upper-Body\nrepeat 2 { wait 1 sec }\nIDLE"
    told = explained(script, demo_library, seed=0)
    first, walk, end, loop, idle = told.statements
    (wait,) = loop.body
    assert [len(one.executions) for one in (first, walk, end, wait, idle)] == [1, 1, 1, 2, 1]
    (went,) = walk.executions
    assert went.begin_s == 1.0
    assert walk.arrives.least <= went.arrived_s <= walk.arrives.most
    assert [one.graph for one in went.taken] == [ROOT, UPPER]
    assert went.cost == pytest.approx(sum(event.cost for event in went.events), abs=0.002)
    assert {event.graph for event in went.events} == {ROOT, UPPER}
    (went,) = end.executions
    assert {event.graph for event in went.events} <= {UPPER}
    assert told.played is not None
    ends = idle.executions[0].begin_s + idle.executions[0].arrived_s + idle.executions[0].lasted_s
    assert told.played.seconds == pytest.approx(ends, abs=0.002)
    assert told.played.under_way == pytest.approx(
        sum(went.arrived_s for one in (first, walk, end, idle) for went in one.executions), abs=0.005
    )


def test_loops_in_which_a_motion_is_held_are_no_events_of_a_command(explained, demo_library):
    told = explained("Idle_01 for 30 sec\nIDLE with Upper-Body TALK for 20 sec", demo_library, seed=0)
    first, second = told.statements
    assert first.executions[0].events == ()
    assert {event.graph for event in second.executions[0].events} == {UPPER}


def test_where_only_the_root_moves_from_the_start_the_estimate_is_what_happens(explained, demo_library):
    script = "Idle_01 for 2 sec\nWALK for 2 sec"
    told = explained(script, demo_library, seed=0)
    walk = told.statements[1]
    assert walk.arrives.mean == walk.executions[0].arrived_s
    assert walk.cost == walk.executions[0].cost
    assert [one.motion for one in walk.layers[0].candidates if one.chance] == [
        one.motion for one in walk.executions[0].taken
    ]


@pytest.mark.parametrize("seed", range(4))
def test_estimates_are_near_what_happens_on_the_demo_library(explained, demo_library, seed):
    script = (
        "Idle_01 for 3 sec\nWALK for 5 sec\nWALK with Upper-Body TALK for 6 sec\nIDLE for 2 sec\n"
        "choose { Music for 4 sec | Talk_02 for 4 sec | WALK and TALK for 2 sec }\nIDLE for 1 sec"
    )
    told = explained(script, demo_library, seed=seed)
    assert told.played is not None
    assert told.totals.takes.least * 0.9 <= told.played.seconds <= told.totals.takes.most * 1.1


# --- whatever the script ---

SETS = st.sampled_from(["WALK", "IDLE", "TALK", "Music", "Walk_02", "Idle_02", "not WALK", "(TALK or IDLE)"])
PARTS = st.sampled_from(
    ["SWING_HAND", "Upper-Body TALK", "Sub (TALK or IDLE)", "Left-Hand WAVE", "Left-Hand not IDLE", "WAVE_HAND"]
)
AFTER = st.sampled_from(["", " for 2 sec", " for 1 cycles", " once"])
COMMANDS = st.one_of(
    st.builds("{}{}".format, SETS, AFTER),
    st.builds("{} with {}{}".format, SETS, PARTS, AFTER),
    st.builds("{} and {}{}".format, SETS, SETS | PARTS, AFTER),
    st.builds("Upper-Body {} with Left-Hand WAVE{}".format, SETS, AFTER),
    st.sampled_from(["wait 1 sec", "wait 2 cycles", "end Upper-Body", "end Left-Hand"]),
)
BODIES = st.recursive(
    st.lists(COMMANDS, min_size=1, max_size=3).map("; ".join),
    lambda inner: st.one_of(
        st.builds("repeat {} {{ {} }}".format, st.integers(0, 2), inner),
        st.builds("choose {{ {} | 2: {} | }}".format, inner, inner),
        st.builds("{}\n{}".format, inner, inner),
    ),
    max_leaves=4,
)


@example(body="Upper-Body IDLE with Left-Hand WAVE for 2 sec; Idle_02 and WALK", start="Walk_03", ahead=False)
@example(body="repeat 4 { WALK and TALK; end Upper-Body }", start="Idle_01", ahead=True)
@given(body=BODIES, start=st.sampled_from(["Idle_01", "Walk_03", "Idle_02"]), ahead=st.booleans())
def test_whatever_a_script_says_it_is_explained(body, start, ahead, made_library, flat):
    analysis = analyse(Source(body, "script.ms"), made_library, start)
    if analysis.resolved is None:
        return
    planned = plan_ahead(analysis.resolved, Names(made_library), MotionTravel(made_library)) if ahead else None
    told = explanation_from_analysis(analysis, made_library, start, planned)
    check_sense(told, flat)
    assert plan_from_json(plan_to_json(told)) == told
    assert render_text(told)
    assert render_mermaid(told)


def check_sense(told, flat):
    """Check that chances add up, and that times are in order."""
    for one in flat(told):
        if one.kind == "choose":
            assert sum(branch.chance for branch in one.branches) == pytest.approx(1.0, abs=0.01)
        if one.kind != "command" or not one.before[0].runs:
            continue
        assert one.arrives.least <= one.arrives.mean <= one.arrives.most
        assert {layer.graph for layer in one.layers} == graphs_of(one.expression)
        for layer in one.layers:
            assert layer.candidates
            assert sum(candidate.chance for candidate in layer.candidates) == pytest.approx(1.0, abs=0.02), one.text
            moves = sum(source.chance for source in layer.sources)
            assert layer.stays + layer.follows + moves == pytest.approx(1.0, abs=0.02), one.text
    assert told.totals.takes.least <= told.totals.takes.mean <= told.totals.takes.most


def graphs_of(expression):
    return {one.graph for one in getattr(expression, "assigned", ())} or {expression.expression.graph}
