"""Which candidates become transitions: the threshold, the bridges, and the part of the graph that never ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.motion_graph import USUAL_BRIDGE


class Edges(NamedTuple):
    """Directed transitions (A_i -> B_j) of a graph; arrays of one length."""

    src_motion: IntArray
    src_frame: IntArray
    dst_motion: IntArray
    dst_frame: IntArray
    distance: FloatArray

    def where(self, keep: BoolArray | IntArray) -> Edges:
        """Return some of the transitions."""
        return Edges(
            self.src_motion[keep],
            self.src_frame[keep],
            self.dst_motion[keep],
            self.dst_frame[keep],
            self.distance[keep],
        )


class Positions:
    """Numbers the positions (motion, frame) of a graph, and finds which can reach each other."""

    def __init__(self, n_frames: IntArray) -> None:
        """Number the frames of motions of `n_frames` frames, shape (n_motions,), one after the other."""
        self.n_frames = n_frames
        self.first = np.concatenate(([0], np.cumsum(n_frames)))
        within = np.ones(self.first[-1], dtype=bool)
        within[self.first[1:] - 1] = False
        self._next = np.flatnonzero(within)

    def component(self, edges: Edges) -> BoolArray:
        """Return which positions lie in the largest strongly connected component, shape (sum of n_frames,).

        A transition leads to the position after its last blended frame; one that ends with its clip leads nowhere.
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        lands = edges.dst_frame + 1 < self.n_frames[edges.dst_motion]
        source = np.concatenate((self._next, self.source(edges)[lands]))
        target = np.concatenate((self._next + 1, self.target(edges)[lands]))
        shape = (int(self.first[-1]), int(self.first[-1]))
        links = coo_array((np.ones(len(source), dtype=np.int8), (source, target)), shape=shape)
        _, labels = connected_components(links.tocsr(), directed=True, connection="strong")
        sizes = np.bincount(labels)
        if sizes.max() == 1:
            return np.zeros(len(labels), dtype=bool)
        return np.asarray(labels == sizes.argmax())

    def source(self, edges: Edges) -> IntArray:
        """Return the number of the position that each transition leaves from."""
        return np.asarray(self.first[edges.src_motion] + edges.src_frame)

    def target(self, edges: Edges) -> IntArray:
        """Return the number of the position that each transition leads to."""
        return np.asarray(self.first[edges.dst_motion] + edges.dst_frame + 1)

    def motions_in(self, component: BoolArray) -> BoolArray:
        """Return which motions have a position in the component, shape (n_motions,)."""
        return np.asarray(np.add.reduceat(component, self.first[:-1]) > 0)

    def inside(self, edges: Edges, component: BoolArray) -> BoolArray:
        """Return which transitions leave from and lead to a position in the component."""
        lands = edges.dst_frame + 1 < self.n_frames[edges.dst_motion]
        target = np.where(lands, self.target(edges), 0)
        return np.asarray(component[self.source(edges)] & lands & component[target])


def bridges(
    positions: Positions, edges: Edges, sigma: float, window: int, hurries: Callable[[Edges], BoolArray]
) -> BoolArray:
    """Return which transitions to keep so that as many motions as possible can be reached from each other.

    All whose distance is at most `sigma` are kept; if the motions hang together by these, no other. Else the best of
    the others are: of transitions between the same two motions that leave within a window of each other, one; none
    that hurries, or is dearer than a usual bridge, unless the motions fall apart without. (The fewest bridges that
    connect all would do for a graph, but not for a person: on real clips a walk would begin 7 to 20 seconds after it
    was asked for, with these 4 to 5.)

    Parameters
    ----------
    hurries : tells of transitions whether they hurry a joint; asked of those alone that would be kept.

    Returns
    -------
    array, shape (n_edges,), bool.
    """
    wanted = positions.motions_in(positions.component(edges))

    def connected(keep: BoolArray) -> bool:
        component = positions.component(edges.where(keep))
        return bool(np.all(positions.motions_in(component)[wanted]))

    smooth = edges.distance <= sigma
    if connected(smooth):
        return smooth
    for bridging in _ever_more_bridges(edges, sigma, window, hurries):
        if connected(smooth | bridging):
            break
    keep = smooth | bridging
    keep &= edges.distance <= max(USUAL_BRIDGE * sigma, _dearest_needed(edges, keep, connected))
    usual = keep & (edges.distance <= USUAL_BRIDGE * sigma)
    pair = _pairs(edges)
    dear = np.flatnonzero(keep & ~usual & np.isin(pair, pair[usual]))
    return _give_up(keep, dear[np.argsort(-edges.distance[dear], kind="stable")].tolist(), connected)


def _ever_more_bridges(
    edges: Edges, sigma: float, window: int, hurries: Callable[[Edges], BoolArray]
) -> Iterator[BoolArray]:
    """Yield what might bridge: the best of each window up to ever larger distances, then with those that hurry."""
    order = np.argsort(edges.distance, kind="stable")
    limit = USUAL_BRIDGE * sigma
    while True:
        near = order[edges.distance[order] <= limit]
        yield _best_of_each_window(edges, near, window, hurries)
        if len(near) == len(order):
            break
        limit = max(2.0 * limit, float(edges.distance[order[len(near)]]))
    yield _best_of_each_window(edges, order, window, lambda some: np.zeros(len(some.distance), dtype=bool))
    yield np.ones(len(order), dtype=bool)


def _best_of_each_window(
    edges: Edges, best_first: IntArray, window: int, hurries: Callable[[Edges], BoolArray]
) -> BoolArray:
    """Return which transitions are the best between their motions among those that leave less than a window apart.

    Those that hurry do not count; as it takes long to tell, only of those that seem the best it is asked.
    """
    best, asked, out = np.zeros((3, len(edges.distance)), dtype=bool)
    pair = _pairs(edges)
    again = best_first
    while len(again):
        best[again] = False
        best[_first_of_each_window(edges, again[~out[again]], window)] = True
        fresh = np.flatnonzero(best & ~asked)
        asked[fresh] = True
        out[fresh] = hurries(edges.where(fresh))
        again = best_first[np.isin(pair[best_first], pair[fresh[out[fresh]]])]
    return best


def _first_of_each_window(edges: Edges, best_first: IntArray, window: int) -> list[int]:
    first: list[int] = []
    departures: dict[tuple[int, int], list[int]] = {}
    columns = (edges.src_motion, edges.dst_motion, edges.src_frame)
    for number, source, target, frame in zip(
        best_first.tolist(), *(column[best_first].tolist() for column in columns), strict=True
    ):
        taken = departures.setdefault((source, target), [])
        if all(abs(frame - other) >= window for other in taken):
            taken.append(frame)
            first.append(number)
    return first


def _dearest_needed(edges: Edges, keep: BoolArray, connected: Callable[[BoolArray], bool]) -> float:
    """Return the smallest distance at which all hang together by some transitions."""
    values = np.sort(edges.distance[keep])
    low, high = 0, len(values) - 1
    while low < high:
        middle = (low + high) // 2
        if connected(keep & (edges.distance <= values[middle])):
            high = middle
        else:
            low = middle + 1
    return float(values[low])


def _pairs(edges: Edges) -> IntArray:
    """Return a number for the motion that is left and the motion that is entered by each transition."""
    return np.asarray(edges.src_motion * (edges.dst_motion.max(initial=0) + 1) + edges.dst_motion)


def _give_up(keep: BoolArray, dear: list[int], connected: Callable[[BoolArray], bool]) -> BoolArray:
    """Return `keep` less all of the transitions `dear`, dearest first, that are not needed.

    Runs of them are tried at once and halved where one is needed: what can be given up together can be given up one
    by one.
    """
    runs = [dear] if dear else []
    while runs:
        run = runs.pop()
        without = keep.copy()
        without[run] = False
        if connected(without):
            keep = without
        elif len(run) > 1:
            runs += [run[len(run) // 2 :], run[: len(run) // 2]]
    return keep
