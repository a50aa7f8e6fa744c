"""A resolved plan -> the plan to play when motions are chosen over the whole script, not command by command.

Estimates propose, playing decides: what the forecast finds cheapest is rehearsed beside command by command, and taken
only if it comes to less.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf

from mlmg_lang.explaining.happened import executions_of, played_of
from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.perform import rehearse
from mlmg_lang.planning.ahead import Ahead, plan_ahead
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import ResolvedPlan
from mlmg_lang.staging import ScriptError
from mlmg_runtime.library import Library


def look_ahead(plan: ResolvedPlan, library: Library, seed: int = 0) -> Ahead:
    """Return the plan with the smallest sum of seconds on the way and costs that is known, as it is played.

    It is the plan given, and the result says why, if it is too long, or if looking ahead brings nothing.

    Parameters
    ----------
    seed : of what `choose` draws when both are rehearsed; with any other the plan can be played, but may be worse.
    """
    ahead = plan_ahead(plan, Names(library), MotionTravel(library))
    if not ahead.planned:
        return ahead
    given, planned = _price(plan, library, seed), _price(ahead.plan, library, seed)
    if planned < given or planned == given != inf:
        return ahead
    if planned == inf:
        because = "what it expects to be cheapest cannot be played"
    else:
        because = f"seconds on the way and costs, as played, would come to {planned:.2f} instead of {given:.2f}"
    return replace(ahead, plan=plan, planned=False, because=because)


def _price(plan: ResolvedPlan, library: Library, seed: int) -> float:
    """Return the seconds on the way and the costs of what is played; infinite, if it cannot be played."""
    try:
        rehearsal = rehearse(plan, library, seed)
    except ScriptError:
        return inf
    played = played_of(rehearsal, executions_of(rehearsal, library, plan.start), library.frame_rate, seed)
    return played.under_way + played.cost
