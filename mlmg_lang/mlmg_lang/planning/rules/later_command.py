"""Later commands: what one of them could not go on from is out, so that it can be obeyed."""

from __future__ import annotations

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Out, Ruling


def later_command(attempt: Attempt, graph: str) -> Ruling:
    """Leave out of a layer what later commands have ruled out."""
    ruled_out = attempt.ruled_out.get(graph, {})
    return tuple(Out(graph, motion, ruled_out[motion]) for motion in attempt.left[graph] if motion in ruled_out)
