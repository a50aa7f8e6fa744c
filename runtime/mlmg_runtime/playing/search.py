"""The soonest way from a position in a motion graph into one of some motions; exact."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush

from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph, Position, Transition


@dataclass(frozen=True, slots=True)
class Path:
    """Transitions to take, in order, with the frames until the last has been shown and the sum of their costs."""

    transitions: tuple[Transition, ...]
    n_frames: int
    cost: float

    @property
    def arrival(self) -> Position:
        """Return the position after the last transition."""
        return self.transitions[-1].arrival


def find_path(
    graph: MotionGraph,
    start: Position,
    targets: Sequence[int],
    allowed: Collection[int] | None = None,
    dst_frame: int | None = None,
) -> Path | None:
    """Return the path of at least one transition into a target motion that takes the fewest frames.

    Of equally short paths the one with the smallest sum of costs, then the one to the earlier target. For the
    parameters see `find_paths`.
    """
    return next(find_paths(graph, start, targets, allowed, dst_frame), None)


def find_paths(
    graph: MotionGraph,
    start: Position,
    targets: Sequence[int],
    allowed: Collection[int] | None = None,
    dst_frame: int | None = None,
) -> Iterator[Path]:
    """Yield, for each transition into a target motion, the path that ends with it and takes the fewest frames.

    The shortest comes first; of equally short paths the one with the smallest sum of costs, then the one to the earlier
    target. It is Dijkstra's search, with the motion table as lower bound (A*), over the frames at which a transition
    leaves; playing on to the next such frame of the same motion is the other step.

    Parameters
    ----------
    targets : indices of motions, in the order that decides ties.
    allowed : indices of motions that the path may enter besides the targets; None for all.
    dst_frame : the frame at which the last transition has to end; None for any.
    """
    bound = _lower_bounds(graph, targets)
    rank = {motion: at for at, motion in enumerate(targets)}
    edges, first_edge, exits = graph.edges, graph.first_edge, graph.first_exit
    k = graph.window

    def next_exit(position: Position) -> int | None:
        at = bisect_left(exits[position.motion], position.frame)
        return first_edge[position.motion] + at if at < len(exits[position.motion]) else None

    # Entries: (least frames in all, cost so far, rank of the target or -1, edge, frames so far); reached by `taken`.
    queue: list[tuple[int, float, int, int, int, _Taken | None]] = []

    def push(edge: int, n_frames: int, cost: float, taken: _Taken | None) -> None:
        least = bound[edges[edge].src_motion]
        if least is not None and (edge not in best or (n_frames, cost) < best[edge]):
            best[edge] = (n_frames, cost)
            heappush(queue, (n_frames + least, cost, -1, edge, n_frames, taken))

    best: dict[int, tuple[int, float]] = {}
    first = next_exit(start)
    if first is not None:
        push(first, edges[first].src_frame - start.frame, 0.0, None)
    while queue:
        _, cost, target, number, n_frames, taken = heappop(queue)
        if target >= 0:
            assert taken is not None
            yield Path(taken.transitions(edges), n_frames, cost)
            continue
        edge = edges[number]
        if best[number] != (n_frames, cost):
            continue
        after = number + 1
        if after < first_edge[edge.src_motion + 1]:
            push(after, n_frames + edges[after].src_frame - edge.src_frame, cost, taken)
        then, there = _Taken(number, taken), n_frames + k
        if edge.dst_motion in rank and dst_frame in (None, edge.dst_frame):
            heappush(queue, (there, cost + edge.cost, rank[edge.dst_motion], number, there, then))
        if allowed is None or edge.dst_motion in allowed or edge.dst_motion in rank:
            onward = next_exit(edge.arrival)
            if onward is not None:
                wait = edges[onward].src_frame - edge.arrival.frame
                push(onward, there + wait, cost + edge.cost, then)


@dataclass(frozen=True, slots=True)
class _Taken:
    """The transitions taken so far, last first."""

    edge: int
    before: _Taken | None

    def transitions(self, edges: Sequence[Transition]) -> tuple[Transition, ...]:
        taken: list[Transition] = []
        at: _Taken | None = self
        while at is not None:
            taken.append(edges[at.edge])
            at = at.before
        return tuple(reversed(taken))


def _lower_bounds(graph: MotionGraph, targets: Sequence[int]) -> list[int | None]:
    """Return, for each motion, the fewest frames to a target by the motion table; None where no way leads."""
    bounds: list[int | None] = []
    for motion in range(len(graph.motions)):
        hops = [int(graph.hops[motion, target]) for target in targets]
        hops = [max(n, 1) for n in hops if n != UNREACHABLE]
        bounds.append(min(hops) * graph.window if hops else None)
    return bounds
