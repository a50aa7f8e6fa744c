"""`A with B`: A, and then B on a graph below the topmost of A that the command does not use yet."""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.search import Search, Ways
from mlmg_lang.planning.finding.sharing import MAX_WAYS
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.typed import Layering


def layered(motion: syntax.Motion, room: Room, search: Search) -> Ways | Diagnostic | None:
    """Find the operands of a `with`, each in the room that those left of it leave."""
    if not isinstance(motion, syntax.With):
        return None
    ways = search.find(motion.operands[0], room)
    for operand in motion.operands[1:]:
        if isinstance(ways, Diagnostic):
            return ways
        ways = _extended(ways, operand, room, search)
    return ways


def _extended(ways: Ways, operand: syntax.Motion, room: Room, search: Search) -> Ways | Diagnostic:
    """Return each way with an operand of `with` below it; if there is none, why the best has none."""
    found: list[Layering] = []
    problem: Diagnostic | None = None
    for way in ways:
        more = search.find(operand, _below(way, room, search))
        if isinstance(more, Diagnostic):
            problem = problem or more
        else:
            found += [Layering(way.layers + lower.layers, way.shared or lower.shared) for lower in more]
    return tuple(found[:MAX_WAYS]) if found or problem is None else problem


def _below(way: Layering, room: Room, search: Search) -> Room:
    graphs = tuple(layer.graph for layer in way.layers)
    tops = tuple(graph for graph in graphs if not set(search.names.ancestors(graph)) & set(graphs))
    return Room((*room.taken, *graphs), tops, graphs[-1])
