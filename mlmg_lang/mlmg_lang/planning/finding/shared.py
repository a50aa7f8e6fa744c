"""An `and` that fits nowhere whole: its operands are shared out over graphs that can run at the same time."""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.search import Search, Ways, is_fixed
from mlmg_lang.planning.finding.sets import flattened, motions_on
from mlmg_lang.planning.finding.sharing import share
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.typed import Layer


def shared(motion: syntax.Motion, room: Room, search: Search) -> Ways | Diagnostic | None:
    """Find the ways to share an `and` out; which of them rule 1 allows depends on where the command stands."""
    if not isinstance(motion, syntax.And):
        return None
    operands: list[dict[str, Layer]] = []
    for operand in flattened(motion):
        graphs = search.graphs(operand, room)
        if isinstance(graphs, Diagnostic):
            return graphs
        fixed = is_fixed(operand)
        on = {graph: motions_on(graph, operand, search.names, fixed) for graph in graphs}
        operands.append({graph: Layer(choice, operand.span) for graph, choice in on.items() if choice.motions})
    return share(operands, search.names, motion.span) or None
