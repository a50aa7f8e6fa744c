"""Slow, obvious ways to search and to build motion graphs, for comparison."""

import random
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import strategies as st

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import TRANSITION, UNREACHABLE, MotionGraph, Position, Transition
from mlmg_runtime.playing.performer import Performer


class Walk(NamedTuple):
    """What a search should find: frames, costs, which target, and the transitions."""

    n_frames: int
    cost: float
    target: int
    transitions: tuple[Transition, ...]


Soonest = Callable[..., Walk | None]


@pytest.fixture(scope="session")
def soonest() -> Soonest:
    """Return breadth-first search over all frames."""
    return _soonest


@pytest.fixture(scope="session")
def motion_graphs() -> Callable[..., st.SearchStrategy[MotionGraph]]:
    """Return a function of the longest clip's frames that makes random motion graphs.

    They have few different costs, so that ties are common.
    """
    return _motion_graphs


def _soonest(
    graph: MotionGraph,
    start: Position,
    targets: Sequence[int],
    allowed: Collection[int] | None = None,
    later: Mapping[int, Position] | None = None,
) -> Walk | None:
    """Return the walk with the fewest frames, then the least cost, then the earliest target.

    `later` are other places to start from, by the number of frames after which one may.

    Each step shows one frame: the next of a clip, or the next of a transition's k. A state is (motion, frame)
    or (transition, frames shown of it); of the ways to a state, all equally long, the cheapest is kept.
    """
    leaving: dict[Position, list[Transition]] = defaultdict(list)
    for edge in graph.edges:
        leaving[Position(edge.src_motion, edge.src_frame)].append(edge)
    reached = {("clip", *start): (0.0, ())}
    seen = set(reached)
    n_frames = 0
    later = later or {}
    while reached or n_frames < max(later, default=0):
        if n_frames in later:
            reached[("clip", *later[n_frames])] = (0.0, ())
        n_frames += 1
        onward: dict[tuple[object, ...], tuple[float, tuple[Transition, ...]]] = {}
        arrived: list[Walk] = []
        for state, way in reached.items():
            for after, then in _steps(graph, leaving, state, way):
                if after[0] == "clip" and state[0] == "transition":
                    cost, transitions = then
                    if after[1] in targets:
                        arrived.append(Walk(n_frames, cost, targets.index(after[1]), transitions))
                        continue
                    if allowed is not None and after[1] not in allowed:
                        continue
                if after not in seen and (after not in onward or then[0] < onward[after][0]):
                    onward[after] = then
        if arrived:
            return min(arrived, key=lambda walk: (walk.cost, walk.target))
        seen |= onward.keys()
        reached = onward
    return None


def _steps(graph, leaving, state, way):
    kind, *place = state
    cost, transitions = way
    if kind == "transition":
        edge, shown = place
        yield ("transition", edge, shown + 1) if shown + 1 < graph.window else ("clip", *edge.arrival), way
        return
    motion, frame = place
    if frame + 1 < graph.n_frames[motion]:
        yield ("clip", motion, frame + 1), way
    for edge in leaving[motion, frame]:
        yield ("transition", edge, 1), (cost + edge.cost, (*transitions, edge))


@st.composite
def _motion_graphs(draw: st.DrawFn, longest: int) -> MotionGraph:
    n_frames = draw(st.lists(st.integers(6, longest), min_size=1, max_size=4))
    window = draw(st.integers(2, 3))
    motions = st.integers(0, len(n_frames) - 1)
    marks = draw(
        st.lists(
            st.tuples(motions, st.integers(0, 99), motions, st.integers(0, 99), st.integers(0, 3)),
            min_size=draw(st.sampled_from([0, 6])),
            max_size=14,
        )
    )
    edges = {
        (a, i % (n_frames[a] - window + 1), b, window - 1 + j % (n_frames[b] - window)): cost / 4
        for a, i, b, j, cost in marks
    }
    rows = [(*mark, -np.log1p(-cost), cost) for mark, cost in sorted(edges.items())]
    return graph_from(n_frames, window, rows)


def graph_from(n_frames: Sequence[int], window: int, rows: Sequence[tuple[float, ...]]) -> MotionGraph:
    size = len(n_frames)
    names = tuple(f"Motion_{index}" for index in range(size))
    return MotionGraph(
        name="Full-Body",
        parent=None,
        joints=(0,),
        weights=np.ones(1),
        window=window,
        sigma=1.0,
        blend="c1",
        motions=names,
        tags=dict.fromkeys(names, ()),
        n_frames=np.array(n_frames),
        transitions=np.array([tuple(row) for row in rows], dtype=TRANSITION),
        forbidden=np.zeros((size, size), dtype=bool),
        oms=np.ones((size, size)),
        hops=_hops(size, rows),
    )


def _hops(size: int, rows: Sequence[tuple[float, ...]]) -> np.ndarray:
    """Return the fewest transitions between motions, by letting every motion reach one more at a time."""
    hops = np.where(np.eye(size, dtype=bool), 0, UNREACHABLE)
    for _ in range(size):
        for a, _, b, *_ in rows:
            for source in range(size):
                if hops[source, a] != UNREACHABLE:
                    n = hops[source, a] + 1
                    if hops[source, b] == UNREACHABLE or n < hops[source, b]:
                        hops[source, b] = n
    return hops


@pytest.fixture(scope="session")
def motion_graph() -> Callable[..., MotionGraph]:
    """Return a function of the motions' frames, k, and (from, frame, to, frame, cost = 0.5) a transition."""

    def make(n_frames: Sequence[int], window: int, marks: Sequence[tuple[float, ...]]) -> MotionGraph:
        rows = sorted((*mark[:4], 1.0, *(mark[4:] or (0.5,))) for mark in marks)
        return graph_from(n_frames, window, rows)

    return make


@pytest.fixture(scope="session")
def rewired(small_library: Library) -> Callable[..., Library]:
    """Return a function that gives graphs of the small library other transitions.

    Of each graph: (from, frame, to, frame, cost = 0.5) a transition.
    """

    def rewire(marks: Mapping[str, Sequence[tuple[Any, ...]]]) -> Library:
        graphs = dict(small_library.by_name)
        for name, own in marks.items():
            graph = graphs[name]
            rows = sorted((graph.index[a], i, graph.index[b], j, 1.0, *(cost or (0.5,))) for a, i, b, j, *cost in own)
            edges, hops = np.array(rows, dtype=TRANSITION), _hops(len(graph.motions), rows)
            graphs[name] = replace(graph, transitions=edges, hops=hops)
        return replace(small_library, by_name=graphs)

    return rewire


# Random things to ask of a character.


class Move(NamedTuple):
    """Something to ask: numbers that mean something in whatever library and state of things."""

    call: str
    graphs: list[bool]
    candidates: list[int]
    n_frames: int


@pytest.fixture(scope="session")
def moves() -> Callable[[int], list[Move]]:
    """Return a function that makes a few things to ask of a character from a seed."""
    return _moves


def _moves(seed: int) -> list[Move]:
    draw = random.Random(seed)
    return [
        Move(
            draw.choice(["bring", "bring", "bring", "hold", "end"]),
            [draw.random() < 0.5 for _ in range(4)],
            [draw.randint(1, 15) for _ in range(4)],
            draw.randint(0, 200),
        )
        for _ in range(draw.randint(1, 6))
    ]


@pytest.fixture(scope="session")
def ask() -> Callable[[Performer, Move], tuple[str, Any]]:
    """Return a function that asks a move of a performer, and tells what was called with what."""
    return _ask


def _ask(performer: Performer, move: Move) -> tuple[str, Any]:
    what: Any = move.n_frames
    if move.call == "bring":
        what = _layers(performer, move)
    elif move.call == "end":
        what = performer.library.graphs[1:][move.candidates[0] % (len(performer.library.graphs) - 1)]
    getattr(performer, move.call)(what)
    return move.call, what


def _layers(performer: Performer, move: Move) -> list[tuple[str, list[str]]]:
    """Return graphs with candidates that rule 1 allows, whichever of the candidates above are taken."""
    library = performer.library
    layers: list[tuple[str, list[str]]] = []
    drivers: dict[str, list[str]] = {}
    for graph, is_named, number in zip(library.graphs, move.graphs, move.candidates, strict=False):
        parent, motions = library.parent(graph), library.motions(graph)
        below_named = any(name in library.ancestors(graph) for name, _ in layers)
        drivers[graph] = drivers[parent] if below_named else [performer.motion(graph)]
        if is_named and (parent is None or set(drivers[parent]) <= set(motions)):
            chosen = [motion for at, motion in enumerate(motions) if number >> at & 1] or [motions[0]]
            layers.append((graph, chosen))
            drivers[graph] = chosen
    return layers or [(library.root.name, [performer.motion(library.root.name)])]
