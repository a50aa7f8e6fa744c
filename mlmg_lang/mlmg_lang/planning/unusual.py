"""Combinations of body parts that are less alike than the library usually has: a warning for each.

How alike is told by the Overall Motion Similarity of what a part does to what the part would do with the graph above.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.resolved import Command, Layer
from mlmg_lang.spelling import listed, some

FAR = 2.5
"""So many times the usual distance is far: of the pairs of a library of varied clips, one in seven."""


def unusual(resolution: Resolution, names: Names, catalog: Catalog) -> Iterator[Diagnostic]:
    """Yield a warning for each layer of a script without errors whose every choice is far from the graph above."""
    for command in resolution.commands:
        for layer in command.layers:
            above = _above(layer, command, resolution, names)
            distances = [catalog.unlikeness(layer.graph, one, other) for one in above for other in layer.candidates]
            # A motion with a clip too short to be compared is infinitely far from all: of that, nothing is known.
            if distances and FAR < min(distances) < inf:
                yield _warning(layer, above, min(distances), names, catalog)


def _above(layer: Layer, command: Command, resolution: Resolution, names: Names) -> tuple[str, ...]:
    """Return the motions that may drive the graph above a layer, as far as they are on its own."""
    higher = names.ancestors(layer.graph)
    named = next((other for other in command.layers if other.graph in higher), None)
    if named is not None:
        motions = frozenset(named.candidates)
    elif not higher:
        return ()
    else:
        state = resolution.states[command.span]
        motions = next(state.parts[graph].motions for graph in higher if graph in state.parts)
    return names.in_order(layer.graph, motions)


def _warning(layer: Layer, above: tuple[str, ...], distance: float, names: Names, catalog: Catalog) -> Diagnostic:
    graph, motions = layer.graph, layer.candidates
    does = "does" if len(motions) == 1 else "do"
    message = (
        f"this may look unnatural: {some(motions)} on `{graph}` {does} not fit {listed(above, 'or')}, "
        f"{distance:.1f} times as far apart as is usual"
    )
    others = [motion for motion in names.motions(graph) if motion not in above]
    best = sorted(others, key=lambda motion: min(catalog.unlikeness(graph, one, motion) for one in above))
    return Diagnostic("MS061", message, layer.span, f"what fits best there: {listed(best[:3])}" if best else None)
