"""The names of a motion expression -> those that mean nothing, or not what their place asks for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.case import is_shouted, wrong_case
from mlmg_lang.parsing.structure import group_of, is_sub
from mlmg_lang.planning.binding.sayings import (
    before_parenthesis,
    graph_alone,
    kind_of,
    not_a_graph,
    own_like,
    unknown,
    unknown_definition,
    unknown_graph,
)
from mlmg_lang.planning.binding.scope import Scope, Unbound
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import normal


def unbound(motion: syntax.Motion, scope: Scope) -> Iterator[Unbound]:
    """Yield the names of an expression that cannot be played, in the order of the text."""
    for node, on in _parts(motion, scope):
        match node:
            case syntax.Reference(name):
                yield from _motion_name(name, scope, on)
            case syntax.Qualified():
                yield from _qualified(node, scope)
            case syntax.Call(name):
                yield from _called(node, name, scope)


def graph_name(name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    """Yield a name that should be a graph's, if it is not."""
    if is_sub(name) or scope.names.graph(name.text) is not None:
        return
    if not name.sound or normal(name.text) in scope.unread or not scope.explains:
        yield Unbound(None)
    elif is_shouted(name) and not scope.names.places(name.text):
        yield Unbound(wrong_case(name))
    elif scope.names.places(name.text):
        yield Unbound(not_a_graph(name, kind_of(name, scope.names), scope.names))
    elif normal(name.text) in scope.own:
        yield Unbound(not_a_graph(name, "definition", scope.names))
    else:
        yield Unbound(unknown_graph(name, scope.names))


def _parts(motion: syntax.Motion, scope: Scope) -> Iterator[tuple[syntax.Motion, tuple[str, ...]]]:
    """Yield the named parts of an expression, each with the graphs that it is meant for.

    What stands in a part that is reported whole is left out.
    """
    names = scope.names
    waiting: list[tuple[syntax.Motion, tuple[str, ...]]] = [(motion, names.graphs)]
    while waiting:
        part, on = waiting.pop()
        match part:
            case syntax.With(operands):
                lower = tuple(graph for graph in on if graph != names.root) or on
                waiting.extend((operand, lower) for operand in reversed(operands[1:]))
                waiting.append((operands[0], on))
            case syntax.Or(operands) | syntax.And(operands):
                waiting.extend((operand, on) for operand in reversed(operands))
            case syntax.Not(operand):
                waiting.append((operand, on))
            case syntax.Group(inner):
                waiting.append((inner, on))
            case syntax.Call(name):
                yield part, on
                if scope.defines(name):
                    given = (one.value for one in reversed(part.arguments))
                    waiting.extend((one, names.graphs) for one in given if not isinstance(one, syntax.Quantity))
                elif (inside := group_of(part)) is not None:
                    waiting.append((inside, _meant(name, names)))
            case _:
                yield part, on
                if isinstance(part, syntax.Qualified) and isinstance(part.motion, syntax.Call):
                    if any(graph_name(part.graph, scope)):
                        continue
                    waiting.append((part.motion, on))


def _meant(graph: syntax.Name, names: Names) -> tuple[str, ...]:
    """Return the graphs that a graph's name, or what stands for one, can mean."""
    if is_sub(graph):
        return names.below((names.root,))
    meant = names.graph(graph.text)
    return names.graphs if meant is None else (meant,)


def _qualified(node: syntax.Qualified, scope: Scope) -> Iterator[Unbound]:
    """Yield what is wrong with `GRAPH NAME`; the two names tell together what was meant."""
    graph = node.graph
    wrong = list(graph_name(graph, scope))
    if not isinstance(node.motion, syntax.Reference):
        yield from wrong
        return
    name = node.motion.name
    inner = list(_motion_name(name, scope, _meant(graph, scope.names)))
    if not wrong or wrong[0].diagnostic is None:
        yield from wrong or inner
        return
    # Imported here, as most scripts have no such pair.
    from mlmg_lang.planning.binding.pairs import Pair, meant_by

    pair = Pair(node, name, tuple(inner), scope)
    told = meant_by(pair)
    if told is not None:
        yield Unbound(told)
    elif is_shouted(graph):
        yield from wrong
    elif inner and (pair.is_known or is_shouted(name)):
        yield from inner
    else:
        yield from (*wrong, *inner)


def _called(node: syntax.Call, name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    if normal(name.text) in scope.parameters and group_of(node) is not None:
        yield Unbound(before_parenthesis(node, name))
        return
    foreign = scope.open and not is_sub(name) and scope.names.graph(name.text) is None
    if foreign or scope.defines(name) or group_of(node) is None:
        yield Unbound(None)
        return
    wrong = list(graph_name(name, scope))
    if not wrong or not scope.explains or scope.names.places(name.text):
        yield from wrong
        return
    near = own_like(name.text, scope.own.values())
    yield from (Unbound(unknown_definition(name, near)),) if near else wrong


def _motion_name(name: syntax.Name, scope: Scope, on: Sequence[str]) -> Iterator[Unbound]:
    """Yield a name that should be a motion's or a tag's, if it is not; `on`: the graphs that it is meant for."""
    if scope.defines(name):
        yield Unbound(None)
        return
    if scope.names.places(name.text):
        return
    if not name.sound or not scope.explains or (scope.open and scope.names.graph(name.text) is None):
        yield Unbound(None)
    elif is_shouted(name):
        yield Unbound(wrong_case(name))
    elif scope.names.graph(name.text) is not None or is_sub(name):
        yield Unbound(graph_alone(name, scope.names))
    else:
        yield Unbound(unknown(name, scope, on))
