"""One command and what may be playing before it: what it can do, what it asks of earlier ones, or why it cannot be."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.planning import flow
from mlmg_lang.planning.flow import Part, State
from mlmg_lang.planning.move import Move, move
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.rules.ruling import Narrow, Stopped
from mlmg_lang.planning.typed import Layer, Named
from mlmg_lang.source import Span

ON: Mapping[str, tuple[str, ...]] = {
    "Body": ("a", "b", "c"),
    "Top": ("a", "b", "t", "u"),
    "Hand": ("a", "b", "t", "h"),
    "Foot": ("a", "c", "f"),
}
ABOVE = {"Top": "Body", "Hand": "Top", "Foot": "Body"}


class Doing:
    """A small library, and what can be asked of `flow` in it."""

    def __init__(self, catalog: Any, *cut: tuple[str, str, str]) -> None:
        on = {graph: dict.fromkeys(motions, ()) for graph, motions in ON.items()}
        self.catalog = catalog(on, ABOVE, start="a", cut=frozenset(cut))
        self.names = Names(self.catalog)

    def begin(self, motion: str = "a") -> State:
        return flow.begin(self.names, motion)

    def move(self, state: State, number: int = 0, once: bool = False, **wanted: str) -> Move | Narrow | Stopped:
        """Ask for a command: by graph, the candidates as one word."""
        layers = [
            Layer(Named(graph, tuple(motions), "x", Kind.TAG, "x", Span(0, 1)), Span(at, at + 1))
            for at, (graph, motions) in enumerate(wanted.items())
        ]
        return move(layers, state, number, {}, (self.names, self.catalog), once)

    def after(self, state: State, number: int = 0, once: bool = False, **wanted: str) -> State:
        moved = self.move(state, number, once, **wanted)
        assert isinstance(moved, Move), moved
        return moved.after

    def candidates(self, state: State, once: bool = False, **wanted: str) -> dict[str, str]:
        moved = self.move(state, 0, once, **wanted)
        assert isinstance(moved, Move), moved
        return {graph: "".join(motions) for graph, motions in moved.candidates.items()}

    def either(self, *states: State) -> State:
        return flow.joined(states, self.names)


@pytest.fixture
def doing(catalog: Any) -> Doing:
    return Doing(catalog)


def playing(state: State) -> dict[str, str]:
    return {graph: "".join(sorted(part.motions)) for graph, part in state.parts.items()}


# --- what plays after a command ---


def test_at_the_start_the_whole_body_plays_and_nothing_else(doing: Doing) -> None:
    assert playing(doing.begin("b")) == {"Body": "b"}


def test_after_a_command_its_graphs_are_in_one_of_its_candidates(doing: Doing) -> None:
    assert playing(doing.after(doing.begin(), Body="bc", Foot="f")) == {"Body": "c", "Foot": "f"}
    assert playing(doing.after(doing.begin(), Top="tu")) == {"Body": "a", "Top": "tu"}


def test_a_command_ends_what_is_below_its_graphs_and_not_named(doing: Doing) -> None:
    state = doing.after(doing.after(doing.begin(), Body="a", Top="t", Hand="h"), Foot="f")
    assert playing(doing.after(state, Top="u")) == {"Body": "a", "Foot": "f", "Top": "u"}
    assert playing(doing.after(state, Body="a")) == {"Body": "a"}


def test_what_is_beside_and_above_goes_on(doing: Doing) -> None:
    state = doing.after(doing.begin(), Foot="f")
    assert playing(doing.after(state, Top="t")) == {"Body": "a", "Foot": "f", "Top": "t"}


def test_an_end_takes_what_is_below_with_it(doing: Doing) -> None:
    state = doing.after(doing.begin(), Body="a", Top="t", Hand="h")
    assert playing(flow.ended(state, "Top", doing.names)) == {"Body": "a"}
    assert playing(flow.ended(state, "Foot", doing.names)) == playing(state)


def test_who_set_a_graph_is_known(doing: Doing) -> None:
    state = doing.after(doing.after(doing.begin(), 3, Body="ab"), 7, Top="t")
    assert state.parts["Body"].setters("ab") == {(3, "Body")}
    assert state.parts["Top"].setters("t") == {(7, "Top")}
    assert doing.begin().parts["Body"].setters("a") == {None}


def test_a_part_runs_alone_unless_it_is_sure_to_follow(doing: Doing) -> None:
    assert doing.after(doing.begin(), Top="t").parts["Top"].alone
    assert doing.after(doing.begin(), Top="ta").parts["Top"].alone is False  # it is satisfied, so it follows
    assert doing.after(doing.begin(), Body="ab", Top="ta").parts["Top"].alone
    assert doing.after(doing.after(doing.begin(), Top="t"), Top="a").parts["Top"].alone is False


# --- either of several states ---


def test_of_two_states_anything_may_be_that_is_in_one(doing: Doing) -> None:
    either = doing.either(doing.after(doing.begin(), 1, Body="b"), doing.after(doing.begin(), 2, Body="c"))
    assert playing(either) == {"Body": "bc"}
    assert either.parts["Body"].setters("b") == {(1, "Body")}
    assert either.parts["Body"].setters("bc") == {(1, "Body"), (2, "Body")}


def test_a_part_that_runs_in_one_state_alone_may_follow(doing: Doing) -> None:
    either = doing.either(doing.after(doing.begin("b"), Top="t"), doing.begin("b"))
    assert playing(either) == {"Body": "b", "Top": "bt"}
    assert either.parts["Top"].following == {"b"}
    assert either.parts["Top"].alone


def test_what_a_part_may_play_alone_is_not_only_followed(doing: Doing) -> None:
    alone = doing.after(doing.begin("a"), Top="b")
    either = doing.either(doing.either(alone, doing.begin("a")), doing.begin("b"))
    assert playing(either)["Top"] == "ab"
    assert either.parts["Top"].following == {"a"}


def test_after_a_mistake_anything_may_be(doing: Doing) -> None:
    unknown = flow.unknown(doing.names)
    assert playing(unknown) == {"Body": "abc"}
    assert not unknown.certain
    assert not doing.either(doing.begin(), unknown).certain
    assert doing.after(unknown, Body="b").certain
    assert not doing.after(unknown, Foot="f").certain


PARTS = st.dictionaries(
    st.sampled_from(["Top", "Hand", "Foot"]),
    st.tuples(st.sets(st.sampled_from("abth"), min_size=1), st.booleans()),
)
STATES = st.tuples(st.sets(st.sampled_from("abc"), min_size=1), PARTS, st.booleans())


def state_of(body: Iterable[str], parts: Mapping[str, tuple[set[str], bool]], certain: bool, number: int) -> State:
    def part(graph: str, motions: Iterable[str], alone: bool) -> Part:
        return Part({motion: frozenset([(number, graph)]) for motion in motions}, alone)

    return State(
        {"Body": part("Body", body, True)} | {g: part(g, m, alone) for g, (m, alone) in parts.items()}, certain
    )


@given(st.lists(STATES, min_size=2, max_size=3))
def test_joining_does_not_depend_on_order_and_takes_nothing_away(left_hand_always: Any, drawn: list[Any]) -> None:
    doing = Doing(type(left_hand_always))
    states = [state_of(*one, number) for number, one in enumerate(drawn)]
    either = doing.either(*states)
    assert doing.either(*reversed(states)) == either
    assert doing.either(either, *states) == either
    for state in states:
        assert not either.certain or state.certain
        for graph, part in state.parts.items():
            assert part.motions <= either.parts[graph].motions
            assert either.parts[graph].alone or not part.alone
            assert part.setters(part.motions) <= either.parts[graph].setters(part.motions)


# --- what a layer asks of the one above ---


def test_a_candidate_above_has_to_be_on_the_part(doing: Doing) -> None:
    assert doing.candidates(doing.begin(), Body="abc", Top="t") == {"Body": "ab", "Top": "t"}
    moved = doing.move(doing.begin(), Body="abc", Top="t")
    assert isinstance(moved, Move)
    assert [(out.motion, out.reason) for out in moved.left_out["Body"]] == [("c", "rule 1")]


def test_what_is_asked_goes_up_from_layer_to_layer(catalog: Any) -> None:
    doing = Doing(catalog, ("Top", "a", "t"))
    assert doing.candidates(doing.begin(), Body="ab", Top="tu", Hand="h") == {"Body": "b", "Top": "t", "Hand": "h"}


def test_what_is_left_out_above_for_one_part_is_left_out_for_all(catalog: Any) -> None:
    """The foot leaves the body `a` and `c`, so the top is in `a` at best, from where it reaches `t`."""
    doing = Doing(catalog, ("Top", "a", "u"))
    assert doing.candidates(doing.begin(), Body="abc", Top="tu", Foot="f") == {"Body": "a", "Top": "t", "Foot": "f"}


def test_a_candidate_from_which_a_part_cannot_go_on_is_left_out(catalog: Any) -> None:
    doing = Doing(catalog, ("Top", "a", "t"))
    moved = doing.move(doing.begin(), Body="ab", Top="t")
    assert isinstance(moved, Move)
    assert moved.candidates["Body"] == ("b",)
    assert [(out.reason, out.because) for out in moved.left_out["Body"]] == [
        ("dead end", "nothing asked of `Top` can be reached from it")
    ]


def test_a_part_can_always_follow_into_one_of_its_own_candidates(catalog: Any) -> None:
    doing = Doing(catalog, ("Top", "a", "b"), ("Top", "a", "t"), ("Top", "t", "a"))
    assert doing.candidates(doing.begin(), Body="a", Top="ab") == {"Body": "a", "Top": "a"}
    running = doing.after(Doing(catalog).begin(), Top="u")
    cut = Doing(catalog, ("Top", "u", "a"))
    assert cut.candidates(running, Top="a") == {"Top": "a"}
    assert cut.candidates(running, Body="a", Top="a") == {"Body": "a", "Top": "a"}


# --- where a part sets out from ---


def test_a_part_that_runs_sets_out_from_its_own_motion_if_all_above_stay(catalog: Any) -> None:
    running = Doing(catalog).after(Doing(catalog).begin(), Top="t")
    from_t_alone = Doing(catalog, ("Top", "a", "u"), ("Top", "b", "u"))
    assert from_t_alone.candidates(running, Body="a", Top="u") == {"Body": "a", "Top": "u"}
    assert isinstance(from_t_alone.move(running, Body="b", Top="u"), Stopped)
    from_a_alone = Doing(catalog, ("Top", "t", "u"))
    assert isinstance(from_a_alone.move(running, Body="a", Top="u"), Stopped)
    assert from_a_alone.candidates(running, Body="b", Top="u") == {"Body": "b", "Top": "u"}


def test_a_candidate_is_left_out_if_what_runs_below_could_not_go_on(catalog: Any) -> None:
    running = Doing(catalog).after(Doing(catalog).begin(), Top="t")
    doing = Doing(catalog, ("Top", "t", "u"))
    assert doing.candidates(running, Body="ab", Top="u") == {"Body": "b", "Top": "u"}
    moved = doing.move(running, Body="ab", Top="u")
    assert isinstance(moved, Move)
    assert [out.because for out in moved.left_out["Body"]] == [
        "nothing asked of `Top` can be reached from what `Top` may play with it"
    ]


def test_a_part_that_may_run_and_may_follow_has_to_be_able_to_go_on_from_both(catalog: Any) -> None:
    doing = Doing(catalog)
    may_run = doing.either(doing.after(doing.begin(), 1, Top="t"), doing.begin())
    assert doing.candidates(may_run, Body="a", Top="u") == {"Body": "a", "Top": "u"}
    assert not isinstance(Doing(catalog, ("Top", "a", "u")).move(may_run, Body="a", Top="u"), Move)
    assert not isinstance(Doing(catalog, ("Top", "t", "u")).move(may_run, Body="a", Top="u"), Move)
    assert Doing(catalog, ("Top", "b", "u")).candidates(may_run, Body="a", Top="u")["Top"] == "u"


def test_a_part_below_one_that_is_ended_is_ended_with_it(catalog: Any) -> None:
    doing = Doing(catalog)
    running = doing.after(doing.begin(), Body="a", Top="t", Hand="h")
    from_h_alone = Doing(catalog, ("Hand", "a", "b"), ("Hand", "t", "b"))
    assert from_h_alone.candidates(running, Hand="b") == {"Hand": "b"}
    assert from_h_alone.candidates(running, Body="a", Top="t", Hand="b")["Hand"] == "b"
    assert isinstance(from_h_alone.move(running, Body="a", Hand="b"), Stopped)
    assert isinstance(from_h_alone.move(running, Body="b", Top="t", Hand="b"), Stopped)
    assert isinstance(from_h_alone.move(running, Body="a", Top="a", Hand="b"), Stopped)


def test_a_part_that_runs_below_one_that_follows_goes_on_if_that_does(catalog: Any) -> None:
    doing = Doing(catalog)
    running = doing.after(doing.begin(), Hand="h")
    assert Doing(catalog, ("Hand", "a", "t")).candidates(running, Top="a", Hand="t") == {"Top": "a", "Hand": "t"}
    assert isinstance(Doing(catalog, ("Hand", "u", "t")).move(running, Top="u", Hand="t"), Stopped)


def test_a_part_that_followed_what_is_not_on_it_does_not_set_out_from_there(catalog: Any) -> None:
    doing = Doing(catalog, ("Top", "a", "u"), ("Top", "b", "u"), ("Top", "t", "u"))
    may_follow = doing.either(doing.after(doing.begin(), Top="t"), doing.begin("c"))
    assert playing(may_follow)["Top"] == "ct"
    assert doing.candidates(may_follow, Body="ab", Top="tu") == {"Body": "ab", "Top": "t"}


# --- what is asked of earlier commands ---


def test_a_command_narrows_all_that_set_what_it_cannot_leave(doing: Doing) -> None:
    either = doing.either(doing.after(doing.begin(), 1, Body="ac"), doing.after(doing.begin(), 2, Body="bc"))
    asked = doing.move(either, 5, Top="t")
    assert asked == Narrow({(1, "Body"): frozenset("c"), (2, "Body"): frozenset("c")}, "Top")


def test_only_those_are_narrowed_that_set_it(doing: Doing) -> None:
    either = doing.either(doing.after(doing.begin(), 1, Body="ab"), doing.after(doing.begin(), 2, Body="bc"))
    assert doing.move(either, 5, Top="t") == Narrow({(2, "Body"): frozenset("c")}, "Top")


def test_a_part_that_must_not_be_where_it_is_narrows_the_command_that_brought_it_there(catalog: Any) -> None:
    running = Doing(catalog).after(Doing(catalog).begin(), 4, Top="tu")
    doing = Doing(catalog, ("Top", "t", "b"))
    assert doing.move(running, 5, Top="b") == Narrow({(4, "Top"): frozenset("t")}, "Top")
    assert doing.move(running, 5, Body="a", Top="b") == Narrow({(4, "Top"): frozenset("t")}, "Top")


def test_what_the_start_brings_cannot_be_narrowed(doing: Doing) -> None:
    stopped = doing.move(doing.begin("c"), 5, Top="t")
    assert isinstance(stopped, Stopped)
    assert (stopped.graph, stopped.above, stopped.motions) == ("Top", "Body", ("c",))
    assert (stopped.by_rule_1, stopped.setter, stopped.within) == (True, None, False)


def test_where_the_start_is_one_of_several_it_is_at_fault(doing: Doing) -> None:
    either = doing.either(doing.begin("c"), doing.after(doing.begin(), 1, Body="abc"))
    stopped = doing.move(either, 5, Top="t")
    assert isinstance(stopped, Stopped)
    assert stopped.motions == ("c",)
    assert stopped.setter == (1, "Body")  # a place in the script says more than the start


def test_where_nothing_is_left_the_command_that_brought_it_is_named(doing: Doing) -> None:
    stopped = doing.move(doing.after(doing.begin(), 1, Body="c"), 5, Top="t")
    assert isinstance(stopped, Stopped)
    assert (stopped.setter, stopped.motions, stopped.by_rule_1) == ((1, "Body"), ("c",), True)


def test_a_graph_that_was_followed_is_named_where_it_was_set(doing: Doing) -> None:
    either = doing.either(doing.after(doing.begin(), 1, Body="c"), doing.after(doing.begin(), 2, Top="u"))
    assert playing(either)["Top"] == "cu"
    stopped = doing.move(either, 5, Hand="h")
    assert isinstance(stopped, Stopped)
    assert (stopped.setter, stopped.above) == ((1, "Body"), "Body")


def test_where_a_command_stands_in_its_own_way_it_is_said_so(doing: Doing) -> None:
    stopped = doing.move(doing.begin(), Body="c", Top="t")
    assert isinstance(stopped, Stopped)
    assert (stopped.graph, stopped.motions, stopped.within, stopped.by_rule_1) == ("Top", ("c",), True, True)


def test_what_cannot_be_reached_is_told_from_what_rule_1_forbids(catalog: Any) -> None:
    doing = Doing(catalog, ("Body", "a", "b"), ("Top", "b", "t"))
    stopped = doing.move(doing.begin(), Body="b")
    assert isinstance(stopped, Stopped)
    assert not stopped.by_rule_1
    stopped = doing.move(doing.begin("b"), Body="bc", Top="t")
    assert isinstance(stopped, Stopped)
    assert (stopped.by_rule_1, stopped.motions) == (False, ("b",))


def test_where_anything_may_be_playing_one_way_is_enough(catalog: Any) -> None:
    doing = Doing(catalog, ("Body", "a", "b"), ("Body", "c", "b"))
    unknown = flow.unknown(doing.names)
    assert doing.candidates(unknown, Body="b") == {"Body": "b"}
    assert doing.candidates(unknown, Top="t") == {"Top": "t"}
    running = doing.after(unknown, Top="tu")
    cut = Doing(catalog, ("Top", "t", "b"))
    assert isinstance(cut.move(doing.either(running, unknown), Body="abc", Top="b"), Move)


def test_what_a_later_command_has_ruled_out_is_not_taken(doing: Doing) -> None:
    ruled_out = {"Body": {"b": "so"}}
    layers = [Layer(Named("Body", ("a", "b"), "x", Kind.TAG, "x", Span(0, 1)), Span(0, 1))]
    moved = move(layers, doing.begin(), 0, ruled_out, (doing.names, doing.catalog))
    assert isinstance(moved, Move)
    assert moved.candidates == {"Body": ("a",)}
    assert [out.reason for out in moved.left_out["Body"]] == ["later command"]


# --- once ---


def test_what_begins_anew_needs_no_way_there(catalog: Any) -> None:
    doing = Doing(catalog, ("Body", "a", "b"), ("Top", "a", "t"))
    assert isinstance(doing.move(doing.begin(), Body="b"), Stopped)
    assert doing.candidates(doing.begin(), once=True, Body="b") == {"Body": "b"}
    assert doing.candidates(doing.begin(), once=True, Top="t") == {"Top": "t"}
    assert isinstance(doing.move(doing.begin(), once=True, Body="a", Top="t"), Stopped)


def test_rule_1_holds_for_what_begins_anew(doing: Doing) -> None:
    assert isinstance(doing.move(doing.begin("c"), once=True, Top="t"), Stopped)


def test_what_begins_anew_ends_what_runs_below_it(catalog: Any) -> None:
    running = Doing(catalog).after(Doing(catalog).begin(), Top="t")
    from_t_alone = Doing(catalog, ("Top", "a", "u"))
    assert from_t_alone.candidates(running, Body="a", Top="u")["Top"] == "u"
    assert isinstance(from_t_alone.move(running, once=True, Body="a", Top="u"), Stopped)


def test_what_has_nothing_left_to_begin_cannot(doing: Doing) -> None:
    ruled_out = {"Body": {"b": "so"}}
    layers = [Layer(Named("Body", ("b",), "x", Kind.TAG, "x", Span(0, 1)), Span(0, 1))]
    library = (doing.names, doing.catalog)
    assert isinstance(move(layers, doing.begin(), 0, ruled_out, library, once=True), Stopped)


def test_a_part_that_begins_anew_runs_alone_even_if_the_body_plays_the_same(doing: Doing) -> None:
    assert doing.after(doing.begin(), once=True, Top="a").parts["Top"].alone


def test_a_part_that_has_begun_anew_runs_on_when_it_is_asked_for_what_it_plays(doing: Doing) -> None:
    begun = doing.after(doing.begin(), once=True, Top="a")
    assert doing.after(begun, Top="a").parts["Top"].alone
    assert not doing.after(doing.after(doing.begin(), Top="t"), Top="a").parts["Top"].alone
