"""What is playing -> how well each motion of a graph goes with it: how soon it is reached, how much it is like it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from mlmg_lang.session.arrivals import arrivals
from mlmg_lang.staging import Stage
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position


@dataclass(slots=True)
class StageFits:
    """How well motions go with what a character is playing; see `ide.offers.Fits`. What was asked is kept.

    On the root, seconds until a motion is reached, 0 for the one that plays; on the other graphs the Overall Motion
    Similarity to the best fitting of the motions above, over the usual one.
    """

    library: Library
    stage: Stage
    _known: dict[tuple[str, frozenset[str]], Mapping[str, float]] = field(default_factory=dict)

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        """Return how well the motions of a graph fit; those that cannot be reached are left out."""
        key = (graph, frozenset(above))
        if key not in self._known:
            own = self.library.by_name[graph]
            self._known[key] = self._soonest(own) if own.parent is None else _likest(own, key[1])
        return self._known[key]

    def _soonest(self, own: MotionGraph) -> Mapping[str, float]:
        motion, frame = self.stage.performer.whereabouts()[own.name]
        n_frames = arrivals(own, Position(own.index[motion], frame))
        seconds = dict(zip(own.motions, (n_frames / self.library.frame_rate).tolist(), strict=True))
        seconds[self.stage.performer.motion(own.name)] = 0.0
        return {name: soon for name, soon in seconds.items() if soon < float("inf")}


def _likest(own: MotionGraph, above: frozenset[str]) -> Mapping[str, float]:
    rows = [own.index[motion] for motion in above if motion in own.index]
    if not rows:
        return {}
    oms = own.oms[rows].min(axis=0) / (own.usual_oms or 1.0)
    return dict(zip(own.motions, oms.tolist(), strict=True))
