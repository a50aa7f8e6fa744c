"""What stands of a motion expression, and what may be playing -> the graphs that can be named next.

A `with` leaves those that the stages say which would read the finished statement, with what rule 1 lets them play;
and a definition is in reach if they find a place for what it says.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final, TypeAlias

from mlmg_lang.definitions.expand import Expander
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.ide.arguments import open_parentheses
from mlmg_lang.ide.combining import Partners, is_inner, left_of_and, partners
from mlmg_lang.ide.outwards import outwards
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.line_parser import read
from mlmg_lang.parsing.structure import SUB, is_sub, motion_mistakes
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.planning.finding.search import Ways
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.select import select
from mlmg_lang.planning.typed import Layering
from mlmg_lang.source import Source

Below: TypeAlias = tuple[str, Collection[str]]
"""A graph that could be named, and what may be played above it then."""
_ENDS_PART: Final = frozenset({"LEFT", "COMMA", "EQUALS"})
"""What begins a group, or an argument of a definition's use."""


class Verdict(IntEnum):
    """How wrong a command is. `SOUND`: not at all, as far as that is known; `FORBIDDEN`: by rule 1 where it stands."""

    SOUND = 0
    FORBIDDEN = 1
    WRONG = 2


@dataclass(frozen=True, slots=True)
class Reach:
    """Tells which graphs an expression leaves; `state`: what may be playing before its statement."""

    names: Names
    definitions: Definitions
    state: State

    def qualifier(self, own: Sequence[Token]) -> tuple[str, ...] | None:
        """Return the graphs that a name before the cursor, or before the innermost group around it, can mean."""
        for at in outwards(own):
            kind = own[at].type
            if kind == "LEFT" or at == len(own) - 1:
                named = at - 1 if kind == "LEFT" and at else at
                graphs = self._graphs_of(own[named], own[:named])
                if graphs:
                    return graphs
            elif kind == "WITH":
                return None
        return None

    def above(self, graph: str, own: Sequence[Token]) -> Collection[str]:
        """Return what may be played above a graph that is named in an expression; nothing if it cannot be there."""
        left = left_of_with(own)
        if left is None:
            return self.playing(graph)
        return next((above for room, above in self.rooms_below(left) if room == graph), ())

    def playing(self, graph: str) -> frozenset[str]:
        """Return what may drive the graph above one; of the root, what may drive it."""
        parts, names = self.state.parts, self.names
        above = names.ancestors(graph) or (graph,)
        return next(parts[one].motions for one in above if one in parts)

    def leaves_room(self, motion: Sequence[Token]) -> bool:
        """Return whether a `with` behind a motion leaves a graph; without a library nobody knows of graphs."""
        return not self.names.motions(self.names.root) or bool(self.rooms_below(motion))

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

    def partners(
        self, own: Sequence[Token], graphs: Sequence[str], named: Collection[str], *, whole: bool
    ) -> Partners | None:
        """Return what names do behind an expression that ends with `and`; None if nothing is known of that.

        Parameters
        ----------
        graphs : that what `and` joins can be on. named : of these, those that what stands behind it can be on.
        whole : whether all that it joins has to be on one of them.
        """
        left = left_of_and(own)
        node = self._said(left) if left else None
        if not isinstance(node, syntax.Command) or any(isinstance(part, syntax.With) for part in syntax.walk(node)):
            return None
        return partners(node.motion, graphs, named, self._tops(own), self.names, whole=whole or is_inner(own))

    def _tops(self, own: Sequence[Token]) -> dict[str, Collection[str]]:
        """Return, by graph that what is written next can be on, what may be played above it then."""
        left, names = left_of_with(own), self.names
        if left is not None:
            return dict(self.rooms_below(left))
        above = ((graph, self.playing(graph)) for graph in names.all_levels())
        return {graph: motions for graph, motions in above if graph == names.root or motions & names.motion_set(graph)}

    def judged(self, command: Sequence[Token]) -> Verdict:
        """Return how wrong the tokens of a command are where it stands."""
        ways = self._ways(command)
        if ways is None or any(self._may_be_driven(way) for way in ways):
            return Verdict.SOUND
        return Verdict.FORBIDDEN if ways else Verdict.WRONG

    def left_on(self, graph: str, command: Sequence[Token]) -> frozenset[str]:
        """Return the motions that rule 1 leaves of a graph in the tokens of a command; none if it is wrong."""
        names = self.names
        way = next((way for way in self._ways(command) or () if self._may_be_driven(way)), None)
        layers = {} if way is None else {layer.graph: layer.motions for layer in way.layers}
        below = (names.motion_set(one) for one in layers if graph in names.ancestors(one))
        return frozenset(layers.get(graph, ())).intersection(*below)

    def _may_be_driven(self, way: Layering) -> bool:
        """Return whether rule 1 allows each layer below those above it, or below what may be playing."""
        names, layers = self.names, {layer.graph: layer for layer in way.layers}
        for graph in layers:
            drivers = [layers[one].motions for one in names.ancestors(graph) if one in layers]
            above = drivers[0] if drivers else self.playing(graph)
            if graph != names.root and names.motion_set(graph).isdisjoint(above):
                return False
        return True

    def sub(self, motion: Sequence[Token]) -> tuple[str, ...]:
        """Return the graphs that `Sub` can mean behind a `with` after a motion: of those that it leaves."""
        rooms, way = tuple(graph for graph, _ in self.rooms_below(motion)), self._way(motion)
        below = rooms if way is None else self.names.children(way.layers[-1].graph)
        return tuple(graph for graph in rooms if graph in below)

    def _graphs_of(self, token: Token, before: Sequence[Token]) -> tuple[str, ...]:
        if token.type not in NAMES:
            return ()
        if token.text == SUB:
            left = left_of_with(before)
            return () if left is None else self.sub(left)
        graph = self.names.graph(name_from_token(token).text)
        return () if graph is None else (graph,)

    def _way(self, motion: Sequence[Token]) -> Layering | None:
        """Return what a finished part of a command does; None if that is not known."""
        ways = self._ways(motion)
        return ways[0] if ways else None

    def _ways(self, motion: Sequence[Token]) -> Ways | None:
        """Return all that a finished part of a command can do; None if some of it means nothing yet."""
        said = self._said(motion)
        if said is None:
            return None
        if not isinstance(said, syntax.Command) or any(motion_mistakes(said.motion)):
            return ()
        ways = select(said.motion, self.names, Source(""), explains=False)
        return () if isinstance(ways, Diagnostic) else ways

    def _said(self, motion: Sequence[Token]) -> syntax.Item | None:
        """Return a finished part of a command, with what is defined put in if that can be; None if it is not known."""
        node = read(Source(""), tuple(motion))
        if not isinstance(node, syntax.Command):
            return None
        (expanded,) = Expander(self.definitions).body((node,))
        is_known = not isinstance(expanded, syntax.Command) or all(map(self._is_known, syntax.walk(expanded)))
        return expanded if is_known else None

    def _is_known(self, node: syntax.Node) -> bool:
        """Return whether part of an expression in which definitions have been put in is no name without a meaning."""
        if isinstance(node, syntax.Reference):
            return bool(self.names.places(node.name.text))
        if not isinstance(node, syntax.Call) or is_sub(node.name) or self.names.graph(node.name.text) is not None:
            return True
        return bool(self.names.places(node.name.text))

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
    with_at = None
    for at in outwards(own):
        if own[at].type in _ENDS_PART:
            if with_at is not None:
                return own[at + 1 : with_at]
            around = own[: next(iter(open_parentheses(own[: at + 1])), 0)]
            return left_of_with(around)
        if own[at].type == "WITH" and with_at is None:
            with_at = at
    return None if with_at is None else own[:with_at]
