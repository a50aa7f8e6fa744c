"""What commands can do where they stand in a script: rule 1, narrowing, reachability, the start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.planning import resolve
from mlmg_lang.planning.resolved import Choose, Command, Cycles, End, Once, Repeat, Seconds, Statement, Wait
from mlmg_lang.source import Source

Resolves = Callable[..., list[dict[str, tuple[str, ...]]]]
Codes = Callable[..., list[str]]

IDLES = ("Idle_01", "Idle_02", "Music_01", "Talk_01")
WALKS = ("Walk_01", "Walk_02", "Walk_03")
TALKS = ("Talk_01", "Talk_02")
UPPER_WALKS_AND_TALKS = {"Full-Body": WALKS, "Upper-Body": TALKS}


# --- the published examples ---


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("IDLE", [{"Full-Body": IDLES}]),
        ("SWING_HAND", [{"Upper-Body": ("Walk_01", "Walk_02")}]),
        ("WALK with Upper-Body TALK", [UPPER_WALKS_AND_TALKS]),
        ("TALK and IDLE", [{"Full-Body": ("Talk_01",)}]),
        ("WALK and TALK", [UPPER_WALKS_AND_TALKS]),
    ],
)
def test_the_published_commands_mean_what_was_published(
    script: str, expected: list[dict[str, Any]], resolves: Resolves
) -> None:
    assert resolves(script, start="Idle_01") == expected


@pytest.mark.parametrize("first", ["Idle_01", "Idle_02"])
def test_the_published_continuous_script_means_what_was_published(first: str, resolves: Resolves) -> None:
    script = f"{first}\nWALK for 10 sec\nWALK with Sub TALK for 10 sec\nIDLE"
    assert resolves(script) == [
        {"Full-Body": (first,)},
        {"Full-Body": WALKS},
        UPPER_WALKS_AND_TALKS,
        {"Full-Body": IDLES},
    ]


def test_the_published_three_layers_are_three_layers(resolves: Resolves, left_hand: Any) -> None:
    expected = {"Full-Body": ("Walk_01",), "Upper-Body": ("Talk_01",), "Left-Hand": ("Wave_01",)}
    assert resolves("Walk01 with Upper-Body Talk01 with Left-Hand Wave01", left_hand) == [expected]


# --- rule 1 ---


def test_a_candidate_above_that_the_part_cannot_leave_is_left_out(reference: Any) -> None:
    plan = analyse(Source("IDLE with Upper-Body TALK"), reference).resolved
    assert plan is not None
    (command,) = plan.statements
    assert isinstance(command, Command)
    body, upper = command.layers
    assert body.candidates == ("Idle_01", "Music_01", "Talk_01")
    assert [(out.motion, out.reason) for out in body.left_out] == [("Idle_02", "rule 1")]
    assert (upper.candidates, upper.left_out) == (TALKS, ())


def test_rule_1_asks_the_nearest_graph_above_that_the_command_names(catalog: Any) -> None:
    on = {"Body": {"a": (), "b": ()}, "Top": {"a": (), "c": ()}, "Hand": {"c": (), "d": ()}}
    library = catalog(on, {"Top": "Body", "Hand": "Top"}, start="a")
    found = analyse(Source("(a or b) with (Top (a or c)) with Hand d"), library).resolved
    assert found is not None
    (command,) = found.statements
    assert isinstance(command, Command)
    assert [layer.candidates for layer in command.layers] == [("a",), ("c",), ("d",)]


def test_a_part_is_led_by_what_an_earlier_command_left_running_above_it(catalog: Any, codes: Codes) -> None:
    on = {"Body": {"a": ()}, "Top": {"a": (), "c": ()}, "Hand": {"a": (), "d": ()}}
    library = catalog(on, {"Top": "Body", "Hand": "Top"}, start="a")
    assert codes("Hand d", library) == []
    assert codes("Top c\nHand d", library) == ["MS040"]
    assert codes("Top c\nend Top\nHand d", library) == []
    assert codes("Top c for 1 sec\na\nHand d", library) == []


def test_the_start_can_stand_in_the_way(codes: Codes, reference: Any) -> None:
    assert codes("Upper-Body TALK", reference, "Idle_02") == ["MS040"]


def test_nothing_stands_in_the_way_of_a_part_that_has_left_already(resolves: Resolves) -> None:
    assert resolves("IDLE with Upper-Body TALK\nUpper-Body SWING_HAND")[1] == {"Upper-Body": ("Walk_01", "Walk_02")}


def test_an_and_is_shared_out_in_the_first_way_that_rule_1_allows(catalog: Any, resolves: Resolves) -> None:
    on = {"Body": {"a": ("A",), "i": ()}, "Top": {"b": ("B",), "i": ()}, "Hand": {"a": (), "b": ("B",), "i": ()}}
    library = catalog(on, {"Top": "Body", "Hand": "Body"}, start="i")
    assert resolves("A and B", library) == [{"Body": ("a",), "Hand": ("b",)}]


def test_an_and_that_rule_1_allows_in_no_way_is_one_mistake(catalog: Any, codes: Codes) -> None:
    on = {"Body": {"a": ("A",), "i": ()}, "Top": {"b": ("B",), "i": ()}, "Hand": {"b": ("B",), "i": ()}}
    assert codes("A and B", catalog(on, {"Top": "Body", "Hand": "Body"}, start="i")) == ["MS040"]


# --- narrowing ---


def test_a_later_command_for_a_part_narrows_the_one_that_sets_its_parent(reference: Any) -> None:
    plan = analyse(Source("IDLE\nwait 2 sec\nUpper-Body TALK"), reference).resolved
    assert plan is not None
    first = plan.statements[0]
    assert isinstance(first, Command)
    (layer,) = first.layers
    assert layer.candidates == ("Idle_01", "Music_01", "Talk_01")
    assert [(out.motion, out.reason) for out in layer.left_out] == [("Idle_02", "later command")]
    assert "line 3" in layer.left_out[0].because


def test_only_the_last_command_that_sets_the_parent_is_narrowed(resolves: Resolves) -> None:
    script = "IDLE for 2 sec\nWALK\nIDLE\nUpper-Body TALK\nIDLE"
    found = [layers.get("Full-Body") for layers in resolves(script)]
    assert found == [IDLES, WALKS, ("Idle_01", "Music_01", "Talk_01"), None, IDLES]


def test_a_narrowing_can_reach_back_over_several_commands(catalog: Any, resolves: Resolves) -> None:
    on = {"Body": {"a": ("A",), "b": ("A",), "c": ("A",)}, "Top": {"a": (), "b": ("T",), "t": ("T",)}}
    on["Hand"] = {"t": (), "h": ()}
    library = catalog(on, {"Top": "Body", "Hand": "Top"}, start="a", cut=frozenset({("Top", "a", "t")}))
    script = "A\nTop T\nHand h"
    assert resolves(script, library) == [{"Body": ("b",)}, {"Top": ("t",)}, {"Hand": ("h",)}]


def test_a_command_that_would_leave_nothing_to_an_earlier_one_is_at_fault(reference: Any) -> None:
    analysis = analyse(
        Source("Full-Body (IDLE and not (Talk_01 or Music or Idle_01))\nWALK\nIdle_02\nUpper-Body TALK"), reference
    )
    (one,) = analysis.diagnostics
    assert one.code == "MS040"
    assert one.span is not None
    assert analysis.source.position(one.span.start) == (4, 1)
    assert [note.span and analysis.source.slice(note.span) for note in one.notes] == ["Idle_02"]


def test_a_narrowing_that_fails_is_taken_back(catalog: Any) -> None:
    on = {"Body": {"s": (), "a": ("A",), "b": ("A",)}, "Top": {"b": (), "s": (), "t": ()}}
    library = catalog(on, {"Top": "Body"}, start="s", cut=frozenset({("Body", "s", "b")}))
    analysis = analyse(Source("A\nTop t"), library)
    assert [one.code for one in analysis.diagnostics] == ["MS040"]
    assert analysis.resolved is None


# --- reachability ---


def test_a_candidate_that_cannot_be_reached_is_left_out(reference: Any) -> None:
    library = replace(reference, cut=frozenset({("Full-Body", "Idle_01", "Walk_02")}))
    plan = analyse(Source("WALK"), library).resolved
    assert plan is not None
    (command,) = plan.statements
    assert isinstance(command, Command)
    (layer,) = command.layers
    assert layer.candidates == ("Walk_01", "Walk_03")
    assert [(out.motion, out.reason) for out in layer.left_out] == [("Walk_02", "unreachable")]


def test_if_nothing_can_be_reached_the_command_is_an_error(reference: Any, codes: Codes) -> None:
    cut = frozenset(("Full-Body", "Idle_01", walk) for walk in WALKS)
    assert codes("Idle_01\nWALK", replace(reference, cut=cut)) == ["MS041"]


def test_a_motion_from_which_a_part_can_reach_nothing_is_left_out(reference: Any, resolves: Resolves) -> None:
    cut = frozenset(("Upper-Body", "Walk_01", talk) for talk in TALKS)
    assert resolves("WALK with Upper-Body TALK", replace(reference, cut=cut))[0]["Full-Body"] == ("Walk_02", "Walk_03")


def test_what_plays_already_needs_no_way(reference: Any, codes: Codes) -> None:
    cut = frozenset(("Full-Body", "Idle_01", motion) for motion in (*WALKS, *IDLES, *TALKS))
    assert codes("Idle_01 for 2 sec\nIDLE", replace(reference, cut=cut)) == []


# --- ends, waits, durations ---


def test_an_end_gives_back_what_runs_and_warns_of_what_cannot_run(codes: Codes, reference: Any) -> None:
    assert codes("WALK with Upper-Body TALK\nend Upper-Body", reference) == []
    assert codes("WALK with Upper-Body TALK\nend Upper-Body\nend Upper-Body", reference) == ["MS043"]
    assert codes("WALK with Upper-Body TALK for 1 sec\nWALK\nend Upper-Body", reference) == ["MS043"]
    assert codes("Walk_01\nSWING_HAND\nend Upper-Body", reference) == ["MS043"]
    assert codes("Walk_01\nUpper-Body Walk_02\nend Upper-Body", reference) == []
    assert codes("Full-Body IDLE\nend Full-Body", reference) == ["MS042"]


def test_an_end_takes_the_parts_below_with_it(codes: Codes, left_hand: Any) -> None:
    script = "WALK with Upper-Body TALK with Left-Hand WAVE\nend Upper-Body\nend Left-Hand"
    assert codes(script, left_hand) == ["MS043"]


def test_a_plan_has_waits_ends_and_durations_in_seconds(reference: Any) -> None:
    plan = analyse(
        Source("WALK with TALK for 2 min\nwait 250 ms\nend upper_body\nIDLE for 45 frames"), reference
    ).resolved
    assert plan is not None
    walk, wait, end, idle = plan.statements
    assert isinstance(walk, Command)
    assert walk.duration == Seconds(120.0)
    assert isinstance(wait, Wait)
    assert wait.duration == Seconds(0.25)
    assert isinstance(end, End)
    assert end.graph == "Upper-Body"
    assert isinstance(idle, Command)
    assert idle.duration == Seconds(1.5)


def test_a_plan_has_cycles_and_once(reference: Any) -> None:
    plan = analyse(Source("WALK for 1.5 cycles\nwait 2 cycles\nTALK once\nIDLE"), reference).resolved
    assert plan is not None
    durations = [statement.duration for statement in plan.statements if isinstance(statement, Command | Wait)]
    assert durations == [Cycles(1.5), Cycles(2.0), Once(), None]


def test_layers_stand_highest_first_whatever_the_order_of_the_text(left_hand: Any) -> None:
    plan = analyse(Source("WAVE and TALK and WALK"), left_hand).resolved
    assert plan is not None
    (command,) = plan.statements
    assert isinstance(command, Command)
    assert [layer.graph for layer in command.layers] == ["Full-Body", "Upper-Body", "Left-Hand"]


# --- the start ---


@pytest.mark.parametrize(
    ("script", "given", "start"),
    [
        ("WALK", None, "Music_01"),
        ("Idle_02", None, "Idle_02"),
        ("idle-02 for 3 sec", None, "Idle_02"),
        ("wait 2 sec\nWalk_01", None, "Walk_01"),
        ("Idle_02", "walk01", "Walk_01"),
        ("IDLE\nIdle_02", None, "Music_01"),
        ("Full-Body Idle_02", None, "Music_01"),
        ("Idle_02 with Upper-Body Idle_01", "Idle_01", "Idle_01"),
        ("SWING_HAND", None, "Music_01"),
        ("", None, "Music_01"),
    ],
)
def test_the_start_is_given_or_the_first_command_or_the_librarys(
    script: str, given: str | None, start: str, reference: Any
) -> None:
    analysis = analyse(Source(script), replace(reference, start="Music_01"), given)
    if analysis.resolved is not None:
        assert analysis.resolved.start == start
    else:
        assert [one.code for one in analysis.diagnostics] == ["MS040"]


def test_a_library_whose_start_is_not_there_starts_in_its_first_motion(reference: Any) -> None:
    plan = analyse(Source("WALK"), replace(reference, start="Gone")).resolved
    assert plan is not None
    assert plan.start == "Idle_01"


def test_an_unknown_start_is_an_error_without_a_place(reference: Any) -> None:
    analysis = analyse(Source("WALK"), reference, "Idel_01")
    (one,) = analysis.diagnostics
    assert (one.code, one.span, analysis.resolved) == ("MS044", None, None)
    assert one.help is not None
    assert "Idle_01" in one.help


# --- after a mistake ---


def test_a_mistake_in_one_command_brings_none_in_the_next(codes: Codes, reference: Any) -> None:
    assert codes("Idle_02\nWLAK\nUpper-Body TALK\nend Upper-Body", reference) == ["MS021"]
    assert codes("Idle_02\nUpper-Body TALK\nUpper-Body TALK\nend Upper-Body", reference) == ["MS040"]
    assert codes("Idle_02\nrepeat 2 { WLAK }\nUpper-Body TALK", reference) == ["MS021"]
    assert codes("Idle_02\nchoose { WLAK | WALK }\nUpper-Body TALK", reference) == ["MS021"]


def test_after_a_command_for_the_whole_body_everything_is_certain_again(codes: Codes, reference: Any) -> None:
    assert codes("WLAK\nIdle_02\nUpper-Body TALK", reference) == ["MS021", "MS040"]


# --- where several things hang together ---


def test_a_way_that_narrows_in_vain_leaves_no_trace_on_the_next(catalog: Any, resolves: Resolves) -> None:
    on = {
        "Body": {"a": ("A",), "b": ("A",)},
        "Leg": {"a": (), "b": (), "l1": ("L",), "l2": ("L",)},
        "Top": {"a": (), "b": (), "t1": ("T",), "t2": ("T",)},
        "Foot": {"l2": (), "f": ("F",)},
        "Hand": {"t1": (), "h": ("H",)},
        "Toe": {"l1": (), "l2": (), "f": ("F",)},
    }
    above = {"Leg": "Body", "Top": "Body", "Foot": "Leg", "Hand": "Top", "Toe": "Leg"}
    # From a only l1 and t1 can be reached, from b only l2 and t2: Foot asks for b, Hand for a, Toe for neither.
    cut = frozenset({("Leg", "a", "l2"), ("Leg", "b", "l1"), ("Top", "a", "t2"), ("Top", "b", "t1")})
    library = catalog(on, above, start="a", cut=cut)
    assert resolves("A\nL\nT\nF and H", library) == [
        {"Body": ("a",)},
        {"Leg": ("l1",)},
        {"Top": ("t1",)},
        {"Hand": ("h",), "Toe": ("f",)},
    ]


def test_two_parts_that_ask_for_different_things_above_them_are_at_fault_together(catalog: Any) -> None:
    on = {
        "Body": {"a": ("A",), "b": ("A",)},
        "Leg": {"a": (), "b": (), "l1": ("L",), "l2": ("L",)},
        "Top": {"a": (), "b": (), "t1": ("T",), "t2": ("T",)},
        "Foot": {"l2": (), "f": ("F",)},
        "Hand": {"t1": (), "h": ("H",)},
    }
    cut = frozenset({("Leg", "a", "l2"), ("Leg", "b", "l1"), ("Top", "a", "t2"), ("Top", "b", "t1")})
    library = catalog(on, {"Leg": "Body", "Top": "Body", "Foot": "Leg", "Hand": "Top"}, start="a", cut=cut)
    analysis = analyse(Source("A\nL\nT\nF and H\nend Hand"), library)
    (one,) = analysis.diagnostics
    assert one.code == "MS040"
    assert one.span is not None
    assert analysis.source.position(one.span.start)[0] == 4


def test_a_part_that_runs_goes_on_from_its_own_motion_if_the_one_above_may_stay(catalog: Any, codes: Codes) -> None:
    on = {"Body": {"a": ()}, "Top": {"a": (), "t": (), "u": ()}}
    library = catalog(on, {"Top": "Body"}, start="a", cut=frozenset({("Top", "a", "u")}))
    assert codes("a with Top t for 1 sec\na with Top u", library) == []
    assert codes("a with Top u", library) == ["MS041"]


def test_a_part_that_is_led_to_the_motion_of_its_parent_does_not_run(codes: Codes, reference: Any) -> None:
    script = "Talk_02 with Upper-Body Talk_01 for 1 sec\nTalk_01 with Upper-Body Talk_01\nend Upper-Body"
    assert codes(script, reference) == ["MS043"]


def test_after_a_mistake_a_part_beside_may_be_running(codes: Codes, hands: Any) -> None:
    assert codes("WLAK\nLeft-Hand WAVE\nend Right-Hand", hands) == ["MS021"]


# --- loops and choices ---


def commands_of(script: str, library: Any) -> list[dict[str, tuple[str, ...]]]:
    """Return the candidates of every command, those in bodies too, in the order of the text."""
    analysis = analyse(Source(script), library)
    assert analysis.resolved is not None, [one.message for one in analysis.diagnostics]
    found: list[dict[str, tuple[str, ...]]] = []
    waiting: list[Statement] = list(analysis.resolved.statements)
    while waiting:
        match waiting.pop(0):
            case Repeat(body=body):
                waiting = [*body, *waiting]
            case Choose(branches):
                waiting = [*(statement for branch in branches for statement in branch.body), *waiting]
            case Command(layers):
                found.append({layer.graph: layer.candidates for layer in layers})
    return found


LESS = ("Idle_01", "Music_01", "Talk_01")
"""The idle motions that the upper body can leave."""


@pytest.mark.parametrize(
    ("script", "idles"),
    [
        ("repeat 2 { Upper-Body TALK; IDLE }", LESS),
        ("repeat 1 { Upper-Body TALK; IDLE }", IDLES),
        ("repeat 0 { Upper-Body TALK; IDLE }", IDLES),
        ("repeat 2 { repeat 1 { Upper-Body TALK }; choose { WALK | IDLE } }", LESS),
        ("repeat 2 { Upper-Body TALK; IDLE; WALK }", IDLES),
        ("repeat 2 { Upper-Body TALK; IDLE; choose { WALK | } }", LESS),
        ("repeat 2 { Upper-Body TALK; IDLE; choose { WALK | 0: } }", IDLES),
        ("IDLE; repeat 2 { Upper-Body TALK; WALK }", LESS),
        ("IDLE; repeat 2 { WALK; Upper-Body TALK }", IDLES),
        ("IDLE; repeat 0 { Upper-Body TALK }", LESS),
        ("repeat 2 { IDLE }; Upper-Body TALK", LESS),
        ("repeat 0 { IDLE }; Upper-Body TALK", IDLES),
        ("choose { IDLE | WALK }; Upper-Body TALK", LESS),
        ("choose { 0: IDLE | WALK }; Upper-Body TALK", IDLES),
        ("IDLE; choose { WALK | WALK }; Upper-Body TALK", IDLES),
        ("IDLE; choose { WALK | }; Upper-Body TALK", LESS),
        ("IDLE; choose { WALK | Upper-Body TALK }", LESS),
        ("IDLE; choose { WALK | 0: Upper-Body TALK }", LESS),
        ("IDLE; choose { WALK | WALK; Upper-Body TALK }", IDLES),
        ("IDLE; choose { 2: choose { WALK | end Upper-Body } | WALK }; wait 1 sec; Upper-Body TALK", LESS),
    ],
)
def test_a_command_is_narrowed_over_every_order(script: str, idles: tuple[str, ...], reference: Any) -> None:
    assert {"Full-Body": idles} in commands_of(script, reference)


def test_several_commands_are_narrowed_for_one(reference: Any) -> None:
    found = commands_of("choose { IDLE | Full-Body (IDLE or WALK) | WALK }; Upper-Body TALK", reference)
    less = ("Idle_01", "Walk_01", "Walk_02", "Walk_03", "Music_01", "Talk_01")
    assert found == [{"Full-Body": LESS}, {"Full-Body": less}, {"Full-Body": WALKS}, {"Upper-Body": TALKS}]


def test_a_command_is_narrowed_for_several(catalog: Any) -> None:
    on = {"Body": {"a": ("A",), "b": ("A",), "c": ("A",)}, "Left": {"a": (), "b": (), "l": ()}}
    library = catalog({**on, "Right": {"b": (), "c": (), "r": ()}}, {"Left": "Body", "Right": "Body"}, start="a")
    assert commands_of("A; choose { Left l | Right r }", library)[0] == {"Body": ("b",)}


@pytest.mark.parametrize(
    ("script", "place", "note"),
    [
        ("choose { Idle_02 | WALK }; Upper-Body TALK", "Upper-Body TALK", "Idle_02"),
        ("repeat 2 { Upper-Body TALK; Idle_02 }", "Upper-Body TALK", "Idle_02"),
        ("repeat 2 { choose { WALK | repeat 2 { Idle_02 } }; Upper-Body TALK }", "Upper-Body TALK", "Idle_02"),
        ("WALK; repeat 0 { Idle_02; Upper-Body TALK }", "Upper-Body TALK", "Idle_02"),
        ("WALK; choose { WALK | 0: Idle_02; Upper-Body TALK }", "Upper-Body TALK", "Idle_02"),
        ("Idle_02; choose { WALK | }; Upper-Body TALK", "Upper-Body TALK", "Idle_02"),
    ],
)
def test_where_one_order_is_impossible_the_later_command_is_at_fault(
    script: str, place: str, note: str, reference: Any
) -> None:
    analysis = analyse(Source(script), reference, start="Talk_01")
    (one,) = (one for one in analysis.diagnostics if one.severity == "error")
    assert one.code == "MS040"
    assert one.span is not None
    assert analysis.source.slice(one.span) == place
    assert [analysis.source.slice(note.span) for note in one.notes if note.span] == [note]


def test_a_mistake_in_a_body_is_told_once_however_often_it_goes_round(codes: Codes, reference: Any) -> None:
    assert codes("repeat 3 { repeat 3 { choose { WLAK | } } }", reference) == ["MS021"]
    assert codes("repeat 3 { Idle_02; Upper-Body TALK; end Full-Body }", reference) == ["MS040", "MS042"]
    assert codes("repeat 3 { Upper-Body TALK; Idle_02; Upper-Body TALK }", reference) == ["MS040"]


@pytest.mark.parametrize(
    "form", ["{}; {}; {}; {}; {}", "repeat 1 {{ {}; {}; {} }}; {}; {}", "repeat 2 {{ WALK; {}; {}; {}; {} }}; {}"]
)
def test_a_narrowing_that_has_gone_well_is_not_taken_back_for_another(form: str, reference: Any) -> None:
    script = form.format("IDLE", "wait 1 sec", "Upper-Body TALK", "Idle_02", "Upper-Body WAVE_HAND")
    analysis = analyse(Source(script), reference)
    (one,) = (one for one in analysis.diagnostics if one.severity == "error")
    assert one.span is not None
    assert analysis.source.slice(one.span) == "Upper-Body WAVE_HAND"


def test_after_a_mistake_in_one_branch_anything_may_be_playing(codes: Codes, reference: Any) -> None:
    assert codes("choose { WLAK | WALK }; Upper-Body TALK; end Upper-Body", reference) == ["MS021"]
    assert codes("choose { WLAK | Idle_02 }; Upper-Body TALK; end Upper-Body", reference) == ["MS021", "MS040"]
    assert codes("choose { WLAK | WALK }; Idle_02; Upper-Body TALK", reference) == ["MS021", "MS040"]


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("repeat 2 { end Upper-Body; Upper-Body TALK }", []),
        ("repeat 1 { end Upper-Body; Upper-Body TALK }", ["MS043"]),
        ("choose { Upper-Body TALK | WALK }; end Upper-Body", []),
        ("choose { 0: Upper-Body TALK | WALK }; end Upper-Body", ["MS043"]),
        ("choose { WALK | IDLE }; end Upper-Body", ["MS043"]),
        ("Upper-Body TALK; choose { WALK | end Upper-Body }; end Upper-Body", ["MS043"]),
        ("Upper-Body TALK; choose { WALK | }; end Upper-Body", []),
        ("Upper-Body TALK; repeat 2 { end Upper-Body }", []),
        ("Upper-Body TALK; end Upper-Body; repeat 2 { end Upper-Body }", ["MS043"]),
    ],
)
def test_an_end_is_warned_of_if_nothing_runs_there_in_any_order(
    script: str, expected: list[str], codes: Codes, reference: Any
) -> None:
    assert codes(script, reference) == expected


def test_a_first_command_in_a_body_is_not_where_the_character_starts(reference: Any) -> None:
    for script in ("repeat 2 { Talk_02 }", "choose { Talk_02 }", "let A = Talk_02\nA"):
        plan = analyse(Source(script), reference).resolved
        assert plan is not None
        assert plan.start == "Idle_01"


def test_a_plan_has_the_bodies_as_they_are_written(reference: Any) -> None:
    script = "repeat 3 { WALK; choose { 2: IDLE | end Upper-Body; wait 1 sec | } }; TALK once"
    plan = analyse(Source(script), reference).resolved
    assert plan is not None
    loop, last = plan.statements
    assert isinstance(loop, Repeat)
    assert loop.count == 3
    walk, choice = loop.body
    assert isinstance(walk, Command)
    assert isinstance(choice, Choose)
    assert [(one.weight, [type(it) for it in one.body]) for one in choice.branches] == [
        (2, [Command]),
        (1, [End, Wait]),
        (1, []),
    ]
    assert isinstance(last, Command)
    assert last.duration == Once()


def test_an_and_is_shared_out_as_every_order_allows(catalog: Any) -> None:
    on = {
        "Body": {"a": ("A",), "c": (), "i": ()},
        "Top": {"b": ("B",), "i": (), "a": ()},
        "Hand": {"b": ("B",), "a": ()},
    }
    library = catalog(on, {"Top": "Body", "Hand": "Body"}, start="i", cut=frozenset({("Top", "a", "b")}))
    assert commands_of("A and B", library) == [{"Body": ("a",), "Hand": ("b",)}]
    assert commands_of("repeat 2 { A and B; i }", library)[0] == {"Body": ("a",), "Hand": ("b",)}


# --- how much work it is ---


@pytest.fixture
def counted_moves(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list of one number: how often a command has been worked out since."""
    moves = [0]
    move = resolve.move

    def counted(*arguments: Any) -> Any:
        moves[0] += 1
        assert moves[0] < 100_000, "this goes on for ever"
        return move(*arguments)

    monkeypatch.setattr(resolve, "move", counted)
    return moves


@pytest.mark.parametrize(
    ("script", "most"),
    [
        ("repeat 1 { " * 60 + "WALK; IDLE" + " }" * 60, 10),
        ("repeat 2 { IDLE; Upper-Body TALK; " * 15 + "WALK; IDLE" + " }" * 15, 1_000),
        ("repeat 1 { IDLE; Upper-Body TALK; " * 60 + "WALK" + "; IDLE; Upper-Body SWING_HAND }" * 60, 5_000),
        ("choose { IDLE | " * 60 + "WALK" + " }" * 60 + "; Upper-Body TALK", 1_000),
        ("repeat 1 { choose { IDLE; Upper-Body TALK | " * 30 + "WALK" + " }; WALK and TALK }" * 30, 2_000),
        ("repeat 2 { " + "IDLE; Upper-Body TALK; " * 1_000 + "}", 10_000),
        ("repeat 2 { " + "Upper-Body TALK; IDLE; " * 1_000 + "}", 10_000),
        ("repeat 2 { " + "repeat 3 { Upper-Body TALK; IDLE; WALK }; " * 500 + "}", 10_000),
        ("repeat 2 { " * 8 + "repeat 3 { Upper-Body TALK; IDLE; WALK }; " * 100 + "}" * 8, 2_000),
        ("repeat 3 { Upper-Body TALK; IDLE; WALK; " * 10 + "}" * 10, 1_000),
        ("repeat 2 { choose { " + " | ".join(["IDLE; Upper-Body TALK"] * 100) + " } }", 1_000),
        ("IDLE; Upper-Body TALK; " * 1_000, 5_000),
        ("repeat 2 { " + "choose { IDLE | WALK; Upper-Body TALK }; " * 700 + "}; Upper-Body TALK", 20_000),
    ],
)
def test_a_command_is_looked_at_few_times_however_loops_are_nested(
    script: str, most: int, reference: Any, counted_moves: list[int]
) -> None:
    analyse(Source(script), reference)
    assert 0 < counted_moves[0] <= most


def test_a_loop_whose_end_takes_back_what_brought_it_about_is_done_with(catalog: Any, counted_moves: list[int]) -> None:
    """With more that may be playing, the body can do less; then less may be playing, so it can do more; and so on."""
    on = {"Body": ("b", "c", "d"), "Top": ("a", "b", "c", "d"), "Hand": ("a", "b", "c", "d")}
    cut = {("Body", "d", "c"), ("Hand", "a", "b"), ("Hand", "a", "d"), *(("Top", "a", other) for other in "bcd")}
    library = catalog(
        {graph: dict.fromkeys(motions, ()) for graph, motions in on.items()},
        {"Top": "Body", "Hand": "Top"},
        start="b",
        cut=frozenset(cut),
    )
    body = "Body (d or c) and Top (b or d) and Hand (c or d or b); end Top"
    analyse(Source(f"Top (a or c or d); repeat 3 {{ {body} }}"), library)
    assert counted_moves[0] < 20
