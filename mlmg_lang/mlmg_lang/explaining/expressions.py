"""A motion expression and the way in which it was understood -> the typed operators that it is made of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from mlmg_lang.explaining.explanation import (
    Assigned,
    Expression,
    Named,
    OnGraph,
    PassedOver,
    Place,
    RefusedWay,
    SetExpression,
    SetOperator,
    Shared,
    With,
)
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import is_sub, without_groups
from mlmg_lang.planning import typed
from mlmg_lang.planning.finding.sets import flattened
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.source import Source, Span


def place_of(source: Source, span: Span) -> Place:
    """Return where a span is, with the name of its file."""
    file, _ = source.file(span.start)
    return Place(file.name, source.location(span))


def text_of(source: Source, span: Span) -> str:
    """Return what a span covers, on one line."""
    return " ".join(source.slice(span).split())


def expression_of(
    motion: syntax.Motion, way: typed.Layering, refused: Sequence[RefusedWay], names: Names, source: Source
) -> Expression:
    """Return an expression with its types.

    Parameters
    ----------
    motion : with what is defined put in. way : the assignment that it was understood as.
    refused : the ways to share an `and` out that would have come first.
    """
    described, _ = _Describer(names, source, way.layers, tuple(refused)).motion(motion, Room(), 0)
    return described


@dataclass(frozen=True, slots=True)
class _Describer:
    """Goes through an expression as selecting did; `layers` are those of the way, in the order of the text."""

    names: Names
    source: Source
    layers: tuple[typed.Layer, ...]
    refused: tuple[RefusedWay, ...]

    def motion(self, motion: syntax.Motion, room: Room, at: int) -> tuple[Expression, int]:
        """Return what an expression is, from the layer number `at` on, and the number of the first layer after it."""
        motion = without_groups(motion)
        if not isinstance(motion, syntax.With):
            return self._choice(motion, room, at)
        operands: list[Expression] = []
        end = at
        for operand in motion.operands:
            inside = room if end == at else self._below(room, self.layers[at:end])
            described, end = self.motion(operand, inside, end)
            operands.append(described)
        return With(*self._texts(motion.span), _assigned(self.layers[at:end]), tuple(operands)), end

    def _below(self, room: Room, layers: Iterable[typed.Layer]) -> Room:
        graphs = tuple(layer.graph for layer in layers)
        tops = tuple(graph for graph in graphs if not set(self.names.ancestors(graph)) & set(graphs))
        return Room((*room.taken, *graphs), tops, graphs[-1])

    def _choice(self, motion: syntax.Motion, room: Room, at: int) -> tuple[Expression, int]:
        if isinstance(motion, syntax.And):
            n_operands = len(tuple(flattened(motion)))
            end = self._end_of(motion.span, n_operands, at)
            whole = end == at + 1 and _n_operands(self.layers[at], motion.span) == n_operands
            if not whole:
                return self._shared(motion, room, self.layers[at:end]), end
        layer = self.layers[at]
        by = _graph_by(motion)
        tried = room.allowed(self.names) if by == "search" else ()
        passed = tuple(tried[: tried.index(layer.graph)]) if layer.graph in tried else ()
        set_of = self._set(layer.choice)
        return OnGraph(*self._texts(motion.span), set_of, by, self._passed_over(motion, passed)), at + 1

    def _end_of(self, span: Span, n_operands: int, at: int) -> int:
        """Return the number of the first layer after those of an `and`, which cover all of its operands."""
        while n_operands > 0 and at < len(self.layers):
            n_operands -= _n_operands(self.layers[at], span)
            at += 1
        return at

    def _shared(self, motion: syntax.And, room: Room, layers: Sequence[typed.Layer]) -> Shared:
        by = {part.span: _graph_by(part) for part in flattened(motion)}
        operands = tuple(self._given(layer, by.get(layer.span, "search")) for layer in layers)
        passed = self._passed_over(motion, self._tried(motion, room))
        return Shared(*self._texts(motion.span), _assigned(layers), operands, passed, self.refused)

    def _tried(self, motion: syntax.And, room: Room) -> tuple[str, ...]:
        """Return the graphs on which an `and` was looked for whole: none, if its parts name different ones."""
        named = {self.names.graph(name.text) for name in _graph_names(motion) if not is_sub(name)}
        allowed = room.allowed(self.names)
        return tuple(graph for graph in allowed if named in ({graph}, set()))

    def _given(self, layer: typed.Layer, by: str) -> OnGraph:
        """Return what a graph has been given of an `and`."""
        by = "sharing" if by == "search" else by
        return OnGraph(*self._texts(layer.span), self._set(layer.choice), by, ())

    def _passed_over(self, motion: syntax.Motion, graphs: Iterable[str]) -> tuple[PassedOver, ...]:
        if isinstance(motion, syntax.Reference):
            because = f"there is no `{motion.name.text}`"
        else:
            because = "no motion there has all of this" if isinstance(motion, syntax.And) else "no motion there fits"
        return tuple(PassedOver(graph, because) for graph in graphs)

    # --- on one graph ---

    def _set(self, choice: typed.Choice) -> SetExpression:
        graph, motions = choice.graph, choice.motions
        text, place = self._texts(choice.span)
        match choice:
            case typed.Named(name=name, kind=kind):
                return Named(text, place, graph, motions, name, kind.value)
            case typed.Both(operands=operands):
                return SetOperator("and", text, place, graph, motions, tuple(map(self._set, operands)))
            case typed.Either(operands=operands):
                return SetOperator("or", text, place, graph, motions, tuple(map(self._set, operands)))
            case typed.AllBut(operand=operand):
                return SetOperator("not", text, place, graph, motions, (self._set(operand),))

    def _texts(self, span: Span) -> tuple[str, Place]:
        return text_of(self.source, span), place_of(self.source, span)


def _n_operands(layer: typed.Layer, span: Span) -> int:
    """Return how many operands of the `and` at a span a layer stands for."""
    both = isinstance(layer.choice, typed.Both) and layer.span == span
    return len(layer.choice.operands) if both and isinstance(layer.choice, typed.Both) else 1


def _graph_by(motion: syntax.Motion) -> str:
    """Return whether an expression names its graph."""
    name = next(_graph_names(motion), None)
    if name is None:
        return "search"
    return "Sub" if is_sub(name) else "name"


def _graph_names(motion: syntax.Motion) -> Iterator[syntax.Name]:
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Qualified):
            yield node.graph
        elif isinstance(node, syntax.Call):
            yield node.name


def _assigned(layers: Iterable[typed.Layer]) -> tuple[Assigned, ...]:
    return tuple(Assigned(layer.graph, layer.motions) for layer in layers)
