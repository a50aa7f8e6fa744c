"""Motion graphs -> how long the ways between their motions take, and what they cost.

For each motion asked for, the soonest way into it (and of equally soon ways the smoothest) is worked out once from all
transitions of its graph, backward. Looked up from all frames in which a motion is held, that gives the average.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mlmg_lang.planning.estimate import Estimate, Moment, Playing, Trip, exactly
from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import latest_loop, stay
from mlmg_runtime.playing.performer import LONGEST_RETURN_S
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.timeline import Blend, Clip

N_RETURNS = 4
"""A part's way back depends on where it and the graph above are; so many of such pairs are looked at."""

# Frames + 1j times costs: complex numbers are ordered by their real parts first.
_Ways: TypeAlias = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, eq=False)
class _Exits:
    """The transitions of a graph as they are left one after the other.

    Attributes
    ----------
    key : array, shape (n_transitions,). Motion and frame of the departure as one number, which rises.
    stride : so much the key rises from motion to motion; more than any way takes in frames.
    onward : array. The first transition that can be left after this one has arrived; their number, if there is none.
    wait : array. Frames from the arrival to that.
    """

    key: FloatArray
    stride: float
    onward: IntArray
    wait: FloatArray

    def first(self, motion: int, frames: IntArray) -> IntArray:
        """Return the first transition that leaves a motion at each of some frames or later; their number: none."""
        found = np.searchsorted(self.key, motion * self.stride + frames)
        return np.where(found < np.searchsorted(self.key, (motion + 1) * self.stride), found, len(self.key))


@dataclass(frozen=True, slots=True, eq=False)
class _Into:
    """The soonest ways into one motion.

    Attributes
    ----------
    from_exit : array, shape (n_transitions + 1,). From where a transition can be left, whichever is then taken:
        frames + 1j costs; inf where no way leads, and at the end.
    arrival : array. The frame that is reached.
    """

    from_exit: _Ways
    arrival: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class _Places:
    """Where a graph may be: frames of a motion, how long until it is there, and how likely; arrays of one shape."""

    frames: IntArray
    leads: FloatArray
    shares: FloatArray


@dataclass(slots=True)
class MotionTravel:
    """Ways in the motion graphs of a library; see `planning.estimate.Travel`. What has been worked out is kept."""

    library: Library
    _exits: dict[str, _Exits] = field(default_factory=dict)
    _into: dict[tuple[str, str, bool], _Into] = field(default_factory=dict)
    _trips: dict[tuple[object, ...], tuple[Trip, ...]] = field(default_factory=dict)
    _backs: dict[tuple[object, ...], Trip] = field(default_factory=dict)

    def soonest(
        self, graph: str, playing: Playing, candidates: tuple[str, ...], driver: str, to_begin: bool = False
    ) -> tuple[Trip, ...]:
        """Return the candidates that may be reached before the others; none if none can be reached."""
        key = (graph, playing, candidates, driver, to_begin)
        if key not in self._trips:
            self._trips[key] = tuple(self._soonest(graph, playing, candidates, driver, to_begin))
        return self._trips[key]

    def on_the_spot(self, graph: str, motion: str) -> Trip:
        """Return how a motion is blended into where it begins, as is done where no way leads there."""
        return Trip(motion, 1.0, exactly(self.library.by_name[graph].window / self.library.frame_rate), 0.0, 1.0)

    def back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        """Return how a part comes back to what `driver`, a graph above it, plays."""
        key = (graph, playing, driver, above)
        if key not in self._backs:
            self._backs[key] = self._back(graph, playing, driver, above)
        return self._backs[key]

    def similarity(self, graph: str, above: str, motion: str) -> float:
        """Return the OMS of a motion to that of the graph above; the smaller, the better it fits."""
        own = self.library.by_name[graph]
        return float(own.oms[own.index[above], own.index[motion]])

    def unlikeness(self, graph: str, above: str, motion: str) -> float:
        """Return the same over what is usual on the graph."""
        return self.library.unlikeness(graph, above, motion)

    def to_last_frame(self, driver: str, playing: Playing) -> Estimate:
        """Return how long it takes until the clip's last frame has been shown."""
        places = self._places(driver, playing)
        n_frames = self.library.n_frames(playing.motion)
        return self._estimate(places.leads + n_frames - places.frames, places.shares)

    def one_pass(self, driver: str, motion: str) -> Estimate:
        """Return how long a motion takes from where it begins to its last exit."""
        own = self.library.by_name[driver]
        exits = own.first_exit[own.index[motion]]
        return exactly(max(exits[-1] - own.window, 0) / self.library.frame_rate if exits else 0.0)

    def cycle(self, motion: str) -> Estimate:
        """Return how long a motion's clip is."""
        return exactly(self.library.n_frames(motion) / self.library.frame_rate)

    # --- ways into motions ---

    def _soonest(
        self, graph: str, playing: Playing, candidates: tuple[str, ...], driver: str, to_begin: bool
    ) -> Iterator[Trip]:
        places = self._places(driver, playing)
        own = self.library.by_name[graph]
        ways = np.array([self._ways(own, playing.motion, c, driver, places, to_begin) for c in candidates])
        first = np.argmin(ways, axis=0)
        best = ways[first, np.arange(len(first))]
        known = np.isfinite(best.real)
        total = places.shares[known].sum()
        for at, candidate in enumerate(candidates):
            won = known & (first == at)
            if won.any():
                shares = places.shares[won]
                cost = float(np.average(best[won].imag, weights=shares))
                yield Trip(candidate, float(shares.sum() / total), self._estimate(best[won].real, shares), cost)

    def _ways(
        self, own: MotionGraph, motion: str, candidate: str, driver: str, places: _Places, to_begin: bool
    ) -> _Ways:
        """Return the soonest way into a motion from each of some places."""
        into = self._way_into(own, candidate, to_begin)
        ways = self._from(own, into, motion, places.frames) + places.leads
        above = self.library.by_name[driver]
        loop = None if driver == own.name else latest_loop(above, above.index[motion])
        if loop is not None:
            # A part may also set out after the graph above has looped, if that is sooner.
            again = self._from(own, into, motion, np.array([loop.dst_frame + 1]))[0]
            wait = np.where(places.frames <= loop.src_frame, loop.src_frame - places.frames + above.window, np.inf)
            later = again + places.leads + wait
            ways = np.where(later.real < ways.real, later, ways)
        return ways

    def _from(self, own: MotionGraph, into: _Into, motion: str, frames: IntArray) -> _Ways:
        exits = self._exits_of(own)
        if motion not in own.index:
            return np.full(len(frames), np.inf, np.complex128)
        index = own.index[motion]
        first = exits.first(index, frames)
        keys = np.append(exits.key, np.inf)
        return into.from_exit[first] + (keys[first] - index * exits.stride - frames)

    def _way_into(self, own: MotionGraph, target: str, to_begin: bool) -> _Into:
        key = (own.name, target, to_begin)
        if key not in self._into:
            self._into[key] = _ways_into(own, self._exits_of(own), own.index[target], to_begin)
        return self._into[key]

    def _exits_of(self, own: MotionGraph) -> _Exits:
        if own.name not in self._exits:
            self._exits[own.name] = _exits(own)
        return self._exits[own.name]

    # --- where a graph may be ---

    def _places(self, driver: str, playing: Playing) -> _Places:
        """Return where a graph that plays a motion may be."""
        own = self.library.by_name[driver]
        then = self._then(own, playing)
        if then is None:
            return self._held(own, playing.motion)
        n_frames = round(playing.held_s * self.library.frame_rate)
        return then if n_frames == 0 else self._later(own, playing.motion, then, n_frames)

    def _then(self, own: MotionGraph, playing: Playing) -> _Places | None:
        """Return where a graph was at the moment that is known of it; None if that says nothing."""
        match playing.moment:
            case Moment.FIRST:
                return _at(0)
            case Moment.BEGUN:
                return _at(own.window)
            case Moment.PASSED:
                exits = own.first_exit[own.index[playing.motion]]
                return _at(exits[-1] if exits else 0)
            case Moment.ARRIVED if playing.source in own.index:
                return self._arrivals(own, playing)
            case _:
                return None

    def _later(self, own: MotionGraph, motion: str, then: _Places, n_frames: int) -> _Places:
        """Return where a graph may be that has stayed in a motion for some frames, looping as late as it can.

        Parameters
        ----------
        then : where it was before; without leads.
        """
        loop = latest_loop(own, own.index[motion])
        if loop is None or (then.frames > loop.src_frame).any():
            return self._held(own, motion)
        again, period = loop.dst_frame + 1, loop.src_frame - loop.dst_frame - 1 + own.window
        ahead = n_frames - (loop.src_frame - then.frames)
        # Up to the loop; beyond it, first the blend, then the clip from where that leads.
        into = np.where(ahead > 0, (ahead - 1) % period + 1, ahead)
        blending = (into > 0) & (into < own.window)
        frames = np.where(ahead <= 0, then.frames + n_frames, again + np.maximum(into - own.window, 0)).astype(int)
        return _Places(frames, np.where(blending, own.window - into, 0.0), then.shares)

    def _held(self, own: MotionGraph, motion: str) -> _Places:
        """Return where a graph may be that has played a motion for long: in its loop, or in the blend back."""
        index, k = own.index[motion], own.window
        loop = latest_loop(own, index)
        if loop is not None:
            clip = np.arange(loop.dst_frame + 1, loop.src_frame + 1)
            blend = np.arange(1, k)
            frames = np.concatenate((clip, np.full(len(blend), loop.dst_frame + 1)))
            leads = np.concatenate((np.zeros(len(clip)), blend.astype(float)))
        else:
            exits = own.first_exit[index]
            frames = np.arange(min(k, exits[-1]), exits[-1] + 1) if exits else np.array([0])
            leads = np.zeros(len(frames))
        return _Places(frames, leads, np.full(len(frames), 1.0 / len(frames)))

    def _arrivals(self, own: MotionGraph, playing: Playing) -> _Places | None:
        """Return where a graph arrives in a motion, from anywhere in the one before."""
        into = self._way_into(own, playing.motion, False)
        before = self._held(own, playing.source)
        first = self._exits_of(own).first(own.index[playing.source], before.frames)
        known = np.isfinite(into.from_exit[first].real)
        if not known.any():
            return None
        frames, where = np.unique(into.arrival[first[known]], return_inverse=True)
        shares = np.bincount(where, weights=before.shares[known])
        return _Places(frames, np.zeros(len(frames)), shares / shares.sum())

    # --- ways back ---

    def _back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        own, over = self.library.by_name[graph], self.library.by_name[driver]
        deadline = round(LONGEST_RETURN_S * self.library.frame_rate)
        frames, costs, released = [], [], 0
        for frame, place in _sampled(self._places(graph, playing), self._places(driver, above)):
            position = Position(own.index[playing.motion], frame)
            clips = self._clips(over, Position(over.index[above.motion], place), own, deadline)
            way = find_return(own, position, 0, clips, deadline)
            released += way is None
            frames.append(own.window if way is None else way[-1].end)
            blends = [segment for segment in way or () if isinstance(segment, Blend)]
            costs.append(sum(blend.transition.cost for blend in blends if blend.transition is not None))
        takes = self._estimate(np.array(frames, float), np.ones(len(frames)))
        return Trip(above.motion, 1.0, takes, float(np.mean(costs)), released / len(frames))

    def _clips(self, over: MotionGraph, position: Position, own: MotionGraph, deadline: int) -> list[Clip]:
        """Return what a graph plays for a while, as far as it is on a graph below, in the indices of that."""
        allowed = {at for at, motion in enumerate(over.motions) if motion in own.index}
        clips = []
        for segment in stay(self.library, over, position.motion, position, 0, allowed):
            if segment.begin > deadline:
                break
            clip = segment if isinstance(segment, Clip) else Clip(segment.begin, segment.begin, segment.source, 0)
            name = over.motions[clip.first.motion]
            if name in own.index:
                first = Position(own.index[name], clip.first.frame)
                clips.append(Clip(clip.begin, clip.end, first, clip.n_source))
        return clips

    # --- numbers ---

    def _estimate(self, n_frames: FloatArray, shares: FloatArray) -> Estimate:
        seconds = n_frames / self.library.frame_rate
        return Estimate(float(np.average(seconds, weights=shares)), float(seconds.min()), float(seconds.max()))


def _at(frame: int) -> _Places:
    return _Places(np.array([frame]), np.zeros(1), np.ones(1))


def _exits(graph: MotionGraph) -> _Exits:
    edges = graph.transitions
    longest = int(graph.n_frames.max(initial=0)) + graph.window + 1
    stride = float(longest * (len(edges) + 2))
    key = edges["src_motion"] * stride + edges["src_frame"]
    ends = np.searchsorted(key, (edges["dst_motion"] + 1) * stride)
    onward = np.searchsorted(key, edges["dst_motion"] * stride + edges["dst_frame"] + 1)
    onward = np.where(onward < ends, onward, len(key))
    leaves = np.append(edges["src_frame"], 0)[onward]
    return _Exits(key, stride, onward, (leaves - edges["dst_frame"] - 1).astype(float))


def _ways_into(graph: MotionGraph, exits: _Exits, target: int, to_begin: bool) -> _Into:
    """Return the soonest ways into a motion; with `to_begin`, to frame k - 1 of it.

    Each round lets ways be one transition longer, so there are as many rounds as the longest way has.
    """
    edges, n = graph.transitions, len(graph.transitions)
    is_into: BoolArray = edges["dst_motion"] == target
    if to_begin:
        is_into &= edges["dst_frame"] == graph.window - 1
    step = graph.window + 1j * edges["cost"]
    taken = np.where(is_into, step, np.inf)
    while True:
        from_exit, choice = _best_exits(edges["src_frame"], edges["src_motion"], taken, exits.stride)
        longer = np.where(is_into, step, step + exits.wait + from_exit[exits.onward])
        if np.array_equal(longer, taken):
            break
        taken = longer
    arrival = np.where(is_into, edges["dst_frame"] + 1, -1)
    while True:
        reached = np.append(arrival[choice[:n]], -1)
        further = np.where(is_into, arrival, reached[exits.onward])
        if np.array_equal(further, arrival):
            return _Into(from_exit, reached)
        arrival = further


def _best_exits(frames: IntArray, motions: IntArray, taken: _Ways, stride: float) -> tuple[_Ways, IntArray]:
    """Return from where each transition can be left the way by the best of it and the later ones, and which that is.

    Parameters
    ----------
    taken : the ways that begin with each transition.
    """
    n = len(taken)
    # Later motions have larger numbers, so a minimum taken from the end on begins anew with each motion.
    reversed_ways = (taken + frames + motions * stride)[::-1]
    best = np.minimum.accumulate(reversed_ways)
    at_end = np.where(reversed_ways == best, np.arange(n)[::-1], n)
    choice = np.minimum.accumulate(at_end)[::-1] if n else at_end
    offsets = (frames + motions * stride)[::-1]
    ways = np.where(best.real < (motions[::-1] + 1) * stride, best - offsets, np.inf)[::-1]
    return np.append(ways, np.inf), choice


def _sampled(own: _Places, above: _Places) -> list[tuple[int, int]]:
    """Return pairs of frames at which a part and the graph above may be when the part is ended."""
    shares = (np.arange(N_RETURNS) + 0.5) / N_RETURNS
    # Every second of the graph above, so that the two do not go in step.
    order = np.argsort(np.arange(N_RETURNS) * 3 % (N_RETURNS + 1), kind="stable")
    return list(zip(_quantiles(own, shares), _quantiles(above, shares[order]), strict=True))


def _quantiles(places: _Places, shares: FloatArray) -> Sequence[int]:
    sums = np.cumsum(places.shares)
    found = np.minimum(np.searchsorted(sums, shares * sums[-1]), len(sums) - 1)
    return [int(frame) for frame in places.frames[found]]
