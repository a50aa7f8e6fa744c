"""Motions to which no way leads -> which forbidden transitions are why, if any are.

What the configuration forbids is missing in the motion table, but so is what the clips do not allow: only of the former
can it be said who has to change what.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import product

from mlmg_lang.catalog import Catalog
from mlmg_lang.spelling import some


def why_forbidden(graph: str, sources: Iterable[str], targets: Sequence[str], catalog: Catalog) -> str | None:
    """Say what the library's configuration forbids on a graph that keeps motions from being reached; None if nothing.

    Parameters
    ----------
    sources, targets : motions of the graph; no way leads from any of the first to any of the others.
    """
    sources = tuple(sources)
    for source in sources:
        direct = [target for target in targets if catalog.is_forbidden(graph, source, target)]
        if direct:
            return f"{_forbids(source, some(direct), graph)}, and no way round leads there"
    for source, target in product(sources, targets):
        for leaving, entering in _on_the_way(graph, source, target, catalog):
            return f"{_forbids(leaving, f'`{entering}`', graph)}, where the way would lead"
        if catalog.is_forbidden(graph, target, source):
            return f"{_forbids(target, f'`{source}`', graph)}, and what cannot be left is not entered"
    return None


def _forbids(source: str, targets: str, graph: str) -> str:
    return f"library.toml forbids going from `{source}` to {targets} on `{graph}`"


def _on_the_way(graph: str, source: str, target: str, catalog: Catalog) -> Iterator[tuple[str, str]]:
    """Yield the forbidden transitions that leave one motion or enter another and would make a way between them."""
    for middle in catalog.motions(graph):
        if catalog.is_forbidden(graph, source, middle) and catalog.can_reach(graph, middle, target):
            yield source, middle
        if catalog.is_forbidden(graph, middle, target) and catalog.can_reach(graph, source, middle):
            yield middle, target
