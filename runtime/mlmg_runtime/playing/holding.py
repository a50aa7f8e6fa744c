"""Staying in a motion while time passes."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from mlmg_runtime.errors import PlayError
from mlmg_runtime.motion_graph import USUAL_BRIDGE, MotionGraph, Position, Transition
from mlmg_runtime.playing.likeness import Alike, Likeness
from mlmg_runtime.playing.rounds import best_round, way_back
from mlmg_runtime.playing.search import find_paths
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, play_along, play_clip

# Who holds a motion expects to see it for more than this share of the time.
MOSTLY = 0.5


def stay(
    likeness: Likeness, graph: MotionGraph, home: int, position: Position, time: int, allowed: Collection[int]
) -> Iterator[Segment]:
    """Yield, without end, what `graph` plays from `time` on to stay in the motion `home`.

    The motion is left as late as its own backward transitions allow. Past the last of them it is blended back on the
    spot to before that, between the two most alike windows up to where the shortest way round would leave it; the way
    round is taken if these are farther apart than it is, and than bridges usually are. A motion without a backward
    transition is held by the way round on which the largest share of the time passes in it. Where there is no way
    round, a blend is made on the spot; a clip that is too short for that stands still in its last frame.

    Parameters
    ----------
    home : index of the motion. position, time : where the graph is, and the output frame from which on.
    allowed : indices of the motions that a way round may pass: those that the layers below are on too.

    Raises
    ------
    PlayError
        If the graph is in another motion, and no way leads back.
    """
    loop = latest_loop(graph, home)
    while True:
        if loop is not None and position.motion == home and position.frame <= loop.src_frame:
            segments: Sequence[Segment] = play_along((loop,), graph.window, position, time)
        else:
            segments = _come_back(likeness, graph, home, position, time, allowed)
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


def hardly_held(graph: MotionGraph) -> Mapping[str, float]:
    """Return the motions that are shown for less than half of a long time in which they are held, with that share.

    They never lead into themselves, and every way round over others takes longer than they are shown between.
    """
    shares: dict[str, float] = {}
    for motion, name in enumerate(graph.motions):
        usual = None if latest_loop(graph, motion) else best_round(graph, motion, range(len(graph.motions)))
        if usual is not None and usual.share < MOSTLY:
            shares[name] = usual.share
    return shares


def _come_back(
    likeness: Likeness, graph: MotionGraph, home: int, position: Position, time: int, allowed: Collection[int]
) -> Sequence[Segment]:
    """Return what leads back into the motion from where no backward transition of its own leads."""
    way = _way_home(graph, home, position, allowed)
    alike = _most_alike(likeness, graph, home, position, way)
    if alike is not None:
        begin, target = time + alike.leave - position.frame, Position(home, alike.enter + graph.window - 1)
        blend = Blend(begin, begin + graph.window, Position(home, alike.leave), target)
        return [*play_clip(time, position, alike.leave - position.frame), blend]
    if way:
        return play_along(way, graph.window, position, time)
    if position.motion != home:
        raise PlayError(
            f"no way leads back to {graph.motions[home]} on {graph.name} from {graph.motions[position.motion]}"
        )
    return _stand_still(graph, position, time)


def _way_home(graph: MotionGraph, home: int, position: Position, allowed: Collection[int]) -> tuple[Transition, ...]:
    """Return the way round from a position to before where the motion is left in time; if there is none, into it."""
    loop, usual = latest_loop(graph, home), None
    if loop is None:
        usual = best_round(graph, home, allowed)
    if usual is not None:
        if position.motion == home and position.frame <= usual.leave:
            return usual.transitions
        way = way_back(graph, home, allowed, position, usual)
        if way is not None:
            return way
    shortest: tuple[Transition, ...] = ()
    for path in find_paths(graph, position, [home], allowed):
        if loop is None or path.arrival.frame <= loop.src_frame:
            return path.transitions
        shortest = shortest or path.transitions
    return shortest


def _stand_still(graph: MotionGraph, position: Position, time: int) -> Sequence[Segment]:
    """Return the rest of a clip and its last frame once more."""
    last = Position(position.motion, int(graph.n_frames[position.motion]) - 1)
    rest = play_clip(time, position, last.frame - position.frame)
    time = rest[-1].end if rest else time
    return [*rest, Clip(time, time + 1, last, 0)]


def _most_alike(
    likeness: Likeness, graph: MotionGraph, home: int, position: Position, way: Sequence[Transition]
) -> Alike | None:
    """Return the windows between which a blend leads back into the motion; None if it is better to go a way round."""
    name, loop = graph.motions[home], latest_loop(graph, home)
    if position.motion != home:
        return None
    if not way:
        return likeness.most_alike(graph, name, position.frame)
    if loop is None:
        return None
    alike = likeness.most_alike(graph, name, position.frame, way[0].src_frame, before=loop.src_frame)
    bearable = max(USUAL_BRIDGE * graph.sigma, *(edge.distance for edge in way))
    return alike if alike is not None and alike.distance <= bearable else None
