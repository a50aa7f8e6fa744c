"""What each graph of a library plays now and will go on to play, by itself or as the graph above it does."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from itertools import chain

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.search import Path, find_path
from mlmg_runtime.playing.timeline import Clip, Segment, Timeline, appended, play_along


@dataclass(slots=True)
class Track:
    """A graph that runs on its own: its motion, what it has played, and where it is from output frame `time` on.

    `home` is the motion that it was brought to, `position` may be on a way round that leads back there.
    """

    graph: MotionGraph
    home: int
    position: Position
    time: int
    segments: tuple[Segment, ...] = ()

    def play(self, segments: Sequence[Segment]) -> None:
        """Go on with some segments."""
        for segment in segments:
            self.segments = appended(self.segments, segment)
            self.time = segment.end
            if segment.after is not None:
                self.position = segment.after

    def shown(self, time: int) -> tuple[str, int]:
        """Return the motion and frame that it shows at an output frame; in a blend, where that leads."""
        position = self.position
        for segment in reversed(self.segments):
            if segment.begin <= time < segment.end:
                if isinstance(segment, Clip):
                    further = round((time - segment.begin) * segment.speed)
                    position = Position(segment.first.motion, segment.first.frame + further)
                elif segment.after is not None:
                    position = segment.after
                break
        return self.graph.motions[position.motion], position.frame


@dataclass(slots=True)
class Ensemble:
    """The graphs of a library as they play together, the root graph always.

    Attributes
    ----------
    now : the output frame up to which all that happens is settled.
    running : by name, the graphs that play a motion of their own; the others follow the graph above them.
    ended : what graphs have played before they were given back to the graph above.
    """

    library: Library
    now: int = 0
    running: dict[str, Track] = field(default_factory=dict)
    _ended: dict[str, tuple[Segment, ...]] = field(default_factory=dict)
    _likeness: Likeness = field(init=False)

    def __post_init__(self) -> None:
        """Look at the library's motions when that is needed, and once."""
        self._likeness = Likeness(self.library)

    def copy(self) -> Ensemble:
        """Return the same, to go on by itself."""
        other = copy(self)
        other.running = {graph: copy(track) for graph, track in self.running.items()}
        other._ended = dict(self._ended)
        return other

    def timeline(self) -> Timeline:
        """Return all that has been played up to `now`."""
        tracks: dict[str, tuple[Segment, ...]] = {}
        for graph in self.library.graphs:
            running = self.running[graph].segments if graph in self.running else ()
            segments = self._ended.get(graph, ()) + running
            segments = tuple(segment for segment in segments if segment.begin < self.now)
            if segments:
                tracks[graph] = segments
        return Timeline(self.now, tracks)

    # Who is where in the tree

    def driver(self, graph: str) -> Track:
        """Return what drives a graph: its own track if it runs, else that of the nearest above it that does."""
        return next(self.running[g] for g in (graph, *self.library.ancestors(graph)) if g in self.running)

    def motion(self, graph: str) -> str:
        """Return the motion that drives a graph."""
        track = self.driver(graph)
        return track.graph.motions[track.home]

    def motion_above(self, graph: str) -> str | None:
        """Return the motion that the graph above a part plays; None for the root."""
        parent = self.library.parent(graph)
        return None if parent is None else self.motion(parent)

    def below(self, graphs: Collection[str]) -> list[str]:
        """Return the running graphs that lie below one of `graphs`."""
        return [graph for graph in self.running if any(above in graphs for above in self.library.ancestors(graph))]

    def levels(self, graphs: Collection[str]) -> Sequence[Sequence[str]]:
        """Return graphs by how many others lie above them, fewest first."""
        depths = {graph: len(self.library.ancestors(graph)) for graph in graphs}
        return [[graph for graph in graphs if depths[graph] == depth] for depth in sorted(set(depths.values()))]

    # What a track will play

    def stay(self, track: Track, joining: Collection[str] = ()) -> Iterator[Segment]:
        """Yield, without end, what a track will play; `joining` are parts that are about to run below it."""
        allowed = self.allowed(track.graph.name, joining)
        return stay(self._likeness, track.graph, track.home, track.position, track.time, allowed)

    def coming(self, track: Track) -> Iterator[Segment]:
        """Yield, without end, what a track plays from `now` on: what it is about to play, and then to stay."""
        settled = (segment for segment in track.segments if segment.end > self.now)
        return chain(settled, self.stay(track))

    def clips_above(
        self, graph: MotionGraph, track: Track, joining: Collection[str] = (), deadline: int | None = None
    ) -> Iterator[Clip]:
        """Yield the clips that a track above will play, as far as they are motions of `graph` and in its indices.

        A blend is a clip of no frames at its beginning: it can be left there, and need not follow a clip that has some.
        Ends with the first segment that begins after `deadline`; without one, never.
        """
        for segment in self.stay(track, joining):
            if deadline is not None and segment.begin > deadline:
                return
            clip = segment if isinstance(segment, Clip) else Clip(segment.begin, segment.begin, segment.source, 0)
            name = track.graph.motions[clip.first.motion]
            if name in graph.index:
                yield replace(clip, first=Position(graph.index[name], clip.first.frame))

    def allowed(self, graph: str, joining: Collection[str] = ()) -> frozenset[int]:
        """Return the motions that a way round on `graph` may pass: those that all running parts below it are on."""
        below = [g for g in {*self.running, *joining} if graph in self.library.ancestors(g)]
        parts = [self.library.by_name[g] for g in below]
        motions = self.library.motions(graph)
        return frozenset(i for i, motion in enumerate(motions) if all(motion in part.index for part in parts))

    def path_home(self, track: Track, joining: Collection[str] = ()) -> Path | None:
        """Return the way back to a track's motion; None where there is none that the parts below can go along with."""
        return find_path(track.graph, track.position, [track.home], self.allowed(track.graph.name, joining))

    # Letting time pass

    def lead_home(self, track: Track) -> None:
        """Let a graph come back to its motion if it is on a way round."""
        path = self.path_home(track)
        if track.position.motion != track.home and path is not None:
            track.play(play_along(path.transitions, track.graph.window, track.position, track.time))

    def hold_until(self, time: int, but: Sequence[str] = ()) -> None:
        """Let all graphs, but some, stay in what they play up to an output frame."""
        self.now = time
        for graph, track in self.running.items():
            if track.time < time and graph not in but:
                for segment in self.stay(track):
                    track.play((_cut(segment, time),))
                    if track.time >= time:
                        break

    def give_back(self, graph: str) -> None:
        """Let a graph that has come back follow the graph above it from now on."""
        self._ended[graph] = self._ended.get(graph, ()) + self.running.pop(graph).segments


def _cut(segment: Segment, end: int) -> Segment:
    """Return a clip that stops at `end`; a blend is always shown to its end."""
    if isinstance(segment, Clip) and segment.end > end:
        return replace(segment, end=end, n_source=end - segment.begin)
    return segment
