"""Ways round over other motions by which a motion is held that never leads back into itself."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterable
from heapq import heappop, heappush
from itertools import pairwise
from typing import NamedTuple

from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph, Position, Transition


class Round(NamedTuple):
    """Transitions that leave a motion and come back to no later frame of it, and frames of the two parts of that.

    Attributes
    ----------
    inside : frames that pass in the motion, from where it is entered until it is left again.
    outside : frames of the way, the blends out of the motion and into it with them.
    """

    transitions: tuple[Transition, ...]
    inside: int
    outside: int

    @property
    def share(self) -> float:
        """Return the share of the time that passes in the motion, from 0 to 1."""
        return self.inside / (self.inside + self.outside)

    @property
    def leave(self) -> int:
        """Return the last frame at which the motion has to be left."""
        return self.transitions[0].src_frame


def best_round(graph: MotionGraph, home: int, allowed: Collection[int]) -> Round | None:
    """Return the way round on which the largest share of the time passes in the motion `home`; None if there is none.

    Of equally large shares the one with the smallest sum of costs. Found once for each motion and what is allowed.

    Parameters
    ----------
    allowed : indices of motions that the way may pass.
    """
    key = (home, frozenset(allowed))
    if key not in graph.rounds:
        graph.rounds[key] = _find_round(graph, home, key[1])
    found = graph.rounds[key]
    return None if found is None else _measured(graph, found)


def _find_round(graph: MotionGraph, home: int, allowed: Collection[int]) -> tuple[Transition, ...] | None:
    """Return `best_round`: by Dinkelbach's method for the largest ratio.

    Each of its steps searches, by Dijkstra's, for the way that gains most against the best share so far: if it gains
    nothing, that is the largest.
    """
    best: Round | None = None
    inside, outside = 0, 1
    while True:
        way = _cheapest(graph, home, allowed, _exits(graph, home, 0, outside), inside, outside, None)
        if way is None or way[-1].arrival.frame > way[0].src_frame:
            return None
        found = _measured(graph, way)
        if best is not None and found.inside * best.outside <= best.inside * found.outside:
            return found.transitions
        best, inside, outside = found, found.inside, found.outside


def way_back(
    graph: MotionGraph, home: int, allowed: Collection[int], position: Position, usual: Round
) -> tuple[Transition, ...] | None:
    """Return the way by which least time is lost until the round `usual` can go on; None if there is none.

    It comes back before where that leaves. What is lost is time outside the motion, against the share of that round.
    """
    if position.motion == home:
        starts: Iterable[tuple[int, int]] = _exits(graph, home, position.frame, usual.outside)
    else:
        at = bisect_left(graph.first_exit[position.motion], position.frame)
        number = graph.first_edge[position.motion] + at
        within = at < len(graph.first_exit[position.motion])
        starts = [(number, usual.inside * (graph.edges[number].src_frame - position.frame))] if within else []
    return _cheapest(graph, home, allowed, starts, usual.inside, usual.outside, usual.leave)


def _exits(graph: MotionGraph, home: int, frame: int, earned: int) -> list[tuple[int, int]]:
    """Return the transitions that leave a motion from a frame on, each with what staying up to there has earned."""
    numbers = range(graph.first_edge[home] + bisect_left(graph.first_exit[home], frame), graph.first_edge[home + 1])
    return [
        (number, -earned * graph.edges[number].src_frame)
        for number in numbers
        if graph.edges[number].dst_motion != home
    ]


def _measured(graph: MotionGraph, way: tuple[Transition, ...]) -> Round:
    between = sum(then.src_frame - one.arrival.frame for one, then in pairwise(way))
    return Round(way, way[0].src_frame - way[-1].arrival.frame, between + len(way) * graph.window)


def _cheapest(
    graph: MotionGraph,
    home: int,
    allowed: Collection[int],
    starts: Iterable[tuple[int, int]],
    a_frame: int,
    earned: int,
    latest: int | None,
) -> tuple[Transition, ...] | None:
    """Return the way into a motion for which a sum is least, of equal ones that with the smallest sum of costs.

    Parameters
    ----------
    starts : numbers of transitions that may come first, and the sum before each.
    a_frame : what is added for each frame until the motion is entered.
    earned : what is added for each frame before the one at which it is entered.
    latest : the last frame at which it may be entered; None for any.
    """
    edges, first_edge, exits = graph.edges, graph.first_edge, graph.first_exit
    # Entries: (sum, costs, number of transitions taken, these, whether it is over, the transition to be taken). That of
    # equal ways the first is taken, in their order, makes the rest of a way the one that is found from halfway, too.
    queue: list[tuple[int, float, int, tuple[int, ...], bool, int]] = []
    best: dict[int, tuple[int, float, int, tuple[int, ...]]] = {}

    def push(total: int, cost: float, way: tuple[int, ...], number: int) -> None:
        key = (total, cost, len(way), way)
        if number not in best or key < best[number]:
            best[number] = key
            heappush(queue, (*key, False, number))

    for number, total in starts:
        push(total, 0.0, (), number)
    while queue:
        total, cost, n_taken, way, over, number = heappop(queue)
        if over:
            return tuple(edges[taken] for taken in way)
        if best[number] != (total, cost, n_taken, way):
            continue
        edge = edges[number]
        if edge.src_motion != home and number + 1 < first_edge[edge.src_motion + 1]:
            push(total + a_frame * (edges[number + 1].src_frame - edge.src_frame), cost, way, number + 1)
        there, spent, taken, onward = total + a_frame * graph.window, cost + edge.cost, (*way, number), edge.arrival
        if edge.dst_motion == home:
            if latest is None or onward.frame <= latest:
                heappush(queue, (there + earned * onward.frame, spent, n_taken + 1, taken, True, number))
        elif edge.dst_motion in allowed and graph.hops[edge.dst_motion, home] != UNREACHABLE:
            at = bisect_left(exits[onward.motion], onward.frame)
            if at < len(exits[onward.motion]):
                waited = exits[onward.motion][at] - onward.frame
                push(there + a_frame * waited, spent, taken, first_edge[onward.motion] + at)
    return None
