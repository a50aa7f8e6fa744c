"""Scripts with loops and choices, held against everything that may happen when they are played.

`Character` is LANGUAGE 5 and 6 said slowly: it knows no plan and no narrowing, and follows every order and every
choice.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_lang.diagnostics import has_errors
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.planning import resolved, typed
from mlmg_lang.source import Source, Span

pytestmark = pytest.mark.hypothesis
Playing = frozenset[tuple[str, str]]
"""The motion of each graph that runs."""
Wanted = Mapping[str, Sequence[str]]
"""By graph, the candidates."""


@dataclass(frozen=True)
class Order:
    """A command, in whichever plan."""

    wanted: Wanted
    once: bool
    span: Span


def order_of(command: typed.Command | resolved.Command) -> Order:
    if isinstance(command, typed.Command):
        wanted = {layer.graph: layer.motions for layer in command.ways[0].layers}
        return Order(wanted, command.once, command.span)
    once = isinstance(command.duration, resolved.Once)
    return Order({layer.graph: layer.candidates for layer in command.layers}, once, command.span)


@dataclass
class Character:
    """Performs a plan in every way that it may be performed.

    Attributes
    ----------
    restless : whether a graph that plays a candidate already may go to another all the same. So it is while later
        commands may still take candidates away.
    stuck : where, on which graph and why it could not go on.
    running : by the span of each `end`, whether the part was running in some case.
    """

    library: Any
    restless: bool = False
    stuck: list[tuple[Span, str, str]] = field(default_factory=list)
    running: dict[Span, bool] = field(default_factory=dict)

    def perform(self, statements: Iterable[Any], cases: set[Playing], *, endlessly: bool = False) -> set[Playing]:
        """Return all that may be playing after some statements; `endlessly`: loops go round any number of times."""
        for statement in statements:
            match statement:
                case typed.Command() | resolved.Command():
                    order = order_of(statement)
                    cases = {after for case in cases for after in self._obey(case, order)}
                case typed.End(graph) | resolved.End(graph):
                    runs = any(graph in dict(case) for case in cases)
                    self.running[statement.span] = self.running.get(statement.span, False) or runs
                    cases = {self._ended(case, [graph]) for case in cases}
                case typed.Repeat(count, body) | resolved.Repeat(count, body):
                    cases = self._repeat(count, body, cases, endlessly)
                case typed.Choose(branches) | resolved.Choose(branches):
                    ends = [(one.weight, self.perform(one.body, cases, endlessly=endlessly)) for one in branches]
                    cases = {case for weight, after in ends if weight for case in after}
        return cases

    def _repeat(self, count: int, body: Iterable[Any], cases: set[Playing], endlessly: bool) -> set[Playing]:
        if count == 0:  # it is checked all the same
            self.perform(body, cases, endlessly=endlessly)
            return cases
        if not endlessly or count == 1:
            for _ in range(count):
                cases = self.perform(body, cases, endlessly=endlessly)
            return cases
        before, after = set(cases), self.perform(body, cases, endlessly=True)
        while not after <= before:
            before |= after
            after = self.perform(body, before, endlessly=True)
        return after

    # --- one command ---

    def _obey(self, case: Playing, order: Order) -> set[Playing]:
        """Return all that may be playing when every part of a command has arrived."""
        below = [graph for graph in self._below(case, order.wanted) if graph not in order.wanted]
        cases = {self._ended(case, below)}
        for depth in range(len(self.library.graphs)):
            level = [graph for graph in self.library.graphs if graph in order.wanted and self._depth(graph) == depth]
            cases = {
                after
                for case in cases
                for changing in self._changing(case, level, order)
                for after in self._changed(case, changing, order)
            }
        return cases

    def _changing(self, case: Playing, level: Sequence[str], order: Order) -> Iterator[list[str]]:
        """Yield which graphs of a level may change: those that are not satisfied; of a restless one, others too.

        One that is to begin anew may stay only if it has just begun.
        """
        must = [graph for graph in level if self._driver(case, graph) not in order.wanted[graph]]
        begins = [graph for graph in level if graph not in must and graph == self._begins(order)]
        content = [graph for graph in level if graph not in must and graph not in begins]
        for number in range(len(content) + 1 if self.restless else 1):
            for some in combinations(content, number):
                yield [*must, *begins, *some]
                if begins and begins[0] in dict(case):
                    yield [*must, *some]

    def _changed(self, case: Playing, changing: Sequence[str], order: Order) -> Iterator[Playing]:
        case = self._ended(case, self._below(case, changing))
        ways = [list(self._ways(case, graph, order)) for graph in changing]
        for taken in product(*ways):
            playing = dict(case)
            for graph, motion in zip(changing, taken, strict=True):
                if motion == self._followed(case, graph) and graph != self._begins(order):
                    playing.pop(graph, None)
                else:
                    playing[graph] = motion
            yield frozenset(playing.items())

    def _ways(self, case: Playing, graph: str, order: Order) -> Iterator[str]:
        """Yield the candidates that a graph can go to; if there is none, the character is stuck."""
        followed, source = self._followed(case, graph), self._driver(case, graph)
        if followed is not None and followed not in self.library.motions(graph):
            self.stuck.append((order.span, graph, "rule 1"))
            return
        found = [
            one
            for one in order.wanted[graph]
            if graph == self._begins(order) or one == followed or self.library.can_reach(graph, source, one)
        ]
        if not found:
            self.stuck.append((order.span, graph, "unreachable"))
        yield from found

    def _ended(self, case: Playing, graphs: Sequence[str]) -> Playing:
        """Return what plays when some parts, and all that run below them, have been given back."""
        below = self._below(case, graphs)
        return frozenset((graph, motion) for graph, motion in case if graph not in graphs and graph not in below)

    # --- who is where ---

    def _begins(self, order: Order) -> str | None:
        """Return the graph that begins its motion anew, to which a blend on the spot leads if nothing else does."""
        highest = sorted(order.wanted, key=lambda graph: (self._depth(graph), self.library.graphs.index(graph)))
        return highest[0] if order.once else None

    def _followed(self, case: Playing, graph: str) -> str | None:
        """Return what the graph above plays."""
        return self._driver(case, self._above(graph)[0]) if self._above(graph) else None

    def _depth(self, graph: str) -> int:
        return len(self._above(graph))

    def _driver(self, case: Playing, graph: str) -> str:
        playing = dict(case)
        return next(playing[one] for one in (graph, *self._above(graph)) if one in playing)

    def _below(self, case: Playing, graphs: Iterable[str]) -> list[str]:
        tops = set(graphs)
        return [graph for graph, _ in case if tops & set(self._above(graph))]

    def _above(self, graph: str) -> list[str]:
        """Return the graphs above one, nearest first."""
        found: list[str] = []
        above = self.library.parent(graph)
        while above is not None:
            found.append(above)
            above = self.library.parent(above)
        return found


# --- small libraries and scripts ---

TREES: list[dict[str, str]] = [
    {"Top": "Body"},
    {"Top": "Body", "Hand": "Top"},
    {"Left": "Body", "Right": "Body"},
    {"Top": "Body", "Left": "Top", "Right": "Top"},
]


@st.composite
def libraries(draw: st.DrawFn, make: Any, *, loses: bool) -> Any:
    """Draw a library of few motions, not all on all graphs.

    Parameters
    ----------
    loses : a motion that cannot be reached can be reached from none, as in a library that was built; else any pair
        may be cut.
    """
    above = draw(st.sampled_from(TREES))
    shared = ["a", "b", "c", "d"][: draw(st.integers(2, 4))]
    on: dict[str, dict[str, tuple[str, ...]]] = {}
    for graph in ("Body", *above):
        here = [motion for motion in shared if draw(st.integers(0, 3))] or shared[:1]
        own = [f"{graph.lower()}{number}" for number in range(draw(st.integers(0, 2)) if graph != "Body" else 0)]
        on[graph] = dict.fromkeys([*here, *own], ())
    pairs = [(graph, a, b) for graph, motions in on.items() for a in motions for b in motions if a != b]
    if loses:
        lost = draw(st.sets(st.sampled_from([(graph, b) for graph, _, b in pairs]), max_size=3)) if pairs else set()
        cut = {(graph, a, b) for graph, a, b in pairs if (graph, b) in lost}
    else:
        cut = draw(st.sets(st.sampled_from(pairs))) if pairs else set()
    return make(on, above, start=next(iter(on["Body"])), cut=frozenset(cut))


@st.composite
def commands(draw: st.DrawFn, library: Any) -> str:
    parts = []
    for graph in draw(st.lists(st.sampled_from(library.graphs), min_size=1, max_size=3, unique=True)):
        motions = draw(st.lists(st.sampled_from(library.motions(graph)), min_size=1, max_size=3, unique=True))
        parts.append(f"{graph} ({' or '.join(motions)})")
    return " and ".join(parts) + draw(st.sampled_from(["", "", "", " once"]))


@st.composite
def bodies(draw: st.DrawFn, library: Any, depth: int, most: int = 4) -> str:
    items = []
    for _ in range(draw(st.integers(0, most))):
        kind = draw(st.integers(0, 9))
        if kind < 2 and depth:
            items.append(f"repeat {draw(st.integers(0, 3))} {{ {draw(bodies(library, depth - 1, 2))} }}")
        elif kind < 4 and depth:
            branches = draw(st.lists(bodies(library, depth - 1, 2), min_size=1, max_size=3))
            weights = [draw(st.sampled_from(["", "", "2: ", "0: "])) for _ in branches[1:]]
            weighted = (weight + branch for weight, branch in zip(["", *weights], branches, strict=True))
            items.append(f"choose {{ {' | '.join(weighted)} }}")
        elif kind == 4:
            items.append(f"end {draw(st.sampled_from(library.graphs[1:]))}")
        else:
            items.append(draw(commands(library)))
    return "; ".join(items)


@st.composite
def cases(draw: st.DrawFn, make: Any, *, depth: int, loses: bool) -> tuple[Any, str]:
    library = draw(libraries(make, loses=loses))
    return library, draw(bodies(library, depth))


def beginning(library: Any) -> set[Playing]:
    return {frozenset({(library.graphs[0], library.start)})}


def blamed(analysis: Analysis) -> list[Span]:
    spans = []
    for one in analysis.diagnostics:
        if one.code in ("MS040", "MS041"):
            assert one.span is not None
            spans.append(one.span)
    return spans


def happens(span: Span, stuck: Iterable[tuple[Span, str, str]]) -> bool:
    return any(command.start <= span.start and span.end <= command.end for command, _, _ in stuck)


# --- what is held against it ---


@pytest.mark.parametrize("depth", [0, 2], ids=["straight", "looping"])
def test_what_resolves_can_be_played_in_every_order_and_by_every_choice(depth: int, catalog: Any) -> None:
    @settings(max_examples=2 * settings().max_examples)
    @given(cases(catalog, depth=depth, loses=False))
    def holds(case: tuple[Any, str]) -> None:
        library, text = case
        analysis = analyse(Source(text), library)
        if analysis.resolved is not None:
            character = Character(library)
            character.perform(analysis.resolved.statements, beginning(library))
            assert character.stuck == []

    holds()


@pytest.mark.parametrize(("depth", "loses"), [(0, False), (2, True)], ids=["straight", "looping"])
def test_what_is_refused_cannot_be_obeyed_in_some_order_and_by_some_choice(
    depth: int, loses: bool, catalog: Any
) -> None:
    """In a loop what plays on two graphs is not followed as a pair, so with any pairs cut it may be refused in vain."""

    @settings(max_examples=2 * settings().max_examples)
    @given(cases(catalog, depth=depth, loses=loses))
    def holds(case: tuple[Any, str]) -> None:
        library, text = case
        analysis = analyse(Source(text), library)
        assert analysis.plan is not None
        spans = blamed(analysis)
        if spans:
            character = Character(library, restless=True)
            character.perform(analysis.plan.statements, beginning(library), endlessly=True)
            assert any(happens(span, character.stuck) for span in spans)
        else:
            assert not has_errors(analysis.diagnostics)

    holds()


@pytest.mark.parametrize("depth", [0, 2], ids=["straight", "looping"])
def test_an_end_that_is_warned_of_ends_nothing_in_any_order(depth: int, catalog: Any) -> None:
    @settings(max_examples=2 * settings().max_examples)
    @given(cases(catalog, depth=depth, loses=True))
    def holds(case: tuple[Any, str]) -> None:
        library, text = case
        analysis = analyse(Source(text), library)
        if analysis.resolved is not None:
            character = Character(library)
            character.perform(analysis.resolved.statements, beginning(library))
            vain = [one.span for one in analysis.diagnostics if one.code == "MS043" and one.span]
            assert not any(character.running[span] for span in vain)

    holds()


def asked(text: str, library: Any) -> tuple[list[str], list[Any]]:
    """Return what is said of a script, and the candidates of its commands."""
    analysis = analyse(Source(text), library)
    found: list[Any] = []
    waiting: list[Any] = list(analysis.resolved.statements) if analysis.resolved else []
    while waiting:
        match waiting.pop(0):
            case resolved.Repeat(body=body):
                waiting = [*body, *waiting]
            case resolved.Choose(branches):
                waiting = [*(one for branch in branches for one in branch.body), *waiting]
            case resolved.Command(layers):
                found.append({layer.graph: layer.candidates for layer in layers})
            case other:
                found.append(type(other))
    return [one.code for one in analysis.diagnostics], found


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("repeat 1 { ", " }"),
        ("choose { ", " }"),
        ("repeat 2 { }; ", ""),
        ("choose { | }; ", ""),
        ("", "; choose { | }"),
    ],
)
def test_what_changes_nothing_changes_nothing(before: str, after: str, catalog: Any) -> None:
    @given(cases(catalog, depth=1, loses=False))
    def holds(case: tuple[Any, str]) -> None:
        library, text = case
        assert asked(before + text + after, library) == asked(text, library)

    holds()


def test_how_often_a_loop_goes_round_does_not_matter_from_the_second_time_on(catalog: Any) -> None:
    @given(cases(catalog, depth=1, loses=False))
    def holds(case: tuple[Any, str]) -> None:
        library, text = case
        assert asked(f"repeat 2 {{ {text} }}", library) == asked(f"repeat 500 {{ {text} }}", library)

    holds()
