"""The character as it performs: what each graph plays now, and how it comes to play something else.

The performer decides; it works on frame numbers alone and makes a timeline. Synthesis makes frames of that.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

from mlmg_runtime.errors import PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph, Position, Transition
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.releasing import release
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.search import Path, find_path, find_paths
from mlmg_runtime.playing.timeline import (
    Blend,
    Clip,
    Segment,
    Timeline,
    appended,
    play_along,
    play_clip,
)

# A part may take this long to find its way back to the graph above; without such a way it is blended onto that, and the
# blend may begin so late.
LONGEST_RETURN_S = 2.0


@dataclass(slots=True)
class _Track:
    """A graph that runs on its own: its motion, what it has played, and where it is from output frame `time` on."""

    graph: MotionGraph
    home: int
    position: Position
    time: int
    segments: tuple[Segment, ...] = ()

    def play(self, segments: Sequence[Segment]) -> None:
        for segment in segments:
            self.segments = appended(self.segments, segment)
            self.time = segment.end
            if segment.after is not None:
                self.position = segment.after


@dataclass(frozen=True, slots=True)
class _Departure:
    """How a graph gets into another motion: where it sets out, at which output frame, and what it plays on the way."""

    position: Position
    time: int
    segments: tuple[Segment, ...]
    home: int

    @property
    def arrives(self) -> int:
        return self.segments[-1].end


@dataclass(slots=True)
class Performer:
    """A character that plays motions of a library from the first frame of `start` on.

    `now` is the output frame at which the next thing asked for begins.
    """

    library: Library
    start: str
    now: int = 0
    _running: dict[str, _Track] = field(default_factory=dict)
    _ended: dict[str, tuple[Segment, ...]] = field(default_factory=dict)
    _likeness: Likeness = field(init=False)

    def __post_init__(self) -> None:
        """Put the whole body into the start motion."""
        self._likeness = Likeness(self.library)
        root = self.library.root
        home = root.index[self.start]
        self._running[root.name] = _Track(root, home, Position(home, 0), 0)

    # What can be asked of a character

    def bring(self, layers: Sequence[tuple[str, Sequence[str]]], from_start: bool = False) -> None:
        """Bring graphs to one of their candidates each; `now` is when all have arrived.

        The highest graphs come first; those of one level set out at the same time, when all above have arrived. Graphs
        below a named one that run and are not named are ended.

        Parameters
        ----------
        layers : graph and candidates (in the order that decides ties), highest graph first.
        from_start : whether the first of them enters its motion where that begins, though it may play it already.

        Raises
        ------
        PlayError
            If no candidate of a graph can be reached.
        """
        named = dict(layers)
        self._end([graph for graph in self._below(named) if graph not in named])
        afresh = layers[0][0] if from_start else None
        for depth in sorted(set(map(self._depth, named))):
            level = {graph: candidates for graph, candidates in layers if self._depth(graph) == depth}
            changing = [
                graph
                for graph in level
                if self.motion(graph) not in level[graph] or (graph == afresh and not self._begins(graph))
            ]
            self._change({graph: level[graph] for graph in changing}, afresh)

    def hold(self, n_frames: int) -> None:
        """Let `n_frames` output frames pass in what is playing."""
        self._hold_until(self.now + n_frames)

    def end(self, graph: str) -> None:
        """Give a body part, and those below it, back to the graph above."""
        self._end([graph])

    def play_pass(self, graph: str) -> None:
        """Let the motion that drives `graph` play to the last frame from which a transition leaves it."""
        track = self._driver(graph)
        self._lead_home(track)
        exits = track.graph.first_exit[track.position.motion]
        rest = exits[-1] - track.position.frame if exits else 0
        track.play(play_clip(track.time, track.position, rest))
        self._hold_until(track.time)

    def play_out(self, graph: str) -> None:
        """Let the motion that drives `graph` play to its clip's last frame, everything else going on meanwhile."""
        track = self._driver(graph)
        self._lead_home(track)
        rest = int(track.graph.n_frames[track.position.motion]) - track.position.frame
        track.play(play_clip(track.time, track.position, rest))
        self._hold_until(track.time)

    def motion(self, graph: str) -> str:
        """Return the motion that drives `graph` now: its own if it runs, else that of the graph above."""
        track = self._driver(graph)
        return track.graph.motions[track.home]

    def whereabouts(self) -> dict[str, tuple[str, int]]:
        """Return, by graph that runs, the motion and frame that it shows next; in a blend, where that leads."""
        return {name: _shown(track, self.now) for name, track in self._running.items()}

    def copy(self) -> Performer:
        """Return the same character where it is now, to go on by itself."""
        other = copy(self)
        other._running = {graph: copy(track) for graph, track in self._running.items()}
        other._ended = dict(self._ended)
        return other

    def runs(self, graph: str) -> bool:
        """Return whether `graph` plays a motion of its own."""
        return graph in self._running

    def timeline(self) -> Timeline:
        """Return all that has been played up to `now`."""
        tracks: dict[str, tuple[Segment, ...]] = {}
        for graph in self.library.graphs:
            running = self._running[graph].segments if graph in self._running else ()
            segments = self._ended.get(graph, ()) + running
            segments = tuple(segment for segment in segments if segment.begin < self.now)
            if segments:
                tracks[graph] = segments
        return Timeline(self.now, tracks)

    # Changing what plays

    def _change(self, changing: Mapping[str, Sequence[str]], afresh: str | None) -> None:
        """Lead graphs of one level into one of their candidates each, at the same time, after what runs below them.

        The graph `afresh` enters its motion where that begins.
        """
        self._end(self._below(changing))
        aims = {graph: changing[graph] if graph == afresh else self._aim(graph, changing[graph]) for graph in changing}
        returning = [graph for graph in changing if graph != afresh and self._above(graph) in aims[graph]]
        if returning:
            self._end(returning)
            # Time has passed: the others are asked anew.
            self._change({graph: changing[graph] for graph in changing if graph not in returning}, afresh)
            return
        self._end_detours(changing)
        departures = self._departures(aims, afresh)
        if None in departures.values():
            self._lead_round({graph: aims[graph] for graph in aims if graph != afresh})
            departures = self._departures(aims, afresh)
        self._set_out(
            {graph: found or self._on_the_spot(graph, aims[graph], aims) for graph, found in departures.items()}
        )

    def _aim(self, graph: str, candidates: Sequence[str]) -> Sequence[str]:
        """Return the candidates that a graph makes for, whichever it reaches soonest.

        On the root graph these are all; below it the one that fits best of those that anything leads to.
        """
        own, above, track = self.library.by_name[graph], self._above(graph), self._driver(graph)
        playing = {track.graph.motions[motion] for motion in (track.home, track.position.motion)} & own.index.keys()
        sources = [own.index[motion] for motion in sorted(playing)]
        for choice in _choices(own, above, candidates):
            targets = [own.index[motion] for motion in choice]
            if above in choice or (own.hops[np.ix_(sources, targets)] != UNREACHABLE).any():
                return choice
        raise PlayError(
            f"no walk on {graph} leads from {self.motion(graph)} to {', '.join(candidates)}; "
            f"see `mlmg info` for what was lost"
        )

    def _departures(self, aims: Mapping[str, Sequence[str]], afresh: str | None) -> Mapping[str, _Departure | None]:
        """Return how graphs of one level get into what they make for, each as soon as it can; None where none can."""
        return {
            graph: self._entry(graph, aims) if graph == afresh else self._soonest(graph, aims[graph], aims)
            for graph in aims
        }

    def _begins(self, graph: str) -> bool:
        """Return whether a graph has just begun its motion: it could be entered no earlier."""
        track = self._running.get(graph)
        if track is None or track.position.motion != track.home:
            return False
        return track.position.frame <= track.graph.window

    def _entry(self, graph: str, aims: Mapping[str, Sequence[str]]) -> _Departure:
        """Return how a graph gets to where a candidate begins: along a path, or else by a blend on the spot."""
        own = self.library.by_name[graph]
        choices = _choices(own, self._above(graph), aims[graph])
        for choice in choices:
            departure = self._soonest(graph, choice, aims, own.window - 1)
            if departure is not None:
                return departure
        return self._on_the_spot(graph, choices[0], aims)

    def _on_the_spot(self, graph: str, targets: Sequence[str], joining: Collection[str]) -> _Departure:
        """Return how a graph is blended at once to where one of `targets` begins: the one reached soonest, or first."""
        own = self.library.by_name[graph]
        soonest = self._soonest(graph, targets, joining)
        home = own.index[targets[0]] if soonest is None else soonest.home
        time, position = next(self._starts(own, joining))
        blend = Blend(time, time + own.window, position, Position(home, own.window - 1))
        return _Departure(position, time, (blend,), home)

    def _soonest(
        self,
        graph: str,
        targets: Sequence[str],
        joining: Collection[str],
        dst_frame: int | None = None,
        above: _Track | None = None,
    ) -> _Departure | None:
        """Return the departure that arrives soonest in one of `targets`; None if no walk leads there.

        Parameters
        ----------
        joining : the parts that set out at the same time.
        dst_frame : the last blended frame of the transition into the target; None for any.
        above : where the graph above is, if not where it is now.
        """
        own = self.library.by_name[graph]
        homes = [own.index[motion] for motion in targets]
        best: _Departure | None = None
        seen: set[Position] = set()
        for time, position in self._starts(own, joining, above):
            if position in seen or (best is not None and time + own.window > best.arrives):
                break
            seen.add(position)
            path = find_path(own, position, homes, dst_frame=dst_frame)
            if path is not None and (best is None or time + path.n_frames < best.arrives):
                segments = play_along(path.transitions, own.window, position, time)
                best = _Departure(position, time, tuple(segments), path.arrival.motion)
        return best

    def _starts(
        self, own: MotionGraph, joining: Collection[str], above: _Track | None = None
    ) -> Iterator[tuple[int, Position]]:
        """Yield when and where a graph may set out: where it is, or, without end, where the graph above will be."""
        if own.name in self._running:
            yield self._running[own.name].time, self._running[own.name].position
        else:
            track = self._driver(own.name) if above is None else above
            yield from ((clip.begin, clip.first) for clip in self._clips_above(own, track, joining))

    def _set_out(self, departures: Mapping[str, _Departure]) -> None:
        """Let graphs set out, and time pass until all have arrived."""
        for graph, departure in departures.items():
            if graph not in self._running:
                own = self.library.by_name[graph]
                self._running[graph] = _Track(own, departure.position.motion, departure.position, departure.time)
            self._running[graph].play(departure.segments)
            self._running[graph].home = departure.home
        self._hold_until(max((departure.arrives for departure in departures.values()), default=self.now))

    # Leading graphs to where the parts below them can leave

    def _lead_round(self, aims: Mapping[str, Sequence[str]]) -> None:
        """Let graphs come back to their motions another way, where parts could nowhere leave what they would play."""
        leaving = {graph: self._driver(graph) for graph in aims if graph not in self._running}
        for track in {track.graph.name: track for track in leaving.values()}.values():
            parts = [graph for graph in leaving if leaving[graph] is track]
            if any(self._soonest(graph, aims[graph], aims) is None for graph in parts):
                way = self._way_round({graph: aims[graph] for graph in parts}, track, aims)
                track.play(play_along(way, track.graph.window, track.position, track.time))

    def _way_round(
        self, parts: Mapping[str, Sequence[str]], track: _Track, joining: Collection[str]
    ) -> tuple[Transition, ...]:
        """Return the way back to a track's motion after which all of some parts that leave it have arrived soonest."""
        best: tuple[Transition, ...] = ()
        arrive: int | None = None
        allowed = self._allowed(track.graph.name, joining)
        for path in find_paths(track.graph, track.position, [track.home], allowed):
            there = replace(track, position=path.arrival, time=track.time + path.n_frames)
            if arrive is not None and there.time >= arrive:
                break
            found = [self._soonest(graph, targets, joining, above=there) for graph, targets in parts.items()]
            arrivals = [departure.arrives for departure in found if departure is not None]
            if len(arrivals) == len(found) and (arrive is None or max(arrivals) < arrive):
                best, arrive = path.transitions, max(arrivals)
        return best

    def _end_detours(self, joining: Collection[str]) -> None:
        """Let the graphs that parts are about to leave come back from a way round that the parts could not mind."""
        for graph in joining:
            parent = self.library.parent(graph)
            if parent is not None:
                track = self._driver(parent)
                if self._path_home(track, joining) is None:
                    self._lead_home(track)

    def _lead_home(self, track: _Track) -> None:
        """Let a graph come back to its motion if it is on a way round."""
        path = self._path_home(track)
        if track.position.motion != track.home and path is not None:
            track.play(play_along(path.transitions, track.graph.window, track.position, track.time))

    def _path_home(self, track: _Track, joining: Collection[str] = ()) -> Path | None:
        return find_path(track.graph, track.position, [track.home], self._allowed(track.graph.name, joining))

    # Ending parts (rule 2)

    def _end(self, graphs: Sequence[str]) -> None:
        """Lead running parts, and those below them, back to the graphs above them.

        The lowest come first, parts of one level at the same time.
        """
        below = self._below(graphs)
        ended = [graph for graph in self._running if graph in graphs or graph in below]
        for depth in sorted(set(map(self._depth, ended)), reverse=True):
            now = self.now
            ending = [graph for graph in ended if self._depth(graph) == depth]
            ways = [self._way_back(self._running[graph]) for graph in ending]
            for graph, way in zip(ending, ways, strict=True):
                self._running[graph].play(way)
                now = max(now, self._running[graph].time)
            # What was looked ahead at holds only as long as the graphs above mind the parts that come back.
            self._hold_until(now, but=ending)
            for graph in ending:
                self._ended[graph] = self._ended.get(graph, ()) + self._running.pop(graph).segments

    def _way_back(self, track: _Track) -> tuple[Segment, ...]:
        deadline = self.now + round(LONGEST_RETURN_S * self.library.frame_rate)
        driver = self._driver(self.library.ancestors(track.graph.name)[0])
        above = list(self._clips_above(track.graph, driver, deadline=deadline))
        way = find_return(track.graph, track.position, track.time, above, deadline)
        return release(self.library, track.graph, self._stay(track), above, deadline) if way is None else way

    # Letting time pass

    def _hold_until(self, time: int, but: Sequence[str] = ()) -> None:
        self.now = time
        for graph, track in self._running.items():
            if track.time < self.now and graph not in but:
                for segment in self._stay(track):
                    track.play((_cut(segment, self.now),))
                    if track.time >= self.now:
                        break

    def _stay(self, track: _Track, joining: Collection[str] = ()) -> Iterator[Segment]:
        """Yield what a track will play; `joining` are parts that are about to run below it."""
        allowed = self._allowed(track.graph.name, joining)
        return stay(self._likeness, track.graph, track.home, track.position, track.time, allowed)

    def _clips_above(
        self, graph: MotionGraph, track: _Track, joining: Collection[str] = (), deadline: int | None = None
    ) -> Iterator[Clip]:
        """Yield the clips that a track above will play, as far as they are motions of `graph` and in its indices.

        A blend is a clip of no frames at its beginning: it can be left there, and need not follow a clip that has some.
        Ends with the first segment that begins after `deadline`; without one, never.
        """
        for segment in self._stay(track, joining):
            if deadline is not None and segment.begin > deadline:
                return
            clip = segment if isinstance(segment, Clip) else Clip(segment.begin, segment.begin, segment.source, 0)
            name = track.graph.motions[clip.first.motion]
            if name in graph.index:
                yield replace(clip, first=Position(graph.index[name], clip.first.frame))

    def _allowed(self, graph: str, joining: Collection[str] = ()) -> frozenset[int]:
        """Return the motions that a way round on `graph` may pass: those that all running parts below it are on."""
        below = [g for g in {*self._running, *joining} if graph in self.library.ancestors(g)]
        parts = [self.library.by_name[g] for g in below]
        motions = self.library.motions(graph)
        return frozenset(i for i, motion in enumerate(motions) if all(motion in part.index for part in parts))

    # Who is where in the tree

    def _above(self, graph: str) -> str | None:
        """Return the motion that the graph above a part plays; None for the root."""
        parent = self.library.parent(graph)
        return None if parent is None else self.motion(parent)

    def _driver(self, graph: str) -> _Track:
        return next(self._running[g] for g in (graph, *self.library.ancestors(graph)) if g in self._running)

    def _below(self, graphs: Collection[str]) -> list[str]:
        """Return the running graphs that lie below one of `graphs`."""
        return [graph for graph in self._running if any(above in graphs for above in self.library.ancestors(graph))]

    def _depth(self, graph: str) -> int:
        return len(self.library.ancestors(graph))


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


def _cut(segment: Segment, end: int) -> Segment:
    """Return a clip that stops at `end`; a blend is always shown to its end."""
    if isinstance(segment, Clip) and segment.end > end:
        return replace(segment, end=end, n_source=end - segment.begin)
    return segment


def _shown(track: _Track, now: int) -> tuple[str, int]:
    """Return the motion and frame that a track shows at an output frame."""
    position = track.position
    for segment in reversed(track.segments):
        if segment.begin <= now < segment.end:
            if isinstance(segment, Clip):
                further = round((now - segment.begin) * segment.speed)
                position = Position(segment.first.motion, segment.first.frame + further)
            elif segment.after is not None:
                position = segment.after
            break
    return track.graph.motions[position.motion], position.frame
