"""What stands left of an `and` -> what each name would do right of it.

It has a motion in common with that on some graph, or is shared out with it over two; see `planning.finding`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

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


class Partner(NamedTuple):
    """What a name does right of an `and`.

    Attributes
    ----------
    graph : that it is on.
    beside : the graph that what stands left is on, if that is another: then the two are shared out.
    """

    graph: str
    beside: str | None


@dataclass(frozen=True, slots=True)
class Partners:
    """What the names of a library do right of an `and`.

    Attributes
    ----------
    above : what may be played above the graphs that names are on then, for each way to be there.
    left : by the same, the motions of the graph that go with what stands left.
    names : by the same, the names that do that.
    """

    above: Mapping[Partner, Collection[str]]
    left: Mapping[Partner, frozenset[str]]
    names: Mapping[Partner, Collection[str]]


def partners(
    left: syntax.Motion,
    graphs: Sequence[str],
    own: Collection[str],
    tops: Mapping[str, Collection[str]],
    names: Names,
    *,
    whole: bool,
) -> Partners | None:
    """Return what names do right of an `and`; None if nobody knows, as what stands left of it is nothing.

    Parameters
    ----------
    left : a set of motions, whose names all mean something.
    graphs : that the two can be on, the likeliest first. own : of these, those that what stands right can be on.
    tops : by graph that can be the topmost of the two, what may be played above it.
    whole : whether both have to be on the same.
    """
    meant = Search(names, Source(""), ()).graphs(left, Room())
    if isinstance(meant, Diagnostic):
        return None
    fixed = is_fixed(left)
    on = {graph: frozenset(motions_on(graph, left, names, fixed).motions) for graph in graphs if graph in meant}
    if not any(on.values()):
        return None
    common = {Partner(graph, None): on[graph] for graph in graphs if graph in on and graph in own}
    shared = {} if whole else dict(_shared(on, own, tops, names))
    fitting = common | {partner: motions for partner, (motions, _) in shared.items()}
    above = {partner: tops.get(partner.graph, ()) for partner in common}
    possible: dict[Partner, frozenset[str]] = {}
    known: frozenset[str] = frozenset()
    for partner, motions in fitting.items():
        entries = names.entries(partner.graph) if motions else ()
        found = frozenset([one.name for one in entries if not motions.isdisjoint(one.motions)]) - known
        known |= found
        # What is the same on one graph is not shared out, and what rule 1 forbids there is nothing.
        if found and (partner.beside is not None or partner.graph in tops):
            possible[partner] = found
    return Partners(above | {partner: over for partner, (_, over) in shared.items()}, fitting, possible)


def _shared(
    on: Mapping[str, frozenset[str]], own: Collection[str], tops: Mapping[str, Collection[str]], names: Names
) -> Iterator[tuple[Partner, tuple[frozenset[str], Collection[str]]]]:
    """Yield the ways to share out what stands on both sides, the best first: see `planning.finding.sharing`.

    With each come the motions of the right one's graph that rule 1 allows then, and what may be played above it.
    """
    pairs = [(left, right) for left, right in product(on, own) if left != right and on[left]]
    height = {graph: names.height(graph) for pair in pairs for graph in pair}
    pairs.sort(
        key=lambda pair: (sum(height[one][0] for one in pair), *zip(*map(height.__getitem__, pair), strict=True))
    )
    for left, right in pairs:
        motions, partner = names.motion_set(right), Partner(right, left)
        if right in names.ancestors(left):
            if right in tops:
                yield partner, (motions & names.motion_set(left), tops[right])
        elif left in names.ancestors(right):
            leaving = on[left] & motions
            if leaving and left in tops:
                yield partner, (motions, leaving)
        elif left in tops and right in tops:
            yield partner, (motions, tops[right])


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
