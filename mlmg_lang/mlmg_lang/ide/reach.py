"""What stands of a motion expression, and what may be playing -> the graphs that can be named next.

A `with` leaves those that the stages say which would read the finished statement, with what rule 1 lets them play.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.line_parser import read
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.select import select
from mlmg_lang.planning.typed import Layering
from mlmg_lang.source import Source

Below: TypeAlias = tuple[str, Collection[str]]
"""A graph that could be named, and what may be played above it then."""


@dataclass(frozen=True, slots=True)
class Reach:
    """Tells which graphs an expression leaves; `state`: what may be playing before its statement."""

    names: Names
    state: State

    def qualifier(self, own: Sequence[Token]) -> str | None:
        """Return the graph whose name stands before the cursor, or before the innermost group around it."""
        depth = 0
        for at in range(len(own) - 1, -1, -1):
            kind = own[at].type
            if kind == "RIGHT":
                depth += 1
            elif kind == "LEFT" and depth:
                depth -= 1
            elif kind == "LEFT" or at == len(own) - 1:
                named = at - 1 if kind == "LEFT" and at else at
                graph = self._graph_of(own[named], own[:named])
                if graph is not None:
                    return graph
            elif kind == "WITH" and not depth:
                return None
        return None

    def above(self, graph: str, own: Sequence[Token]) -> Collection[str]:
        """Return what may be played above a graph that is named in an expression."""
        left = left_of_with(own)
        rooms = [] if left is None else self.rooms_below(left)
        return next((above for room, above in rooms if room == graph), self.playing(graph))

    def playing(self, graph: str) -> frozenset[str]:
        """Return what may drive the graph above one; of the root, what may drive it."""
        parts, names = self.state.parts, self.names
        above = names.ancestors(graph) or (graph,)
        return next(parts[one].motions for one in above if one in parts)

    def rooms_below(self, motion: Sequence[Token]) -> list[Below]:
        """Return the graphs that a `with` behind a motion leaves; if that is not known, all but the root."""
        way, names = self._way(motion), self.names
        if way is not None:
            return list(self._rooms(way))
        return [
            (graph, names.motions(parent))
            for graph in names.all_levels()
            if (parent := names.parent(graph)) is not None
        ]

    def _graph_of(self, token: Token, before: Sequence[Token]) -> str | None:
        if token.type not in NAMES:
            return None
        if token.text != SUB:
            return self.names.graph(_plain(token))
        left = left_of_with(before)
        return None if left is None else next((graph for graph, _ in self.rooms_below(left)), None)

    def _way(self, motion: Sequence[Token]) -> Layering | None:
        """Return what finished part of a command does."""
        node = read(Source(""), tuple(motion))
        if not isinstance(node, syntax.Command):
            return None
        if any(isinstance(part, syntax.Call) for part in syntax.walk(node)):
            return None
        known = all(self._is_known(part.name) for part in syntax.walk(node) if isinstance(part, syntax.Reference))
        ways = select(node.motion, self.names, Source("")) if known else ()
        return None if isinstance(ways, Diagnostic) or not ways else ways[0]

    def _is_known(self, name: syntax.Name) -> bool:
        return bool(self.names.places(name.text))

    def _rooms(self, way: Layering) -> Iterator[Below]:
        """Yield the graphs that a `with` leaves, and what may be played above each: what rule 1 lets it leave."""
        names = self.names
        layers = {layer.graph: layer for layer in way.layers}
        tops = tuple(graph for graph in layers if not set(names.ancestors(graph)) & set(layers))
        for graph in Room(tuple(layers), tops, way.layers[-1].graph).allowed(names):
            above = next(layers[one] for one in names.ancestors(graph) if one in layers)
            motions = [motion for motion in above.motions if motion in names.motion_set(graph)]
            if motions:
                yield graph, motions


def expression(before: Sequence[Token]) -> Sequence[Token]:
    """Return the motion expression that tokens end with, without the head of a definition before it."""
    if before and before[0].type == "LET":
        depth = 0
        for at, token in enumerate(before):
            depth += (token.type == "LEFT") - (token.type == "RIGHT")
            if token.type == "EQUALS" and depth == 0:
                return before[at + 1 :]
    return before


def left_of_with(own: Sequence[Token]) -> Sequence[Token] | None:
    """Return what stands left of the `with` that tokens come after, in the same group; None if there is none."""
    depth, with_at = 0, None
    for at in range(len(own) - 1, -1, -1):
        kind = own[at].type
        if kind == "RIGHT":
            depth += 1
        elif kind == "LEFT" and depth == 0:
            return own[at + 1 : with_at] if with_at is not None else left_of_with(own[:at])
        elif kind == "LEFT":
            depth -= 1
        elif kind == "WITH" and depth == 0 and with_at is None:
            with_at = at
    return None if with_at is None else own[:with_at]


def _plain(token: Token) -> str:
    """Return what a name says, without quotes."""
    return token.text[1:-1].replace('\\"', '"').replace("\\\\", "\\") if token.type == "STRING" else token.text
