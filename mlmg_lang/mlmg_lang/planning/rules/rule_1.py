"""Rule 1: a part can leave a motion of the graph above only if that motion is on the part's own graph."""

from __future__ import annotations

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def rule_1(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of the layer above one what is not on the lower graph."""
    above = attempt.named_above(graph)
    if above is None:
        return ()
    motions, on = attempt.left[above], attempt.on(graph)
    out = tuple(Out(above, motion, f"it is not on `{graph}`") for motion in motions if motion not in on)
    return out if len(out) < len(motions) else attempt.stopped(graph, above, motions, by_rule_1=True)
