"""How an `and` that no motion fits is shared out over graphs, held against trying everything."""

from __future__ import annotations

from functools import cmp_to_key
from itertools import product
from typing import Any, NamedTuple

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.line_parser import read
from mlmg_lang.parsing.syntax import Command
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning.finding.sharing import MAX_WAYS
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.select import select
from mlmg_lang.source import Source

Way = list[tuple[str, tuple[str, ...]]]
"""Graphs in the order of the operands, each with its motions."""


class Operand(NamedTuple):
    """A tag, and the graph that is written before it, if one is."""

    tag: str
    graph: str | None = None

    def __str__(self) -> str:
        return f"{self.graph} {self.tag}" if self.graph else self.tag


def ways_of(library: Any, *operands: Operand | str) -> list[Way]:
    """Return the ways that the planner finds, the best first; none if it reports that there is none."""
    source = Source(" and ".join(map(str, operands)))
    command = read(source, tokenize(source))
    assert isinstance(command, Command)
    ways = select(command.motion, Names(library), source)
    return [] if isinstance(ways, Diagnostic) else [[(layer.graph, layer.motions) for layer in w.layers] for w in ways]


def all_ways(library: Any, operands: list[Operand]) -> list[Way]:
    """Return the same by trying every operand on every graph, and putting what is possible in order."""
    possible = []
    for graphs in product(library.graphs, repeat=len(operands)):
        way = [(graph, _having(library, graph, graphs, operands)) for graph in dict.fromkeys(graphs)]
        as_written = all(operand.graph in (None, graph) for operand, graph in zip(operands, graphs, strict=True))
        if as_written and all(motions for _, motions in way):
            possible.append((graphs, way))
    possible.sort(key=cmp_to_key(lambda a, b: _which_first(library, a[0], b[0])))
    return [way for _, way in possible]


def _having(library: Any, graph: str, graphs: tuple[str, ...], operands: list[Operand]) -> tuple[str, ...]:
    """Return the motions of a graph that have the tags of all operands given to it."""
    wanted = {operand.tag for operand, given in zip(operands, graphs, strict=True) if given == graph}
    return tuple(motion for motion in library.motions(graph) if wanted <= set(library.tags(graph, motion)))


def _which_first(library: Any, a: tuple[str, ...], b: tuple[str, ...]) -> int:
    """Return less than 0 if the graphs of `a`, one for each operand, are to be tried before those of `b`."""
    fewer = len(set(a)) - len(set(b))
    higher = sum(_depth(library, graph) for graph in set(a)) - sum(_depth(library, graph) for graph in set(b))
    earlier = [_depth(library, x) - _depth(library, y) for x, y in zip(a, b, strict=True)]
    in_order = [library.graphs.index(x) - library.graphs.index(y) for x, y in zip(a, b, strict=True)]
    return next((step for step in (fewer, higher, *earlier, *in_order) if step), 0)


def _depth(library: Any, graph: str) -> int:
    above = library.parent(graph)
    return 0 if above is None else 1 + _depth(library, above)


def test_fewer_graphs_go_before_higher_ones(catalog: Any) -> None:
    on = {"Body": {"a": ("A",)}, "Left": {"b": ("B",)}, "Right": {"c": ("C",)}, "Arm": {"a": ()}}
    on["Hand"] = {"bc": ("B", "C")}
    library = catalog(on, {"Left": "Body", "Right": "Body", "Arm": "Left", "Hand": "Arm"}, start="a")
    assert ways_of(library, "A", "B", "C")[:2] == [
        [("Body", ("a",)), ("Hand", ("bc",))],
        [("Body", ("a",)), ("Left", ("b",)), ("Right", ("c",))],
    ]


def test_of_as_many_graphs_those_that_stand_highest_in_total_go_first(catalog: Any) -> None:
    on = {"Body": {"c": ()}, "Chest": {"b": ("B",)}, "Arm": {"a": ("A",)}, "Hand": {"a": ("A",), "b": ("B",)}}
    library = catalog(on, {"Chest": "Body", "Arm": "Chest", "Hand": "Arm"}, start="c")
    assert ways_of(library, "A", "B") == [
        [("Arm", ("a",)), ("Chest", ("b",))],
        [("Hand", ("a",)), ("Chest", ("b",))],
        [("Arm", ("a",)), ("Hand", ("b",))],
    ]


def test_at_the_same_height_earlier_operands_go_above_later_ones(catalog: Any) -> None:
    both = {"a": ("A",), "b": ("B",)}
    on = {"Body": {"c": ()}, "Left": {"c": ()}, "Hand": both, "Right": both}
    library = catalog(on, {"Left": "Body", "Hand": "Left", "Right": "Body"}, start="c")
    assert ways_of(library, "A", "B") == [[("Right", ("a",)), ("Hand", ("b",))], [("Hand", ("a",)), ("Right", ("b",))]]


def test_what_is_left_is_in_the_order_of_the_configuration(catalog: Any) -> None:
    both = {"a": ("A",), "b": ("B",)}
    library = catalog({"Body": {"c": ()}, "Right": both, "Left": both}, {"Right": "Body", "Left": "Body"}, start="c")
    assert ways_of(library, "A", "B") == [[("Right", ("a",)), ("Left", ("b",))], [("Left", ("a",)), ("Right", ("b",))]]


def test_no_more_ways_are_kept_than_anyone_will_try(catalog: Any) -> None:
    graphs = [f"G{at}" for at in range(8)]
    both = {"a": ("A",), "b": ("B",)}
    library = catalog(dict.fromkeys(graphs, both), dict.fromkeys(graphs[1:], "G0"), start="a")
    expected = all_ways(library, [Operand("A"), Operand("B")])
    assert len(expected) == 56
    assert ways_of(library, "A", "B") == expected[:MAX_WAYS]


TAGS = "ABCD"


@st.composite
def questions(draw: st.DrawFn) -> tuple[dict[str, Any], dict[str, str], list[Operand]]:
    """Draw the motions and tags of up to five graphs, the tree that they form, and the operands of an `and`."""
    graphs = [f"G{at}" for at in range(draw(st.integers(1, 5)))]
    above = {graph: graphs[draw(st.integers(0, at))] for at, graph in enumerate(graphs[1:])}
    tags = st.sets(st.sampled_from(TAGS), max_size=2).map(lambda chosen: tuple(sorted(chosen)))
    motions = st.dictionaries(st.sampled_from(["m", "n", "o"]), tags, min_size=1)
    on = {graph: draw(motions) for graph in graphs}
    places = {tag: [graph for graph in graphs if any(tag in own for own in on[graph].values())] for tag in TAGS}
    known = [tag for tag in TAGS if places[tag]]
    assume(known)
    chosen = draw(st.lists(st.sampled_from(known), min_size=2, max_size=4))
    operands = [Operand(tag, draw(st.sampled_from([None, None, *places[tag]]))) for tag in chosen]
    return on, above, operands


@settings(max_examples=4 * settings().max_examples)
@given(questions())
def test_an_and_is_shared_out_as_trying_everything_would(catalog: Any, question: Any) -> None:
    on, above, operands = question
    library = catalog(on, above, start="m")
    expected = all_ways(library, operands)
    if expected and len(expected[0]) == 1:
        expected = expected[:1]  # it fits whole: it is not shared out
    assert ways_of(library, *operands) == expected[:MAX_WAYS]
