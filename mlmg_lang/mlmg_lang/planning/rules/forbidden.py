"""Forbidden transitions: what nothing leads to because the library's configuration forbids it is out.

What is forbidden is so between two motions directly; a way round over others that is allowed stays one.
"""

from __future__ import annotations

from mlmg_lang.planning.forbidding import why_forbidden
from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def forbidden(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of a layer what cannot be reached, where forbidden transitions are why."""
    unreached = attempt.unreached(graph)
    if not unreached:
        return ()
    may_leave = attempt.sources(graph)
    sources = tuple(motion for motion in attempt.names.motions(graph) if motion in may_leave)
    reasons = {motion: why_forbidden(graph, sources, (motion,), attempt.catalog) for motion in unreached}
    return tuple(Out(graph, motion, because) for motion, because in reasons.items() if because is not None)
