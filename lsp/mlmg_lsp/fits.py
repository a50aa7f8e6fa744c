"""What may be playing -> how well each motion of a graph goes with it, by the library alone."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np

from mlmg_lang.ide.offers import Asked, Ranked
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph

_MOST_KEPT = 16


@dataclass(frozen=True, slots=True)
class LibraryFits:
    """How well motions go with what may be playing; see `ide.offers.Fits`.

    On the root, the fewest transitions that lead to a motion, 0 for one that may be playing; of as many, first what is
    more like it. On the other graphs the Overall Motion Similarity to the best fitting of the motions above, over the
    usual one. What cannot be reached is left out.
    """

    library: Library

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        """Return, by motion, how well it fits; the smaller, the better."""
        own = self.library.by_name[graph]
        rows = [own.index[motion] for motion in above if motion in own.index]
        if not rows:
            return {}
        alike = own.oms[rows].min(axis=0) / (own.usual_oms or 1.0)
        if own.parent is not None:
            return dict(zip(own.motions, cast("list[float]", alike.tolist()), strict=True))
        return _soonest(own, rows, alike)


def _soonest(own: MotionGraph, rows: list[int], alike: FloatArray) -> Mapping[str, float]:
    hops = own.hops[rows]
    fewest = np.where(hops == UNREACHABLE, np.inf, hops).min(axis=0)
    fewest[rows] = 0
    fit = fewest + alike / (1 + alike)
    found = zip(own.motions, cast("list[float]", fit.tolist()), strict=True)
    return {motion: value for motion, value in found if value < np.inf}


class Kept(dict[Asked, Ranked]):
    """What was asked last; an editor stays open for weeks."""

    def __setitem__(self, key: Asked, value: Ranked) -> None:
        """Keep one more; where there are many, nothing else."""
        if len(self) >= _MOST_KEPT:
            self.clear()
        super().__setitem__(key, value)
