"""A motion expression -> the graphs it is on and the motions it stands for there (LANGUAGE, what it finds).

An expression is tried whole on one graph after the other. Only an outermost `and` that fits nowhere is shared
out (`sharing`). Every name in the expression is known to mean something (`binding`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import group_of, is_sub, without_groups
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.nothing import Room, nothing_found, several_graphs, sub_leads_nowhere, wrong_graph
from mlmg_lang.planning.sharing import MAX_WAYS, share
from mlmg_lang.planning.typed import AllBut, Both, Choice, Either, Layer, Layering, Named
from mlmg_lang.source import Source

Ways: TypeAlias = tuple[Layering, ...]


def select(motion: syntax.Motion, names: Names, source: Source) -> Ways | Diagnostic:
    """Return the assignments that an expression allows, the best first, or why there is none."""
    return _Selector(names, source).assign(motion, Room())


@dataclass(frozen=True, slots=True)
class _Selector:
    names: Names
    source: Source

    def assign(self, motion: syntax.Motion, room: Room) -> Ways | Diagnostic:
        """Return what an expression does, in the room that its command leaves it."""
        motion = without_groups(motion)
        if not isinstance(motion, syntax.With):
            return self._choose(motion, room)
        ways = self.assign(motion.operands[0], room)
        for operand in motion.operands[1:]:
            if isinstance(ways, Diagnostic):
                return ways
            ways = self._extended(ways, operand, room)
        return ways

    def _extended(self, ways: Ways, operand: syntax.Motion, room: Room) -> Ways | Diagnostic:
        """Return each way with an operand of `with` below it; if there is none, why the best has none."""
        found: list[Layering] = []
        problem: Diagnostic | None = None
        for way in ways:
            more = self.assign(operand, self._below(way, room))
            if isinstance(more, Diagnostic):
                problem = problem or more
            else:
                found += [Layering(way.layers + lower.layers, way.shared or lower.shared) for lower in more]
        return tuple(found[:MAX_WAYS]) if found or problem is None else problem

    def _below(self, way: Layering, room: Room) -> Room:
        graphs = tuple(layer.graph for layer in way.layers)
        tops = tuple(graph for graph in graphs if not set(self.names.ancestors(graph)) & set(graphs))
        return Room((*room.taken, *graphs), tops, graphs[-1])

    # --- one set of motions ---

    def _choose(self, motion: syntax.Motion, room: Room) -> Ways | Diagnostic:
        """Return the choice on the first graph on which an expression is not empty."""
        graphs = self._graphs(motion, room)
        if not isinstance(graphs, Diagnostic):
            for graph in graphs:
                choice = self._on(graph, motion, self._is_fixed(motion))
                if choice.motions:
                    return (Layering((Layer(choice, motion.span),)),)
        if not isinstance(motion, syntax.And):
            return graphs if isinstance(graphs, Diagnostic) else self._nothing(motion, graphs, room)
        return self._shared(motion, graphs, room)

    def _shared(self, motion: syntax.And, graphs: tuple[str, ...] | Diagnostic, room: Room) -> Ways | Diagnostic:
        """Return the ways to share an `and` out over different graphs."""
        layers: list[dict[str, Layer]] = []
        for operand in flattened(motion):
            own = self._graphs(operand, room)
            if isinstance(own, Diagnostic):
                return own
            fixed = self._is_fixed(operand)
            on = {graph: self._on(graph, operand, fixed) for graph in own}
            found = {graph: Layer(choice, operand.span) for graph, choice in on.items() if choice.motions}
            layers.append(found)
        return share(layers, self.names, motion.span) or self._nothing(motion, graphs, room)

    def _nothing(self, motion: syntax.Motion, graphs: tuple[str, ...] | Diagnostic, room: Room) -> Diagnostic:
        tried = room.allowed(self.names) if isinstance(graphs, Diagnostic) else graphs
        chosen = self._is_fixed(motion) and not isinstance(graphs, Diagnostic)
        return nothing_found(motion, tried, room, self.names, self.source, chosen=chosen)

    # --- which graphs ---

    def _graphs(self, motion: syntax.Motion, room: Room) -> tuple[str, ...] | Diagnostic:
        """Return the graphs that an expression may be on, the likeliest first."""
        written = list(_graph_names(motion))
        if not written:
            return room.allowed(self.names)
        meant = [self._meant(name, room) for name in written]
        common = [graph for graph in meant[0] if all(graph in graphs for graphs in meant)]
        if not meant[0] and is_sub(written[0]):
            return sub_leads_nowhere(written[0], room, self.names)
        if not common:
            return several_graphs(motion, written)
        allowed = [graph for graph in common if graph in room.allowed(self.names)]
        return tuple(allowed) or wrong_graph(written[0], common[0], room, self.names)

    def _meant(self, name: syntax.Name, room: Room) -> tuple[str, ...]:
        if not is_sub(name):
            graph = self.names.graph(name.text)
            return () if graph is None else (graph,)
        return () if room.last is None else self.names.children(room.last)

    def _is_fixed(self, motion: syntax.Motion) -> bool:
        """Return whether a graph's name inside says where the whole expression is."""
        return next(_graph_names(motion), None) is not None

    # --- on one graph ---

    def _on(self, graph: str, motion: syntax.Motion, fixed: bool) -> Choice:
        """Return the motions of a graph that an expression stands for."""
        match motion:
            case syntax.Reference(name):
                return self._named(graph, name, fixed)
            case syntax.Qualified(_, inner) | syntax.Group(inner):
                return self._on(graph, inner, fixed)
            case syntax.Call():
                inside = group_of(motion)
                assert inside is not None, "binding lets no other call through"
                return self._on(graph, inside, fixed)
            case syntax.And():
                operands = tuple(self._on(graph, operand, fixed) for operand in flattened(motion))
                kept = set.intersection(*(set(operand.motions) for operand in operands))
                return Both(graph, self._ordered(graph, kept), operands, motion.span)
            case syntax.Or(parts):
                operands = tuple(self._on(graph, operand, fixed) for operand in parts)
                kept = set().union(*(operand.motions for operand in operands))
                return Either(graph, self._ordered(graph, kept), operands, motion.span)
            case syntax.Not(part):
                operand = self._on(graph, part, fixed)
                kept = set(self.names.motions(graph)) - set(operand.motions)
                return AllBut(graph, self._ordered(graph, kept), operand, motion.span)
            case syntax.With():
                raise AssertionError("structure lets no layers into a set")

    def _named(self, graph: str, name: syntax.Name, fixed: bool) -> Named:
        find = self.names.find if fixed else self.names.find_unqualified
        match = find(graph, name.text)
        if match is None:
            return Named(graph, (), name.text, Kind.TAG, name.text, name.span)
        entry = match.entry
        return Named(graph, entry.motions, entry.name, entry.kind, name.text, name.span)

    def _ordered(self, graph: str, kept: set[str]) -> tuple[str, ...]:
        return tuple(motion for motion in self.names.motions(graph) if motion in kept)


def flattened(motion: syntax.Motion) -> Iterator[syntax.Motion]:
    """Yield the operands of an `and`, those of an `and` among them too."""
    bare = without_groups(motion)
    if isinstance(bare, syntax.And):
        for operand in bare.operands:
            yield from flattened(operand)
    else:
        yield bare


def _graph_names(motion: syntax.Motion) -> Iterator[syntax.Name]:
    """Yield the graphs' names in an expression, in the order of the text."""
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Qualified):
            yield node.graph
        elif isinstance(node, syntax.Call):
            yield node.name
