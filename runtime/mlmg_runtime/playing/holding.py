"""Staying in a motion while time passes."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from mlmg_runtime.errors import PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position, Transition
from mlmg_runtime.playing.search import find_path
from mlmg_runtime.playing.timeline import Blend, Segment, play_along, play_clip


def stay(
    library: Library, graph: MotionGraph, home: int, position: Position, time: int, allowed: Collection[int]
) -> Iterator[Segment]:
    """Yield, without end, what `graph` plays from `time` on to stay in the motion `home`.

    The motion is left as late as its own backward transitions allow. Past the last of them, or where it has none, the
    shortest way round that comes back to it is taken; where there is no such way either, a blend is made on the spot.

    Parameters
    ----------
    home : index of the motion. position, time : where the graph is, and the output frame from which on.
    allowed : indices of the motions that a way round may pass: those that the layers below are on too.

    Raises
    ------
    PlayError
        If the motion is too short to be held.
    """
    loop = latest_loop(graph, home)
    while True:
        if loop is not None and position.motion == home and position.frame <= loop.src_frame:
            way: tuple[Transition, ...] = (loop,)
        else:
            path = find_path(graph, position, [home], allowed)
            way = () if path is None else path.transitions
        segments = (
            play_along(way, graph.window, position, time) if way else _on_the_spot(library, graph, home, position, time)
        )
        for segment in segments:
            yield segment
            assert segment.after is not None
            position, time = segment.after, segment.end


def latest_loop(graph: MotionGraph, motion: int) -> Transition | None:
    """Return the motion's backward self-transition that leaves latest; of several, the smoothest."""
    first, end = graph.first_edge[motion : motion + 2]
    backward = [
        edge for edge in graph.edges[first:end] if edge.dst_motion == motion and edge.dst_frame < edge.src_frame
    ]
    return max(backward, key=lambda edge: (edge.src_frame, -edge.cost), default=None)


def _on_the_spot(library: Library, graph: MotionGraph, home: int, position: Position, time: int) -> list[Segment]:
    """Return the clip up to where a later window is most like an earlier one, and a blend from the one to the other."""
    name = graph.motions[home]
    if position.motion != home:
        raise PlayError(f"no way leads back to {name} on {graph.name} from {graph.motions[position.motion]}")
    pair = _most_alike(library, graph, name, position.frame)
    if pair is None:
        raise PlayError(
            f"{name} cannot go on after frame {position.frame} on {graph.name}: no transition leaves it there, and the "
            f"clip is too short to be led back into itself; allow more transitions, or give it a longer clip"
        )
    leave, enter = pair
    begin = time + leave - position.frame
    target = Position(home, enter + graph.window - 1)
    blend = Blend(begin, begin + graph.window, Position(home, leave), target)
    return [*play_clip(time, position, leave - position.frame), blend]


def _most_alike(library: Library, graph: MotionGraph, motion: str, from_frame: int) -> tuple[int, int] | None:
    """Return the first frames of a motion's two most alike windows: one from `from_frame` on, one wholly before it."""
    from mlmg_runtime.point_cloud import point_cloud, window_distances
    from mlmg_runtime.skeleton import world_positions

    points = world_positions(library.skeleton, library.poses(motion))[:, list(graph.joints)]
    cloud = point_cloud(points, graph.weights, graph.window)
    if cloud.n_windows - graph.window <= 0 or from_frame >= cloud.n_windows:
        return None
    distances = window_distances(cloud, cloud)
    late, early = np.ogrid[: distances.shape[0], : distances.shape[1]]
    distances = np.where((late >= from_frame) & (early <= late - graph.window), distances, np.inf)
    leave, enter = np.unravel_index(int(distances.argmin()), distances.shape)
    return int(leave), int(enter)
