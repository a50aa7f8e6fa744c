"""Fit: what some other candidate always comes before, by its Overall Motion Similarity (OMS), is out.

A part that has to set out takes the candidate that fits best what the graph above plays, of those that it can reach.
What is best for no motion that may play above, from nowhere that the part may set out from, cannot be taken, however it
goes. Where two fit equally well, neither is out: which comes first is for the library to say. The root graph takes what
is reached soonest, so there every candidate may win.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import TypeAlias

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling
from mlmg_lang.spelling import some

_Apart: TypeAlias = Mapping[str, Mapping[str, float]]
"""By motion that may play above, how far each candidate is from it: their OMS over what is usual on the graph."""


def outranked(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of a layer below the root what cannot win."""
    candidates = attempt.left[graph]
    if graph in (attempt.names.root, attempt.begins) or len(candidates) == 1 or not attempt.state.certain:
        return ()
    leaving = attempt.sources(graph).difference(candidates)
    if not leaving:
        return ()
    may_play = [motion for motion in attempt.names.motions(graph) if motion in attempt.driving(graph)]
    apart = {above: {one: attempt.catalog.unlikeness(graph, above, one) for one in candidates} for above in may_play}
    winning = attempt.sources(graph).intersection(candidates).union(_winning(attempt, graph, leaving, apart))
    best = tuple(motion for motion in candidates if motion in winning)
    because = f"{some(best)} {'fits' if len(best) == 1 else 'fit'} better, whatever plays above"
    return tuple(Out(graph, motion, because) for motion in candidates if motion not in winning)


def _winning(attempt: Attempt, graph: str, leaving: Collection[str], apart: _Apart) -> Iterator[str]:
    """Yield the candidates that may be taken by a part that leaves one of some motions."""
    own = attempt.state.parts.get(graph)
    running = frozenset() if own is None else own.motions
    for above, distances in apart.items():
        order = sorted(distances, key=distances.__getitem__)
        for source in running.union((above,)).intersection(leaving):
            first = next((one for one in order if one == above or attempt.reaches(graph, source, one)), order[0])
            yield from (motion for motion in order if distances[motion] == distances[first])
