"""What to say of one name that means nothing, or not what its place asks for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.planning.binding.scope import Scope
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import folded, listed, nearest

_MAX_LISTED = 8
"""The most names that a message lists when none is like the one written."""


def unknown(name: syntax.Name, scope: Scope, on: Sequence[str]) -> Diagnostic:
    """Say that a name is none of the library or the script, and what it is like on the graphs `on`, or elsewhere."""
    names = scope.names
    message = f"no tag or motion `{name.text}` in this library"
    own = (*scope.parameters, *(let.name.text for let in scope.own.values()))
    same = tuple(word for word in own if folded(word) == folded(name.text))
    # Of own names and the library's together, the nearest are among those of each.
    near = same or nearest(name.text, (*own, *names.nearest(name.text, on)))
    near = near or names.nearest(name.text, names.graphs)
    if not near:
        near_graph = nearest(name.text, names.graphs, limit=1)
        advice = f"there is a graph `{near_graph[0]}`" if near_graph else _all_names(names, on)
        return Diagnostic("MS021", message, name.span, advice)
    fixes = tuple(Fix(name.span, script_name(word), safe=len(same) == 1) for word in near)
    return Diagnostic("MS021", message, name.span, _where(near, scope, on), fixes=fixes)


def own_like(name: str, lets: Iterable[syntax.Let]) -> tuple[str, ...]:
    """Return the definitions that can be used with arguments, and whose names look most like one."""
    return nearest(name, (let.name.text for let in lets if let.parameters))


def unknown_definition(name: syntax.Name, near: Sequence[str]) -> Diagnostic:
    """Say what `GREAT(WALK)` is, where there are definitions whose names are near."""
    message = f"`{name.text}` is neither a definition nor a graph"
    fixes = tuple(Fix(name.span, script_name(word), safe=False) for word in near)
    return Diagnostic("MS028", message, name.span, f"there is the definition {listed(near, 'or')}", fixes=fixes)


def _where(words: Sequence[str], scope: Scope, on: Sequence[str]) -> str:
    """Return on which graph there are some names, those of one graph together; of several, the first of `on`."""
    by_place: dict[str, list[str]] = {}
    for word in words:
        kind = scope.kind_of_own(word)
        graphs = () if kind else scope.names.places(word)
        place = f"there is the {kind}" if kind else f"on {next((g for g in on if g in graphs), graphs[0])} there is"
        by_place.setdefault(place, []).append(word)
    return "; ".join(f"{place} {listed(found, 'or')}" for place, found in by_place.items())


def _all_names(names: Names, on: Sequence[str]) -> str | None:
    """Return which tags there are, or motions if there are no tags, unless they are many."""
    known = names.tags(on) or tuple(dict.fromkeys(word for graph in on for word in names.spellings_on(graph)))
    place = f"on {on[0]} " if len(on) == 1 < len(names.graphs) else ""
    return f"{place}there are {listed(known)}" if 0 < len(known) <= _MAX_LISTED else None


def unknown_graph(name: syntax.Name, names: Names) -> Diagnostic:
    """Say that a name that should be a graph is none, and which there are."""
    if name.quoted and name.text.casefold() == SUB.casefold() and len(names.graphs) > 1:
        message = f"in quotes, `{name.text}` is a name like others, and no graph has it"
        fix = Fix(name.span, SUB, safe=False)
        return Diagnostic("MS026", message, name.span, f"for the graph below, write `{SUB}` without them", fixes=(fix,))
    near = nearest(name.text, (*names.graphs, *([SUB] if len(names.graphs) > 1 else [])))
    message = f"no graph `{name.text}` in this library"
    advice = f"the graphs are {listed(names.graphs)}" if len(names.graphs) > 1 else f"its one graph is `{names.root}`"
    if near:
        advice = f"there is {listed(near, 'or')}"
    fixes = tuple(Fix(name.span, script_name(graph), safe=False) for graph in near)
    return Diagnostic("MS026", message, name.span, advice, fixes=fixes)


def not_a_graph(name: syntax.Name, kind: str, names: Names) -> Diagnostic:
    """Say that a name that should be a graph is something else."""
    message = f"`{name.text}` is a {kind}, not a graph"
    return Diagnostic("MS025", message, name.span, f"the graphs are {listed(names.graphs)}")


def before_parenthesis(node: syntax.Call, name: syntax.Name) -> Diagnostic:
    """Say what `x (TALK)` is in a definition, where `x` is a parameter."""
    message = (
        f"`{name.text}` is a parameter, which stands for a motion: it is no graph, and takes nothing in parentheses"
    )
    return Diagnostic("MS025", message, node.span, f"write `{script_name(name.text)}` alone, or a graph before the `(`")


def graph_alone(name: syntax.Name, names: Names) -> Diagnostic:
    """Say what `Upper-Body` is where a motion should stand."""
    graph = names.graph(name.text) or name.text
    message = f"`{graph}` is a graph, not a motion"
    known = names.spellings_on(graph)[:1] if graph in names.graphs else names.spellings()[:1]
    advice = f"write what it is to do, as in `{script_name(graph)} {script_name(known[0])}`" if known else None
    return Diagnostic("MS024", message, name.span, advice)


def kind_of(name: syntax.Name, names: Names) -> str:
    """Return what a name of the library stands for, in a word."""
    match = names.find_unqualified(names.places(name.text)[0], name.text)
    return "motion" if match is None else match.entry.kind
