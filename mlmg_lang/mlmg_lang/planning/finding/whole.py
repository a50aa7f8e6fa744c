"""A set of motions: it is on the first graph, going down the tree, on which it is not empty."""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.search import Search, Ways, is_fixed
from mlmg_lang.planning.finding.sets import motions_on
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.typed import Layer, Layering


def whole(motion: syntax.Motion, room: Room, search: Search) -> Ways | Diagnostic | None:
    """Find an expression whole on one graph."""
    graphs = search.graphs(motion, room)
    if isinstance(graphs, Diagnostic):
        return None
    fixed = is_fixed(motion)
    for graph in graphs:
        choice = motions_on(graph, motion, search.names, fixed)
        if choice.motions:
            return (Layering((Layer(choice, motion.span),)),)
    return None
