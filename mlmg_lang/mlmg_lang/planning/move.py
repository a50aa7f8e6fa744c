"""One command and what may be playing before it -> what it can do by all `rules`, and what may be playing after it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from mlmg_lang.catalog import Catalog
from mlmg_lang.planning.flow import Part, Setter, State
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import LeftOut
from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Hindrance, Narrow, Stopped
from mlmg_lang.planning.rules.table import RULES, Order, Rule
from mlmg_lang.planning.typed import Layer

PHASES = tuple((order, tuple(rules)) for order, rules in groupby(RULES, lambda rule: rule.order))


@dataclass(frozen=True, slots=True)
class Move:
    """What a command can do: by graph, highest first, the candidates, and why others were left out."""

    candidates: Mapping[str, tuple[str, ...]]
    left_out: Mapping[str, tuple[LeftOut, ...]]
    after: State


def move(
    chosen: Iterable[Layer],
    state: State,
    key: int,
    ruled_out: Mapping[str, Mapping[str, str]],
    library: tuple[Names, Catalog],
    once: bool = False,
) -> Move | Hindrance:
    """Return what a command does.

    Parameters
    ----------
    chosen : one for each graph that it names.
    key : of its step.
    ruled_out : by graph, the candidates that a later command has ruled out, and why.
    once : whether the topmost of its graphs begins its motion anew: no way has to lead there, and it runs by itself.
    """
    names, catalog = library
    layers = {layer.graph: layer for layer in sorted(chosen, key=lambda layer: names.height(layer.graph))}
    begins = next(iter(layers)) if once else None
    left = {graph: layer.motions for graph, layer in layers.items()}
    settled = attempt = Attempt(names, catalog, state, layers, begins, ruled_out, left, dict.fromkeys(layers, ()))
    for order, rules in PHASES:
        asked = _upwards(attempt, rules) if order is Order.UPWARDS else _asked(attempt, tuple(layers), rules)
        if isinstance(asked, Narrow | Stopped):
            return asked
        attempt = asked
        settled = settled if order is Order.LAST else attempt
    return Move(attempt.left, attempt.out, _after(settled, key))


def _upwards(attempt: Attempt, rules: Sequence[Rule]) -> Attempt | Hindrance:
    graphs = tuple(attempt.layers)[::-1]
    before = None
    while before != attempt.left:
        before = attempt.left
        asked = _asked(attempt, graphs, rules)
        if isinstance(asked, Narrow | Stopped):
            return asked
        attempt = asked
    return attempt


def _asked(attempt: Attempt, graphs: Sequence[str], rules: Sequence[Rule]) -> Attempt | Hindrance:
    """Ask rules of graphs, one after the other."""
    for graph in graphs:
        for rule in rules:
            ruling = rule.judge(attempt, graph)
            if isinstance(ruling, Narrow | Stopped):
                return ruling
            if ruling:
                attempt = attempt.without(ruling, rule.name)
    return attempt


# --- what may be playing after it ---


def _after(attempt: Attempt, key: int) -> State:
    """Return the state after a command: it ends what is below its graphs and not named."""
    names, before = attempt.names, attempt.state
    gone = set(names.below(attempt.layers)) - set(attempt.layers)
    kept = {graph: part for graph, part in before.parts.items() if graph not in gone}
    arrived = {graph: _arrived(attempt, graph, key) for graph in attempt.layers}
    return State({**kept, **arrived}, before.certain or names.root in attempt.layers)


def _arrived(attempt: Attempt, graph: str, key: int) -> Part:
    """Return what may drive a graph when it has arrived: any candidate.

    Where it is driven by a candidate already, it will stay; but which candidates a later command leaves
    is not known yet, so that is asked only to see whether the part runs alone.
    """
    motions, sources = frozenset(attempt.left[graph]), attempt.sources(graph)
    runs_on = not motions.isdisjoint(attempt.running(graph))
    joins = len(motions) == 1 and motions == attempt.driving(graph)
    alone = graph == attempt.begins or runs_on or (not sources <= motions and not joins)
    here: frozenset[Setter | None] = frozenset(((key, graph),))
    return Part(dict.fromkeys(attempt.left[graph], here), alone)
