"""The character as it performs: what each graph plays now, and how it comes to play something else.

The performer decides; it works on frame numbers alone and makes a timeline. Synthesis makes frames of that.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from mlmg_runtime.errors import PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.search import Path, find_path
from mlmg_runtime.playing.timeline import (
    Blend,
    Clip,
    Segment,
    Timeline,
    appended,
    play_along,
    play_clip,
)

# A part may take this long to find its way back to the graph above before a blend is made on the spot.
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

    def __post_init__(self) -> None:
        """Put the whole body into the start motion."""
        root = self.library.root
        home = root.index[self.start]
        self._running[root.name] = _Track(root, home, Position(home, 0), 0)

    # What can be asked of a character

    def bring(self, layers: Sequence[tuple[str, Sequence[str]]]) -> None:
        """Bring graphs to one of their candidates each, highest graph first; `now` is when all have arrived.

        Graphs below a named one that run and are not named are ended.

        Parameters
        ----------
        layers : graph and candidates (in the order that decides ties), highest graph first.

        Raises
        ------
        PlayError
            If no candidate of a graph can be reached.
        """
        named = [graph for graph, _ in layers]
        self._end([g for g in self._running if g not in named and any(a in named for a in self.library.ancestors(g))])
        for graph, candidates in layers:
            if self.motion(graph) in candidates:
                continue
            if self.library.parent(graph) is None:
                self._change_root(candidates)
            else:
                self._change_part(graph, candidates)

    def hold(self, n_frames: int) -> None:
        """Let `n_frames` output frames pass in what is playing."""
        self._hold_until(self.now + n_frames)

    def end(self, graph: str) -> None:
        """Give a body part, and those below it, back to the graph above."""
        self._end([graph])

    def play_out(self, graph: str) -> None:
        """Let the motion that drives `graph` play to its clip's last frame, everything else going on meanwhile."""
        track = self._driver(graph)
        if track.position.motion != track.home:
            path = find_path(track.graph, track.position, [track.home], self._allowed(track.graph.name))
            if path is not None:
                track.play(play_along(path.transitions, track.graph.window, track.position, track.time))
        rest = int(track.graph.n_frames[track.position.motion]) - track.position.frame
        track.play(play_clip(track.time, track.position, rest))
        self._hold_until(track.time)

    def motion(self, graph: str) -> str:
        """Return the motion that drives `graph` now: its own if it runs, else that of the graph above."""
        track = self._driver(graph)
        return track.graph.motions[track.home]

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

    def _change_root(self, candidates: Sequence[str]) -> None:
        """Lead the whole body into the candidate that is reached soonest, after all parts have come back."""
        root = self.library.root
        self._end([graph for graph in self._running if graph != root.name])
        track = self._running[root.name]
        path = find_path(root, track.position, [root.index[motion] for motion in candidates])
        if path is None:
            raise _unreachable(root, self.motion(root.name), candidates)
        self._take(track, path)

    def _change_part(self, graph: str, candidates: Sequence[str]) -> None:
        """Lead a body part into the candidate that fits what the graph above plays best, by OMS."""
        own = self.library.by_name[graph]
        parent = self.library.parent(graph)
        assert parent is not None
        above = self.motion(parent)
        if above not in own.index:
            raise PlayError(f"{graph} cannot leave {above}, which is not on it (rule 1)")
        self._end([g for g in self._running if graph in self.library.ancestors(g)])
        fitting = sorted(candidates, key=lambda motion: float(own.oms[own.index[above], own.index[motion]]))
        for motion in fitting:
            if motion == above:
                self._end([graph])
                return
            if self._lead_part(own, own.index[motion]):
                return
        raise _unreachable(own, self.motion(graph), candidates)

    def _lead_part(self, graph: MotionGraph, target: int) -> bool:
        if graph.name in self._running:
            track = self._running[graph.name]
            path = find_path(graph, track.position, [target])
            if path is None:
                return False
        else:
            found = self._way_out(graph, target)
            if found is None:
                return False
            time, position, path = found
            track = _Track(graph, position.motion, position, time)
            self._running[graph.name] = track
        self._take(track, path)
        return True

    def _way_out(self, graph: MotionGraph, target: int) -> tuple[int, Position, Path] | None:
        """Return when and where a part leaves the graph above, and its path to `target`: the soonest to arrive."""
        best: tuple[int, Position, Path] | None = None
        seen: set[Position] = set()
        for clip in self._clips_above(graph):
            if clip.first in seen or (best is not None and clip.begin + graph.window > best[0] + best[2].n_frames):
                break
            seen.add(clip.first)
            path = find_path(graph, clip.first, [target])
            if path is not None and (best is None or clip.begin + path.n_frames < best[0] + best[2].n_frames):
                best = clip.begin, clip.first, path
        return best

    def _take(self, track: _Track, path: Path) -> None:
        track.play(play_along(path.transitions, track.graph.window, track.position, track.time))
        track.home = path.arrival.motion
        self._hold_until(track.time)

    # Ending parts (rule 2)

    def _end(self, graphs: Sequence[str]) -> None:
        """Lead running parts, and those below them, back to the graphs above them.

        The lowest come first, parts of one level at the same time.
        """
        above = {graph: self.library.ancestors(graph) for graph in self._running}
        depth = {graph: len(above[graph]) for graph in above if not {graph, *above[graph]}.isdisjoint(graphs)}
        for level in sorted(set(depth.values()), reverse=True):
            now = self.now
            ending = [graph for graph in depth if depth[graph] == level]
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
        above = list(takewhile(lambda clip: clip.begin <= deadline, self._clips_above(track.graph, deadline)))
        way = find_return(track.graph, track.position, track.time, above, deadline)
        if way is not None:
            return way
        return (Blend(track.time, track.time + track.graph.window, track.position, None),)

    # Letting time pass

    def _hold_until(self, time: int, but: Sequence[str] = ()) -> None:
        self.now = max(self.now, time)
        for graph, track in self._running.items():
            if track.time < self.now and graph not in but:
                for segment in self._stay(track):
                    track.play((_cut(segment, self.now),))
                    if track.time >= self.now:
                        break

    def _stay(self, track: _Track, joining: MotionGraph | None = None) -> Iterator[Segment]:
        """Yield what a track will play; `joining` is a part that is about to run below it."""
        allowed = self._allowed(track.graph.name, joining)
        return stay(self.library, track.graph, track.home, track.position, track.time, allowed)

    def _clips_above(self, graph: MotionGraph, deadline: int | None = None) -> Iterator[Clip]:
        """Yield the clips that the graph above will play, as far as they are motions of `graph` and in its indices.

        Where one blend follows another, the clip between them is a single moment, of no frames. Ends with the first
        segment that begins after `deadline`; without one, never.
        """
        parent = self.library.parent(graph.name)
        assert parent is not None
        track = self._driver(parent)
        before: Segment | None = None
        for segment in self._stay(track, graph):
            if deadline is not None and segment.begin > deadline:
                return
            clip = segment if isinstance(segment, Clip) else Clip(segment.begin, segment.begin, segment.source, 0)
            name = track.graph.motions[clip.first.motion]
            if name in graph.index and not (isinstance(segment, Blend) and isinstance(before, Clip)):
                first = Position(graph.index[name], clip.first.frame)
                yield Clip(clip.begin, clip.end, first, clip.n_source)
            before = segment

    def _allowed(self, graph: str, joining: MotionGraph | None = None) -> frozenset[int]:
        """Return the motions that a way round on `graph` may pass: those that all running parts below it are on."""
        below = [track.graph for name, track in self._running.items() if graph in self.library.ancestors(name)]
        below += [joining] if joining is not None else []
        own = self.library.by_name[graph]
        return frozenset(
            index for index, motion in enumerate(own.motions) if all(motion in part.index for part in below)
        )

    def _driver(self, graph: str) -> _Track:
        return next(self._running[g] for g in (graph, *self.library.ancestors(graph)) if g in self._running)


def _cut(segment: Segment, end: int) -> Segment:
    """Return a clip that stops at `end`; a blend is always shown to its end."""
    if isinstance(segment, Clip) and segment.end > end:
        return Clip(segment.begin, end, segment.first, end - segment.begin)
    return segment


def _unreachable(graph: MotionGraph, motion: str, candidates: Sequence[str]) -> PlayError:
    names = ", ".join(candidates)
    return PlayError(f"no walk on {graph.name} leads from {motion} to {names}; see `mlmg info` for what was lost")
