"""What motion expressions find: on which graphs, and which motions there."""

from __future__ import annotations

import gc
from typing import Any
from weakref import ref

import pytest

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.line_parser import read
from mlmg_lang.parsing.syntax import Command
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning.finding.sets import flattened
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.select import select
from mlmg_lang.source import Source

WALKS = ("Walk_01", "Walk_02", "Walk_03")
TALKS = ("Talk_01", "Talk_02")


def found(text: str, library: Any) -> list[dict[str, tuple[str, ...]]] | str:
    """Return the ways to understand an expression, each as motions by graph; or the code of what is wrong."""
    source = Source(text)
    command = read(source, tokenize(source))
    assert isinstance(command, Command)
    ways = select(command.motion, Names(library), source)
    if isinstance(ways, Diagnostic):
        return ways.code
    return [{layer.graph: layer.motions for layer in way.layers} for way in ways]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK", {"Full-Body": WALKS}),
        ("Walk_01", {"Full-Body": ("Walk_01",)}),
        ("SWING_HAND", {"Upper-Body": ("Walk_01", "Walk_02")}),
        ("Upper-Body IDLE", {"Upper-Body": ("Idle_01", "Music_01", "Talk_01")}),
        ("TALK and IDLE", {"Full-Body": ("Talk_01",)}),
        ("Upper-Body (TALK and IDLE)", {"Upper-Body": ("Talk_01",)}),
        ("Upper-Body TALK and IDLE", {"Upper-Body": ("Talk_01",)}),
        ("WALK or SWING_HAND", {"Full-Body": WALKS}),
        ("SWING_HAND or WALK", {"Full-Body": WALKS}),
        ("Upper-Body SWING_HAND or TALK", {"Upper-Body": ("Walk_01", "Walk_02", "Talk_01", "Talk_02")}),
        ("not IDLE", {"Full-Body": (*WALKS, "Talk_02")}),
        ("not SWING_HAND", {"Full-Body": ("Idle_01", "Idle_02", *WALKS, "Music_01", *TALKS)}),
        ("not Upper-Body IDLE", {"Upper-Body": (*WALKS, "Talk_02")}),
        ("TALK and not IDLE", {"Full-Body": ("Talk_02",)}),
        ("Music", {"Full-Body": ("Music_01",)}),
        ("walk_03 or Talk-02", {"Full-Body": ("Walk_03", "Talk_02")}),
        ("Upper-Body walk01", {"Upper-Body": ("Walk_01",)}),
        ("WALK and TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("(WALK and (TALK))", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("TALK and WALK", {"Upper-Body": TALKS, "Full-Body": WALKS}),
        ("WALK and Upper-Body TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("Full-Body WALK and Upper-Body WAVE_HAND", {"Full-Body": WALKS, "Upper-Body": ("Walk_03",)}),
        ("WALK and WAVE_HAND", {"Full-Body": ("Walk_03",)}),
        ("WALK and TALK and IDLE", {"Full-Body": WALKS, "Upper-Body": ("Talk_01",)}),
        ("WALK with Upper-Body TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("WALK with TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("WALK with Sub TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("WALK with sub TALK", {"Full-Body": WALKS, "Upper-Body": TALKS}),
        ("WALK with (TALK and not IDLE)", {"Full-Body": WALKS, "Upper-Body": ("Talk_02",)}),
        ("(WALK with TALK)", {"Full-Body": WALKS, "Upper-Body": TALKS}),
    ],
)
def test_an_expression_finds_its_motions(text: str, expected: dict[str, Any], reference: Any) -> None:
    assert found(text, reference) == [expected]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WAVE", {"Left-Hand": ("Wave_01",)}),
        ("WALK with WAVE", {"Full-Body": WALKS, "Left-Hand": ("Wave_01",)}),
        ("WALK with Sub TALK with Sub WAVE", {"Full-Body": WALKS, "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)}),
        ("WALK with WAVE with TALK", {"Full-Body": WALKS, "Left-Hand": ("Wave_01",), "Upper-Body": TALKS}),
        (
            "WALK with (Upper-Body TALK with Sub WAVE)",
            {"Full-Body": WALKS, "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)},
        ),
        ("(WALK with TALK) with WAVE", {"Full-Body": WALKS, "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)}),
        ("WALK and TALK and WAVE", {"Full-Body": WALKS, "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)}),
        ("Walk_01 with (TALK and WAVE)", {"Full-Body": ("Walk_01",), "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)}),
        ("WALK and TALK with WAVE", {"Full-Body": WALKS, "Upper-Body": TALKS, "Left-Hand": ("Wave_01",)}),
    ],
)
def test_layers_reach_down_to_the_hand(text: str, expected: dict[str, Any], left_hand: Any) -> None:
    ways = found(text, left_hand)
    assert isinstance(ways, list)
    assert ways[0] == expected


def test_parts_beside_each_other_can_both_be_below_the_body(hands: Any) -> None:
    expected = {"Full-Body": WALKS, "Left-Hand": ("Wave_01",), "Right-Hand": ("Point_01",)}
    assert found("WALK with Left-Hand WAVE with Right-Hand POINT", hands) == [expected]
    assert found("WALK with (WAVE and POINT)", hands) == [expected]


def test_an_and_is_shared_out_over_parts_beside_each_other(hands: Any) -> None:
    assert found("Left-Hand WAVE and POINT", hands) == [{"Left-Hand": ("Wave_01",), "Right-Hand": ("Point_01",)}]


def test_of_several_graphs_of_a_level_the_first_with_a_match_is_taken(hands: Any) -> None:
    assert found("WAVE", hands) == [{"Left-Hand": ("Wave_01",)}]
    assert found("WALK with Sub POINT", hands) == [{"Full-Body": WALKS, "Right-Hand": ("Point_01",)}]


def test_ways_are_tried_with_few_graphs_first_then_high_ones_then_in_the_order_of_the_operands(catalog: Any) -> None:
    tags = {"a": ("A",), "b": ("B",)}
    library = catalog({"Body": tags, "Top": tags, "Hand": tags}, {"Top": "Body", "Hand": "Top"}, start="a")
    ways = found("A and B", library)
    assert isinstance(ways, list)
    assert [list(way.items()) for way in ways] == [
        [("Body", ("a",)), ("Top", ("b",))],
        [("Top", ("a",)), ("Body", ("b",))],
        [("Body", ("a",)), ("Hand", ("b",))],
        [("Hand", ("a",)), ("Body", ("b",))],
        [("Top", ("a",)), ("Hand", ("b",))],
        [("Hand", ("a",)), ("Top", ("b",))],
    ]


def test_operands_that_fit_together_share_a_graph(catalog: Any) -> None:
    on = {"Body": {"a": ("A",), "bc": ("B", "C")}, "Top": {"a": (), "bc": ("B", "C")}}
    on["Hand"] = {"bc": ("B",), "c": ("C",)}
    library = catalog(on, {"Top": "Body", "Hand": "Top"}, start="a")
    ways = found("A and B and C", library)
    assert isinstance(ways, list)
    assert ways[0] == {"Body": ("a",), "Top": ("bc",)}


def test_more_ways_than_anyone_can_mean_are_not_tried(catalog: Any) -> None:
    tags = {f"m{at}": (f"T{at}",) for at in range(16)}
    library = catalog({"Body": tags, "Top": tags}, {"Top": "Body"}, start="m0")
    assert found(" and ".join(f"T{at}" for at in range(16)), library) == "MS032"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("Upper-Body WALK", "MS022"),
        ("Upper-Body (WALK and TALK)", "MS022"),
        ("WALK with Sub WALK", "MS022"),
        ("Upper-Body TALK with Full-Body WALK", "MS030"),
        ("Upper-Body TALK with IDLE", "MS030"),
        ("WALK with Full-Body TALK", "MS031"),
        ("WALK with WALK", "MS031"),
        ("WALK with TALK with IDLE", "MS031"),
        ("WALK with (TALK with Full-Body IDLE)", "MS031"),
        ("Upper-Body (TALK and SWING_HAND)", "MS032"),
        ("Upper-Body TALK and Upper-Body SWING_HAND", "MS032"),
        ("WALK and TALK and Music", "MS032"),
        ("(WALK and TALK) or (WALK and IDLE)", "MS032"),
        ("not (IDLE or not IDLE)", "MS032"),
        ("WALK with TALK with Sub IDLE", "MS033"),
        ("Upper-Body TALK or Full-Body WALK", "MS035"),
        ("Upper-Body (Full-Body WALK)", "MS035"),
    ],
)
def test_an_expression_that_finds_nothing_is_told_why(text: str, code: str, reference: Any) -> None:
    assert found(text, reference) == code


def test_a_name_spelt_exactly_elsewhere_is_not_taken_inexactly_nearer(catalog: Any) -> None:
    library = catalog({"Body": {"a": ("WALK",)}, "Top": {"a": ("Walk",)}}, {"Top": "Body"}, start="a")
    assert found("Walk", library) == [{"Top": ("a",)}]
    assert found("Body Walk", library) == [{"Body": ("a",)}]
    assert found("walk", library) == [{"Body": ("a",)}]


def test_names_are_compared_in_one_unicode_form(catalog: Any) -> None:
    library = catalog({"Körper": {"Gr\u00fc\u00dfen": ()}}, {}, start="Gr\u00fc\u00dfen")
    assert found("Gru\u0308\u00dfen", library) == [{"Körper": ("Gr\u00fc\u00dfen",)}]
    assert found("Ko\u0308rper grüßen", library) == [{"Körper": ("Gr\u00fc\u00dfen",)}]


def test_an_and_inside_an_and_is_flattened() -> None:
    source = Source("A and (B and (C and D)) and not (E and F)")
    command = read(source, tokenize(source))
    assert isinstance(command, Command)
    assert [source.slice(part.span) for part in flattened(command.motion)] == ["A", "B", "C", "D", "not (E and F)"]


def test_what_has_found_an_expression_is_gone_when_it_is_found(hands: Any) -> None:
    source = Source("WALK with Upper-Body TALK")
    command = read(source, tokenize(source))
    assert isinstance(command, Command)
    names = Names(hands)
    gone = ref(names)
    gc.disable()  # which would take what keeps itself, but much later
    try:
        select(command.motion, names, source)
        del names
        assert gone() is None
    finally:
        gc.enable()
