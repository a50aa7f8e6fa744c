"""Reach: what no motion that may be playing leads to, by the motion table of the graph, is out."""

from __future__ import annotations

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def unreachable(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of a layer what cannot be reached."""
    return tuple(Out(graph, motion, "it cannot be reached") for motion in attempt.unreached(graph))
