"""A place in a command -> the graph of the layer that it is in."""

from __future__ import annotations

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.sayings import understood
from mlmg_lang.ide.statements import Statement, statements_at
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span


def graph_at(analysis: Analysis, span: Span) -> str | None:
    """Return the graph of the innermost layer that a span is in; None if there is none, or it is not understood."""
    found = (_graph_in(analysis, statement, span) for statement in statements_at(analysis.made, span.start))
    return next(filter(None, found), None)


def _graph_in(analysis: Analysis, statement: Statement, span: Span) -> str | None:
    item = statement.item
    command = item.command if isinstance(item, syntax.Let) else item
    way = understood(analysis, command).way if isinstance(command, syntax.Command) else None
    layers = () if way is None else way.layers
    spans = [(statement.at(layer.span), layer.graph) for layer in layers]
    around = [(own, graph) for own, graph in spans if own.start <= span.start and span.end <= own.end]
    return min(around, key=lambda one: one[0].end - one[0].start)[1] if around else None
