"""What stands left of an `and` -> the names that can stand right of it.

They have a motion in common with it on some graph, or can be shared out with it over two; see `planning.finding`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.ide.outwards import outwards
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning.finding.search import Search, is_fixed
from mlmg_lang.planning.finding.sets import motions_on
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.source import Source

_ENDS_AND = frozenset({"WITH", "OR", "COMMA", "EQUALS"})


def partners(left: syntax.Motion, graphs: Sequence[str], names: Names, *, whole: bool) -> frozenset[str] | None:
    """Return the names that can stand right of an `and`; None if nobody knows, as what stands left of it is nothing.

    Parameters
    ----------
    left : a set of motions, whose names all mean something.
    graphs : that the two can be on.
    whole : whether both have to be on the same.
    """
    meant = Search(names, Source(""), ()).graphs(left, Room())
    if isinstance(meant, Diagnostic):
        return None
    fixed = is_fixed(left)
    on = {graph: frozenset(motions_on(graph, left, names, fixed).motions) for graph in graphs if graph in meant}
    if not any(on.values()):
        return None
    fitting = {graph: frozenset(on.get(graph, ())) for graph in graphs}
    if not whole:
        for graph in graphs:
            fitting[graph] = fitting[graph].union(*_shared(graph, on, names))
    entries = ((entry, fitting[graph]) for graph in graphs for entry in names.entries(graph))
    return frozenset([entry.name for entry, motions in entries if not motions.isdisjoint(entry.motions)])


def _shared(graph: str, on: Mapping[str, Collection[str]], names: Names) -> Iterator[Collection[str]]:
    """Yield the motions of a graph that can run at the same time as some of other graphs, by rule 1."""
    for other, motions in on.items():
        if not motions or other == graph:
            continue
        if graph in names.ancestors(other):
            yield names.motion_set(other)
        elif other not in names.ancestors(graph) or not names.motion_set(graph).isdisjoint(motions):
            yield names.motion_set(graph)


def left_of_and(own: Sequence[Token]) -> Sequence[Token]:
    """Return what stands left of the `and` that tokens end with, without what that does not join; else nothing."""
    if not own or own[-1].type != "AND":
        return ()
    before = own[:-1]
    ends = (at for at in outwards(before) if before[at].type == "LEFT" or before[at].type in _ENDS_AND)
    return before[next(ends, -1) + 1 :]


def is_inner(own: Sequence[Token]) -> bool:
    """Return whether what comes next stands in a set of motions that cannot be shared out: in an `or` or a `not`."""
    for at in outwards(own):
        kind = own[at].type
        if kind == "OR" or (kind == "LEFT" and at and own[at - 1].type == "NOT"):
            return True
        if kind in _ENDS_AND:
            return False
    return False
