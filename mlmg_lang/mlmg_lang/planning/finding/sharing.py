"""An `and` that no motion fits -> the ways to share it out over graphs that run at the same time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod

from mlmg_lang.planning.names import Names
from mlmg_lang.planning.typed import Both, Layer, Layering
from mlmg_lang.source import Span

MAX_WAYS = 32
"""The most ways that are kept; the first that rule 1 allows is taken, mostly the first of all."""
_MAX_TRIED = 20_000


def share(operands: Sequence[Mapping[str, Layer]], names: Names, span: Span) -> tuple[Layering, ...]:
    """Return the ways, the best first: few graphs, then high ones, then earlier operands above later ones.

    Parameters
    ----------
    operands : for each, what it stands for on each graph on which it may be and is not empty.
    span : of the whole `and`.
    """
    if prod(len(on) for on in operands) > _MAX_TRIED:
        return ()
    depth = {graph: names.height(graph) for on in operands for graph in on}

    def preference(graphs: tuple[str, ...]) -> tuple[object, ...]:
        used = set(graphs)
        total = sum(depth[graph][0] for graph in used)
        return len(used), total, [depth[graph][0] for graph in graphs], [depth[graph][1] for graph in graphs]

    ways = []
    for graphs in sorted(product(*operands), key=preference):
        layers = tuple(_layers(operands, graphs, names, span))
        if all(layer.motions for layer in layers):
            ways.append(Layering(layers, shared=True))
        if len(ways) == MAX_WAYS:
            break
    return tuple(ways)


def _layers(
    operands: Sequence[Mapping[str, Layer]], graphs: Sequence[str], names: Names, span: Span
) -> Iterator[Layer]:
    """Yield one choice for each graph: what all operands given to it have in common."""
    for graph in dict.fromkeys(graphs):
        here = tuple(on[graph] for on, given in zip(operands, graphs, strict=True) if given == graph)
        if len(here) == 1:
            yield here[0]
            continue
        kept = set.intersection(*(set(layer.motions) for layer in here))
        motions = names.in_order(graph, kept)
        yield Layer(Both(graph, motions, tuple(layer.choice for layer in here), span), span)
