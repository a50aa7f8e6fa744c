"""Ways on: whatever plays before a command, its topmost layer has to be able to set out from that.

That is rule 1 and the motion table, asked of earlier commands: they are narrowed to what this one can go on from.
"""

from __future__ import annotations

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.ruling import Ruling


def way_on(attempt: Attempt, graph: str) -> Ruling:
    """Say from what may be playing a topmost layer cannot set out."""
    if attempt.named_above(graph) is not None:
        return ()
    playing = graph if graph in attempt.state.parts else attempt.running_above(graph)
    bad = attempt.state.parts[playing].motions - attempt.sources(graph)
    return attempt.hindered(graph, playing, bad) or ()
