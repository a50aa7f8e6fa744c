"""How graphs get into other motions: which they make for, where they set out, and what they play on the way."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mlmg_runtime.errors import PlayError
from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph, Position, Transition
from mlmg_runtime.playing.ensemble import Ensemble, Track
from mlmg_runtime.playing.search import find_path, find_paths
from mlmg_runtime.playing.timeline import Blend, Segment, play_along


@dataclass(frozen=True, slots=True)
class Departure:
    """How a graph gets into another motion: where it sets out, at which output frame, and what it plays on the way."""

    position: Position
    time: int
    segments: tuple[Segment, ...]
    home: int

    @property
    def arrives(self) -> int:
        """Return the output frame from which it is there."""
        return self.segments[-1].end


@dataclass(frozen=True, slots=True)
class Departing:
    """Graphs of one level that are to get into other motions at the same time.

    Attributes
    ----------
    aims : the candidates that each makes for, whichever it reaches soonest.
    afresh : the graph, if any, that enters its motion where that begins.
    """

    ensemble: Ensemble
    aims: Mapping[str, Sequence[str]]
    afresh: str | None = None

    def departures(self) -> Mapping[str, Departure]:
        """Return how each sets out: as soon as it can, after a way round of the graph above, or by a blend at once."""
        found = self._ways()
        if None in found.values():
            self._lead_round()
            found = self._ways()
        return {graph: way or self._on_the_spot(graph, self.aims[graph]) for graph, way in found.items()}

    def _ways(self) -> Mapping[str, Departure | None]:
        return {
            graph: self._entry(graph) if graph == self.afresh else self._soonest(graph, aim)
            for graph, aim in self.aims.items()
        }

    def _entry(self, graph: str) -> Departure:
        """Return how a graph gets to where a candidate begins: along a path, or else by a blend on the spot."""
        own = self.ensemble.library.by_name[graph]
        choices = _choices(own, self.ensemble.motion_above(graph), self.aims[graph])
        for choice in choices:
            departure = self._soonest(graph, choice, own.window - 1)
            if departure is not None:
                return departure
        return self._on_the_spot(graph, choices[0])

    def _on_the_spot(self, graph: str, targets: Sequence[str]) -> Departure:
        """Return how a graph is blended at once to where one of `targets` begins: the one reached soonest, or first."""
        own = self.ensemble.library.by_name[graph]
        soonest = self._soonest(graph, targets)
        home = own.index[targets[0]] if soonest is None else soonest.home
        time, position = next(self._starts(own))
        blend = Blend(time, time + own.window, position, Position(home, own.window - 1))
        return Departure(position, time, (blend,), home)

    def _soonest(
        self, graph: str, targets: Sequence[str], dst_frame: int | None = None, above: Track | None = None
    ) -> Departure | None:
        """Return the departure that arrives soonest in one of `targets`; None if no walk leads there.

        Parameters
        ----------
        dst_frame : the last blended frame of the transition into the target; None for any.
        above : where the graph above is, if not where it is now.
        """
        own = self.ensemble.library.by_name[graph]
        homes = [own.index[motion] for motion in targets]
        best: Departure | None = None
        seen: set[Position] = set()
        for time, position in self._starts(own, above):
            if position in seen or (best is not None and time + own.window > best.arrives):
                break
            seen.add(position)
            path = find_path(own, position, homes, dst_frame=dst_frame)
            if path is not None and (best is None or time + path.n_frames < best.arrives):
                segments = play_along(path.transitions, own.window, position, time)
                best = Departure(position, time, tuple(segments), path.arrival.motion)
        return best

    def _starts(self, own: MotionGraph, above: Track | None = None) -> Iterator[tuple[int, Position]]:
        """Yield when and where a graph may set out: where it is, or, without end, where the graph above will be."""
        running = self.ensemble.running.get(own.name)
        if running is not None:
            yield running.time, running.position
        else:
            track = self.ensemble.driver(own.name) if above is None else above
            clips = self.ensemble.clips_above(own, track, self.aims)
            yield from ((clip.begin, clip.first) for clip in clips)

    # Leading graphs to where the parts below them can leave

    def _lead_round(self) -> None:
        """Let graphs come back to their motions another way, where parts could nowhere leave what they would play."""
        ensemble = self.ensemble
        leaving = {g: ensemble.driver(g) for g in self.aims if g != self.afresh and g not in ensemble.running}
        for track in {track.graph.name: track for track in leaving.values()}.values():
            parts = [graph for graph in leaving if leaving[graph] is track]
            if any(self._soonest(graph, self.aims[graph]) is None for graph in parts):
                way = self._way_round(parts, track)
                track.play(play_along(way, track.graph.window, track.position, track.time))

    def _way_round(self, parts: Collection[str], track: Track) -> tuple[Transition, ...]:
        """Return the way back to a track's motion after which all of some parts that leave it have arrived soonest."""
        best: tuple[Transition, ...] = ()
        arrive: int | None = None
        allowed = self.ensemble.allowed(track.graph.name, self.aims)
        for path in find_paths(track.graph, track.position, [track.home], allowed):
            there = replace(track, position=path.arrival, time=track.time + path.n_frames)
            if arrive is not None and there.time >= arrive:
                break
            found = [self._soonest(graph, self.aims[graph], above=there) for graph in parts]
            arrivals = [departure.arrives for departure in found if departure is not None]
            if len(arrivals) == len(found) and (arrive is None or max(arrivals) < arrive):
                best, arrive = path.transitions, max(arrivals)
        return best


def aim(ensemble: Ensemble, graph: str, candidates: Sequence[str]) -> Sequence[str]:
    """Return the candidates that a graph makes for, whichever it reaches soonest.

    On the root graph these are all; below it the one that fits best of those that anything leads to.

    Raises
    ------
    PlayError
        If nothing leads to any of them.
    """
    own, above, track = ensemble.library.by_name[graph], ensemble.motion_above(graph), ensemble.driver(graph)
    playing = {track.graph.motions[motion] for motion in (track.home, track.position.motion)} & own.index.keys()
    sources = [own.index[motion] for motion in sorted(playing)]
    for choice in _choices(own, above, candidates):
        targets = [own.index[motion] for motion in choice]
        if above in choice or (own.hops[np.ix_(sources, targets)] != UNREACHABLE).any():
            return choice
    raise PlayError(
        f"no walk on {graph} leads from {ensemble.motion(graph)} to {', '.join(candidates)}; "
        f"see `mlmg info` for what was lost"
    )


def _choices(own: MotionGraph, above: str | None, candidates: Sequence[str]) -> Sequence[Sequence[str]]:
    """Return candidates in the order in which they are tried, together where the one that is reached soonest wins.

    On the root graph they are tried together; below it each alone, first what fits best to the motion `above` by OMS.
    """
    if above is None:
        return [candidates]
    if above not in own.index:
        raise PlayError(f"{own.name} cannot leave {above}, which is not on it (rule 1)")
    fits = own.oms[own.index[above]]
    return [[motion] for motion in sorted(candidates, key=lambda motion: float(fits[own.index[motion]]))]
