"""Motion graphs -> how long the ways between their motions take, and what they cost.

The soonest way from each frame is known (`ways`), and so is where staying in a motion leads (`staying`). Over the
frames where a graph may be when it sets out, that gives the average, the least and the most.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isinf

import numpy as np

from mlmg_lang.explaining.staying import Places, Stay, after, begins_at, places_of, staying
from mlmg_lang.explaining.ways import Exits, Into, Ways, exits_of, ways_into
from mlmg_lang.planning.estimate import Estimate, Moment, Playing, Trip, exactly
from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import latest_loop, stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.performer import LONGEST_RETURN_S
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.timeline import Blend, Clip

# A part's way back depends on where it and the graph above are. So many pairs of places are looked at, evenly spread
# over both; the order of those above is such that the two do not go in step.
_ORDER_ABOVE = (2, 0, 3, 1)


@dataclass(slots=True)
class MotionTravel:
    """Ways in the motion graphs of a library; see `planning.estimate.Travel`. What has been worked out is kept."""

    library: Library
    _likeness: Likeness = field(init=False)
    _exits: dict[str, Exits] = field(default_factory=dict)
    _into: dict[tuple[str, str, bool], Into] = field(default_factory=dict)
    _stays: dict[tuple[str, str, int, Position], Stay] = field(default_factory=dict)
    _known: dict[tuple[str, Playing], Places] = field(default_factory=dict)
    _trips: dict[tuple[object, ...], tuple[Trip, ...]] = field(default_factory=dict)
    _backs: dict[tuple[object, ...], Trip] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Know nothing yet."""
        self._likeness = Likeness(self.library)

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
        n_frames = self.library.by_name[driver].n_frames[places.motions]
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
        intos = [self._way_into(own, candidate, to_begin) for candidate in candidates]
        ways = np.array([self._ways(own, playing.motion, into, driver, places) for into in intos])
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

    def _ways(self, own: MotionGraph, home: str, into: Into, driver: str, places: Places) -> Ways:
        """Return the soonest way into a motion from each of some places of the driver, which stays in `home`."""
        above = self.library.by_name[driver]
        if above is own:
            return into.ways(places.motions, places.frames) + places.leads
        ways = into.ways(_indices(above, own)[places.motions], places.frames)
        for some, later in self._later(own, above, home, into, places):
            # A part may also set out after the graph above has gone on for a while, if that is sooner.
            ways = np.where(some & (later.real < ways.real), later, ways)
        return ways + places.leads

    def _later(
        self, own: MotionGraph, above: MotionGraph, home: str, into: Into, places: Places
    ) -> Iterator[tuple[BoolArray, Ways]]:
        """Yield, for places from which the graph above goes on alike, the ways of a part that goes along with it."""
        leave = self._next_leave(above, above.index[home], places)
        for motion, frame in sorted(set(zip(places.motions.tolist(), leave.tolist(), strict=True))):
            stays = self._stay(above, above.index[home], Position(motion, frame), own)
            moments = [(segment.begin, begins_at(segment)) for segment in stays.segments[1:]]
            on = [(time, at) for time, at in moments if above.motions[at.motion] in own.index]
            if not on:
                continue
            motions = _indices(above, own)[[at.motion for _, at in on]]
            ways = into.ways(motions, np.array([at.frame for _, at in on])) + [time for time, _ in on]
            best = ways[np.argmin(ways.real)]
            yield (places.motions == motion) & (leave == frame), best + leave - places.frames

    def _next_leave(self, own: MotionGraph, home: int, places: Places) -> IntArray:
        """Return up to which frame a graph goes on from each place before it may do something else to stay."""
        keys = np.append(self._exits_of(own).key, np.inf)
        first = self._exits_of(own).first(places.motions, places.frames)
        leave = keys[first] - places.motions * self._exits_of(own).stride
        leave = np.where(np.isfinite(leave), leave, places.frames)
        loop = latest_loop(own, home)
        if loop is not None:
            leave = np.where((places.motions == home) & (places.frames <= loop.src_frame), loop.src_frame, leave)
        return leave.astype(int)

    def _way_into(self, own: MotionGraph, target: str, to_begin: bool) -> Into:
        key = (own.name, target, to_begin)
        if key not in self._into:
            self._into[key] = ways_into(own, self._exits_of(own), own.index[target], to_begin)
        return self._into[key]

    def _exits_of(self, own: MotionGraph) -> Exits:
        if own.name not in self._exits:
            self._exits[own.name] = exits_of(own)
        return self._exits[own.name]

    # --- where a graph may be ---

    def _places(self, driver: str, playing: Playing) -> Places:
        """Return where a graph that plays a motion may be."""
        if (driver, playing) not in self._known:
            self._known[driver, playing] = self._find_places(self.library.by_name[driver], playing)
        return self._known[driver, playing]

    def _find_places(self, own: MotionGraph, playing: Playing) -> Places:
        home, then = own.index[playing.motion], self._then(own, playing)
        n_frames = playing.held_s * self.library.frame_rate
        if isinf(n_frames):
            # What comes again and again is the same from all places that go on alike.
            leave = self._next_leave(own, home, then)
            alike: dict[Position, float] = {}
            for motion, frame, share in zip(then.motions.tolist(), leave.tolist(), then.shares.tolist(), strict=True):
                alike[Position(motion, frame)] = alike.get(Position(motion, frame), 0.0) + share
        else:
            positions = map(Position, then.motions.tolist(), then.frames.tolist())
            alike = dict(zip(positions, then.shares.tolist(), strict=True))
            n_frames = round(n_frames)
        if n_frames == 0:
            return then
        return places_of(
            (share, after(self._stay(own, home, position, None), position, n_frames))
            for position, share in alike.items()
        )

    def _then(self, own: MotionGraph, playing: Playing) -> Places:
        """Return where a graph was at the moment that is known of it."""
        home = own.index[playing.motion]
        exits = own.first_exit[home]
        match playing.moment:
            case Moment.AT:
                return places_of([(1.0, [(Position(home, playing.frame), 0)])])
            case Moment.FIRST:
                frame = 0
            case Moment.PASSED:
                frame = exits[-1] if exits else 0
            case Moment.ARRIVED if playing.source in own.index:
                arrived = self._arrivals(own, playing)
                if arrived is not None:
                    return arrived
                frame = own.window
            case _:
                frame = own.window
        return places_of([(1.0, [(Position(home, min(frame, exits[-1]) if exits else frame), 0)])])

    def _arrivals(self, own: MotionGraph, playing: Playing) -> Places | None:
        """Return where a graph arrives in a motion, from anywhere in the one before; None if no way leads there."""
        into = self._way_into(own, playing.motion, False)
        before = self._places(own.name, Playing(playing.source))
        frames = into.arrivals(before.motions, before.frames)
        known = frames >= 0
        if not known.any():
            return None
        home, total = own.index[playing.motion], before.shares[known].sum()
        found = zip(frames[known].tolist(), before.shares[known].tolist(), strict=True)
        return places_of((share / total, [(Position(home, frame), 0)]) for frame, share in found)

    def _stay(self, own: MotionGraph, home: int, position: Position, below: MotionGraph | None) -> Stay:
        """Return how a graph stays in a motion, minding a graph below it."""
        key = (own.name, "" if below is None else below.name, home, position)
        if key not in self._stays:
            allowed = {at for at, name in enumerate(own.motions) if below is None or name in below.index}
            self._stays[key] = staying(self._likeness, own, home, position, allowed)
        return self._stays[key]

    # --- ways back ---

    def _back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        own, over = self.library.by_name[graph], self.library.by_name[driver]
        deadline = round(LONGEST_RETURN_S * self.library.frame_rate)
        shares = (np.arange(len(_ORDER_ABOVE)) + 0.5) / len(_ORDER_ABOVE)
        places = _quantiles(self._places(graph, playing), shares)
        others = _quantiles(self._places(driver, above), shares[list(_ORDER_ABOVE)])
        frames, costs, released = [], [], 0
        for position, there in zip(places, others, strict=True):
            clips = self._clips(over, over.index[above.motion], there, own, deadline)
            way = find_return(own, position, 0, clips, deadline)
            released += way is None
            frames.append(own.window if way is None else way[-1].end)
            blends = [segment for segment in way or () if isinstance(segment, Blend)]
            costs.append(sum(blend.transition.cost for blend in blends if blend.transition is not None))
        takes = self._estimate(np.array(frames, float), np.ones(len(frames)))
        return Trip(above.motion, 1.0, takes, float(np.mean(costs)), released / len(frames))

    def _clips(self, over: MotionGraph, home: int, position: Position, own: MotionGraph, deadline: int) -> list[Clip]:
        """Return what a graph plays for a while, as far as it is on a graph below, in the indices of that."""
        allowed = {at for at, motion in enumerate(over.motions) if motion in own.index}
        clips = []
        for segment in stay(self._likeness, over, home, position, 0, allowed):
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


def _indices(graph: MotionGraph, other: MotionGraph) -> IntArray:
    """Return the index that each motion of a graph has in another; -1, if it is not on that."""
    return np.array([other.index.get(motion, -1) for motion in graph.motions])


def _quantiles(places: Places, shares: FloatArray) -> list[Position]:
    """Return the positions at shares of all chances."""
    sums = np.cumsum(places.shares)
    found = np.minimum(np.searchsorted(sums, shares * sums[-1]), len(sums) - 1)
    return [Position(int(places.motions[at]), int(places.frames[at])) for at in found]
