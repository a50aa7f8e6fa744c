"""Dead ends: a candidate with which a layer below could not go on is out."""

from __future__ import annotations

from mlmg_lang.planning.forbidding import why_forbidden
from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def dead_end(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of the layer above one what the lower one could not go on from, by the motion table of its graph."""
    above = attempt.named_above(graph)
    if above is None:
        return ()
    motions = attempt.left[above]
    ends = {motion: _ends(attempt, graph, above, motion) for motion in motions}
    dead = [motion for motion in motions if ends[motion]]
    out = tuple(Out(above, motion, _because(attempt, graph, motion, ends[motion])) for motion in dead)
    if len(out) < len(motions):
        return out
    for motion in motions:
        if motion not in ends[motion]:
            return attempt.hindered(graph, graph, ends[motion]) or out
    return attempt.stopped(graph, above, motions, by_rule_1=False)


def _ends(attempt: Attempt, graph: str, above: str, motion: str) -> frozenset[str]:
    """Return from where a layer may have to set out, and cannot, if a motion is taken above it.

    If the motion is one of its own candidates, it can always follow. Where anything may be playing, one way out is
    enough.
    """
    if motion in attempt.left[graph]:
        return frozenset()
    own = attempt.state.parts.get(graph)
    sources = frozenset((motion,))
    if own is not None and motion in attempt.before(above) and attempt.may_stay(above):
        running = own.motions - own.following
        may_follow = own.following or attempt.may_move(above) or attempt.runs_between(graph, above)
        sources = running | sources if may_follow else running
    dead = sources - attempt.leading_on(graph, sources)
    return dead if attempt.state.certain or dead == sources else frozenset()


def _because(attempt: Attempt, graph: str, motion: str, ends: frozenset[str]) -> str:
    source = "it" if motion in ends else f"what `{graph}` may play with it"
    sources = tuple(one for one in attempt.names.motions(graph) if one in ends)
    because = why_forbidden(graph, sources, attempt.left[graph], attempt.catalog)
    return f"nothing asked of `{graph}` can be reached from {source}{f': {because}' if because else ''}"
