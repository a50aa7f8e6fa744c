"""Reach: what no motion that may be playing leads to, by the motion table of the graph, is out."""

from __future__ import annotations

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def unreachable(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of a layer what cannot be reached; what begins anew, or plays already, needs no way."""
    if graph == attempt.begins:
        return ()
    sources = attempt.sources(graph)
    there = sources | attempt.driving(graph)
    return tuple(
        Out(graph, motion, "it cannot be reached")
        for motion in attempt.left[graph]
        if motion not in there and not any(attempt.reaches(graph, source, motion) for source in sources)
    )
