"""An expression that stands for nothing: the reason is told."""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.search import Search, is_fixed
from mlmg_lang.planning.nothing import Room, nothing_found


def nowhere(motion: syntax.Motion, room: Room, search: Search) -> Diagnostic:
    """Say why no rule before this one has found anything."""
    graphs = search.graphs(motion, room)
    if not isinstance(graphs, Diagnostic):
        return nothing_found(motion, graphs, room, search.names, search.source, chosen=is_fixed(motion))
    if not isinstance(motion, syntax.And):
        return graphs
    return nothing_found(motion, room.allowed(search.names), room, search.names, search.source, chosen=False)
