"""What a rule may ask of a search: on which graphs an expression may be, and what another expression stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import is_sub, without_groups
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room, several_graphs, sub_leads_nowhere, wrong_graph
from mlmg_lang.planning.typed import Layering
from mlmg_lang.source import Source

Ways: TypeAlias = tuple[Layering, ...]
"""The assignments that an expression allows, the best first."""


@dataclass(frozen=True, slots=True)
class Search:
    """The search for what an expression stands for.

    Attributes
    ----------
    rules : in the order in which they are tried; each leaves by None what is not its own to the next.
    """

    names: Names
    source: Source
    rules: tuple[Callable[[syntax.Motion, Room, Search], Ways | Diagnostic | None], ...]

    def find(self, motion: syntax.Motion, room: Room) -> Ways | Diagnostic:
        """Return what an expression stands for in the room that its command leaves it, or why that is nothing."""
        bare = without_groups(motion)
        found = (rule(bare, room, self) for rule in self.rules)
        return next(ways for ways in found if ways is not None)

    def graphs(self, motion: syntax.Motion, room: Room) -> tuple[str, ...] | Diagnostic:
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


def is_fixed(motion: syntax.Motion) -> bool:
    """Return whether a graph's name inside says where the whole expression is."""
    return next(_graph_names(motion), None) is not None


def _graph_names(motion: syntax.Motion) -> Iterator[syntax.Name]:
    """Yield the graphs' names in an expression, in the order of the text."""
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Qualified):
            yield node.graph
        elif isinstance(node, syntax.Call):
            yield node.name
