"""Where a motion is most like itself: there it can be led back into itself by a blend on the spot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import NamedTuple

import numpy as np

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph
from mlmg_runtime.point_cloud import PointCloud, point_cloud, window_distances
from mlmg_runtime.skeleton import world_positions

# So many windows are compared with all others at once; of long motions a hold mostly asks for the last ones alone.
AT_ONCE = 64


class Alike(NamedTuple):
    """Two windows of a motion: D, the first frame of the later one, and that of the earlier one."""

    distance: float
    leave: int
    enter: int


@dataclass(slots=True)
class Likeness:
    """How like themselves the motions of a library are. What has been worked out is kept."""

    library: Library
    _clouds: dict[tuple[str, str], PointCloud] = field(default_factory=dict)
    _rows: dict[tuple[str, str, int, int | None], tuple[Alike, ...]] = field(default_factory=dict)

    def most_alike(
        self, graph: MotionGraph, motion: str, first: int, last: int | None = None, before: int | None = None
    ) -> Alike | None:
        """Return a motion's two most alike windows, the earlier one wholly before the other; None if there are none.

        Parameters
        ----------
        first, last : where the later window may begin; None for up to the clip's end.
        before : the earlier window ends before this frame; None for any.
        """
        n_windows = self._cloud(graph, motion).n_windows
        end = n_windows if last is None else min(last + 1, n_windows)
        blocks = range(first // AT_ONCE, -(-end // AT_ONCE))
        rows = chain.from_iterable(self._block(graph, motion, block, before) for block in blocks)
        return min((row for row in rows if first <= row.leave < end), default=None)

    def _block(self, graph: MotionGraph, motion: str, block: int, before: int | None) -> tuple[Alike, ...]:
        """Return, for each of some windows that has one before it, the most alike of these."""
        key = (graph.name, motion, block, before)
        if key not in self._rows:
            cloud = self._cloud(graph, motion)
            self._rows[key] = tuple(_rows(cloud, block * AT_ONCE, cloud.n_windows if before is None else before))
        return self._rows[key]

    def _cloud(self, graph: MotionGraph, motion: str) -> PointCloud:
        key = (graph.name, motion)
        if key not in self._clouds:
            points = world_positions(self.library.skeleton, self.library.poses(motion))[:, list(graph.joints)]
            self._clouds[key] = point_cloud(points, graph.weights, graph.window)
        return self._clouds[key]


def _rows(cloud: PointCloud, first: int, before: int) -> Iterator[Alike]:
    end = min(first + AT_ONCE, cloud.n_windows)
    n_earlier = min(end, before + 1) - cloud.window
    if n_earlier <= 0:
        return
    distances = window_distances(_windows(cloud, first, end), _windows(cloud, 0, n_earlier))
    late, early = np.arange(first, end)[:, None], np.arange(n_earlier)
    distances = np.where(early <= late - cloud.window, distances, np.inf)
    for row, enter in enumerate(distances.argmin(axis=1).tolist()):
        if np.isfinite(distances[row, enter]):
            yield Alike(float(distances[row, enter]), first + row, enter)


def _windows(cloud: PointCloud, first: int, end: int) -> PointCloud:
    """Return some windows of a point cloud."""
    frames = slice(first, end + cloud.window - 1)
    return PointCloud(
        cloud.window, cloud.limbs[frames], cloud.heights[frames], cloud.paths[first:end], cloud.energy[first:end]
    )
