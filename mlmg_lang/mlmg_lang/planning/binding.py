"""The names of a motion expression -> those that mean nothing, or not what their place asks for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.case import is_shouted, wrong_case
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB, group_of, is_sub
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of, listed, nearest, normal

_MAX_LISTED = 8
"""The most names that a message lists when none is like the one written."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What a name can mean in a script.

    Attributes
    ----------
    definitions : the names that are defined where the expression stands; elsewhere they have been put in.
    open : whether a file that defines more could not be used.
    parameters : of the definition that the expression stands in.
    """

    names: Names
    definitions: frozenset[str]
    open: bool
    parameters: frozenset[str] = frozenset()

    def defines(self, name: syntax.Name) -> bool:
        """Return whether a name is one of the script's own."""
        return normal(name.text) in self.definitions or normal(name.text) in self.parameters


@dataclass(frozen=True, slots=True)
class Unbound:
    """A name that nothing can be played for; `diagnostic` is None where that is reported elsewhere."""

    diagnostic: Diagnostic | None


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


def graph_hints(motion: syntax.Motion, names: Names) -> Iterator[Diagnostic]:
    """Yield the graphs' names that the library spells otherwise."""
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Qualified | syntax.Call):
            name = node.graph if isinstance(node, syntax.Qualified) else node.name
            meant = SUB if is_sub(name) else names.graph(name.text)
            if meant is not None:
                yield from inexact(name, meant)


def inexact(name: syntax.Name, meant: str) -> Iterator[Diagnostic]:
    """Yield a hint if a name is not spelt as it should be."""
    if normal(name.text) != normal(meant):
        message = f"`{name.text}` is spelt `{meant}` in the library"
        right = script_name(meant)
        yield Diagnostic("MS020", message, name.span, f"write `{right}`", fixes=(Fix(name.span, right, safe=True),))


def graph_name(name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    """Yield a name that should be a graph's, if it is not."""
    if is_sub(name) or scope.names.graph(name.text) is not None:
        return
    if not name.sound:
        yield Unbound(None)
    elif is_shouted(name) and not scope.names.places(name.text):
        yield Unbound(wrong_case(name))
    elif scope.names.places(name.text):
        yield Unbound(_not_a_graph(name, scope.names))
    else:
        yield Unbound(_unknown_graph(name, scope.names))


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
                inside = None if scope.defines(name) else group_of(part)
                waiting.extend([(inside, _meant(name, names))] if inside is not None else [])
            case _:
                yield part, on
                if isinstance(part, syntax.Qualified) and isinstance(part.motion, syntax.Call):
                    waiting.append((part.motion, on))


def _meant(graph: syntax.Name, names: Names) -> tuple[str, ...]:
    """Return the graphs that a graph's name, or what stands for one, can mean."""
    if is_sub(graph):
        return names.below((names.root,))
    meant = names.graph(graph.text)
    return names.graphs if meant is None else (meant,)


def _qualified(node: syntax.Qualified, scope: Scope) -> Iterator[Unbound]:
    """Yield what is wrong with `GRAPH NAME`; the two names tell together what was meant."""
    graph, names = node.graph, scope.names
    wrong = list(graph_name(graph, scope))
    if not isinstance(node.motion, syntax.Reference):
        yield from wrong
        return
    name = node.motion.name
    inner = list(_motion_name(name, scope, _meant(graph, names)))
    if wrong and names.graph(name.text) is not None and names.places(graph.text):
        yield Unbound(_swapped(node, names))
    elif wrong and is_shouted(graph):
        yield from wrong
    elif wrong and not inner and names.places(graph.text):
        yield Unbound(_side_by_side(node, names))
    elif wrong and inner and is_shouted(name):
        yield from inner
    elif wrong and inner and not name.quoted and is_slip_of(name.text, "once") and names.places(graph.text):
        yield Unbound(_misspelt_once(name))
    else:
        yield from (*wrong, *inner)


def _called(node: syntax.Call, name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    foreign = scope.open and not is_sub(name) and scope.names.graph(name.text) is None
    if foreign or scope.defines(name) or group_of(node) is None:
        yield Unbound(None)
    else:
        yield from graph_name(name, scope)


def _motion_name(name: syntax.Name, scope: Scope, on: Sequence[str]) -> Iterator[Unbound]:
    """Yield a name that should be a motion's or a tag's, if it is not; `on`: the graphs that it is meant for."""
    if scope.defines(name):
        yield Unbound(None)
        return
    if scope.names.places(name.text):
        return
    if not name.sound or (scope.open and scope.names.graph(name.text) is None):
        yield Unbound(None)
    elif is_shouted(name):
        yield Unbound(wrong_case(name))
    elif scope.names.graph(name.text) is not None or is_sub(name):
        yield Unbound(_graph_alone(name, scope.names))
    else:
        yield Unbound(_unknown(name, scope.names, on))


# --- what to say -----------------------------------------------------------------------------------------


def _unknown(name: syntax.Name, names: Names, on: Sequence[str]) -> Diagnostic:
    message = f"no tag or motion `{name.text}` in this library"
    near = nearest(name.text, (word for graph in on for word in names.spellings_on(graph)))
    near = near or nearest(name.text, names.spellings())
    if not near:
        near_graph = nearest(name.text, names.graphs, limit=1)
        advice = f"there is a graph `{near_graph[0]}`" if near_graph else _all_names(names, on)
        return Diagnostic("MS021", message, name.span, advice)
    fixes = tuple(Fix(name.span, script_name(word), safe=False) for word in near)
    return Diagnostic("MS021", message, name.span, _where(near, names, on), fixes=fixes)


def _where(words: Sequence[str], names: Names, on: Sequence[str]) -> str:
    """Return on which graph there are some names, those of one graph together; of several, the first of `on`."""
    by_graph: dict[str, list[str]] = {}
    for word in words:
        places = names.places(word)
        place = next((graph for graph in on if graph in places), places[0])
        by_graph.setdefault(place, []).append(word)
    return "; ".join(f"on {graph} there is {listed(found, 'or')}" for graph, found in by_graph.items())


def _all_names(names: Names, on: Sequence[str]) -> str | None:
    """Return which tags there are, or motions if there are no tags, unless they are many."""
    known = names.tags(on) or tuple(dict.fromkeys(word for graph in on for word in names.spellings_on(graph)))
    place = f"on {on[0]} " if len(on) == 1 < len(names.graphs) else ""
    return f"{place}there are {listed(known)}" if 0 < len(known) <= _MAX_LISTED else None


def _unknown_graph(name: syntax.Name, names: Names) -> Diagnostic:
    near = nearest(name.text, names.graphs)
    message = f"no graph `{name.text}` in this library"
    advice = f"the graphs are {listed(names.graphs)}" if len(names.graphs) > 1 else f"its one graph is `{names.root}`"
    if near:
        advice = f"there is {listed(near, 'or')}"
    fixes = tuple(Fix(name.span, script_name(graph), safe=False) for graph in near)
    return Diagnostic("MS026", message, name.span, advice, fixes=fixes)


def _not_a_graph(name: syntax.Name, names: Names) -> Diagnostic:
    kind = _kind(name, names)
    message = f"`{name.text}` is a {kind}, not a graph"
    return Diagnostic("MS025", message, name.span, f"the graphs are {listed(names.graphs)}")


def _swapped(node: syntax.Qualified, names: Names) -> Diagnostic:
    graph, motion = names.graph(node.motion.name.text), node.graph
    right = f"{script_name(graph or '')} {script_name(motion.text)}"
    message = f"`{motion.text}` is a {_kind(motion, names)}, not a graph; the graph comes first"
    return Diagnostic("MS025", message, node.span, f"write `{right}`", fixes=(Fix(node.span, right, safe=True),))


def _misspelt_once(name: syntax.Name) -> Diagnostic:
    message = f"`{name.text}` is not a word of the language"
    fix = Fix(name.span, "once", safe=False)
    return Diagnostic("MS019", message, name.span, "did you mean `once`?", fixes=(fix,))


def _side_by_side(node: syntax.Qualified, names: Names) -> Diagnostic:
    first, second = node.graph, node.motion.name
    message = f"`{first.text}` is a {_kind(first, names)}, not a graph: a word is missing before `{second.text}`"
    both = f"{script_name(first.text)} with {script_name(second.text)}"
    advice = f"for both at once, write `{both}`; what comes later stands on a line of its own"
    place = Span(second.span.start, second.span.start)
    return Diagnostic("MS025", message, node.span, advice, fixes=(Fix(place, "with ", safe=False),))


def _graph_alone(name: syntax.Name, names: Names) -> Diagnostic:
    graph = names.graph(name.text) or name.text
    message = f"`{graph}` is a graph, not a motion"
    known = names.spellings_on(graph)[:1] if graph in names.graphs else names.spellings()[:1]
    advice = f"write what it is to do, as in `{script_name(graph)} {script_name(known[0])}`" if known else None
    return Diagnostic("MS024", message, name.span, advice)


def _kind(name: syntax.Name, names: Names) -> str:
    match = names.find_unqualified(names.places(name.text)[0], name.text)
    return "motion" if match is None else match.entry.kind
