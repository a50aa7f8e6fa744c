"""Commands that are left as soon as they are reached, where that is certain: a hint for each.

Without `for` the next statement begins on arrival. That surprises people, who wrote a motion to see it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.resolved import Command, Layer, Statement
from mlmg_lang.source import Span


def left_at_once(resolution: Resolution, names: Names) -> Iterator[Diagnostic]:
    """Yield a hint for each command of a script without mistakes that moves something and is certain to be left."""
    for body in resolution.bodies:
        yield from _in_body(body, resolution, names)


def _in_body(body: tuple[Statement, ...], resolution: Resolution, names: Names) -> Iterator[Diagnostic]:
    for command, following in pairwise(body):
        if not isinstance(command, Command) or not isinstance(following, Command) or command.duration is not None:
            continue
        state = resolution.states[command.span]
        moved = (layer for layer in command.layers if _surely_moves(layer, command, state, names))
        graph = next((layer.graph for layer in moved if _surely_leaves(layer, following, names)), None)
        if graph is not None:
            yield _hint(command, graph)


def _surely_moves(layer: Layer, command: Command, state: State, names: Names) -> bool:
    """Return whether nothing that may drive a graph when its turn comes is a candidate already."""
    named = {other.graph: other.candidates for other in command.layers}
    above = next((graph for graph in names.ancestors(layer.graph) if graph in named), None)
    own = state.parts.get(layer.graph)
    driving = set(own.motions) if own is not None else set()
    if above is not None:
        driving |= set(named[above])
    elif own is None:
        running = next(graph for graph in names.ancestors(layer.graph) if graph in state.parts)
        driving |= state.parts[running].motions
    return driving.isdisjoint(layer.candidates)


def _surely_leaves(layer: Layer, following: Command, names: Names) -> bool:
    """Return whether the next command takes another motion where `layer` moved to one, or ends the part."""
    named = {other.graph: other.candidates for other in following.layers}
    if layer.graph in named:
        return set(named[layer.graph]).isdisjoint(layer.candidates)
    return any(graph in named for graph in names.ancestors(layer.graph))


def _hint(command: Command, graph: str) -> Diagnostic:
    end = Span(command.span.end, command.span.end)
    message = f"this is left as soon as it is reached: the next command changes `{graph}`"
    fix = Fix(end, " for 3 sec", safe=False)
    return Diagnostic("MS047", message, command.span, "to see it, write how long, as in `for 3 sec`", fixes=(fix,))
