"""The character as it performs: what can be asked of it, and in which order its graphs come to do it.

The performer decides; it works on frame numbers alone and makes a timeline. Synthesis makes frames of that.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import Position
from mlmg_runtime.playing.departing import Departing, Departure, aim
from mlmg_runtime.playing.ensemble import Ensemble, Track
from mlmg_runtime.playing.longest_steps import LongestSteps
from mlmg_runtime.playing.releasing import release
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.timeline import Segment, Timeline, play_clip

# A part may take this long to find its way back to the graph above; without such a way it is blended onto that, and the
# blend may begin so late.
LONGEST_RETURN_S = 2.0


@dataclass(slots=True)
class Performer:
    """A character that plays motions of a library from the first frame of `start` on."""

    library: Library
    start: str
    _ensemble: Ensemble = field(init=False)
    _longest_steps: LongestSteps = field(init=False)

    def __post_init__(self) -> None:
        """Put the whole body into the start motion."""
        self._ensemble = Ensemble(self.library)
        self._longest_steps = LongestSteps(self.library)
        root = self.library.root
        home = root.index[self.start]
        self._ensemble.running[root.name] = Track(root, home, Position(home, 0), 0)

    @property
    def now(self) -> int:
        """Return the output frame at which the next thing asked for begins."""
        return self._ensemble.now

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
        self._end([graph for graph in self._ensemble.below(named) if graph not in named])
        afresh = layers[0][0] if from_start else None
        for level in self._ensemble.levels(named):
            changing = [
                graph
                for graph in level
                if self.motion(graph) not in named[graph] or (graph == afresh and not self._begins(graph))
            ]
            self._change({graph: named[graph] for graph in changing}, afresh)

    def hold(self, n_frames: int) -> None:
        """Let `n_frames` output frames pass in what is playing."""
        self._ensemble.hold_until(self.now + n_frames)

    def end(self, graph: str) -> None:
        """Give a body part, and those below it, back to the graph above."""
        self._end([graph])

    def play_pass(self, graph: str) -> None:
        """Let the motion that drives `graph` play to the last frame from which a transition leaves it."""
        track = self._at_home(graph)
        exits = track.graph.first_exit[track.position.motion]
        self._play_clip(track, exits[-1] - track.position.frame if exits else 0)

    def play_out(self, graph: str) -> None:
        """Let the motion that drives `graph` play to its clip's last frame, everything else going on meanwhile."""
        track = self._at_home(graph)
        self._play_clip(track, int(track.graph.n_frames[track.position.motion]) - track.position.frame)

    def motion(self, graph: str) -> str:
        """Return the motion that drives `graph` now: its own if it runs, else that of the graph above."""
        return self._ensemble.motion(graph)

    def whereabouts(self) -> dict[str, tuple[str, int]]:
        """Return, by graph that runs, the motion and frame that it shows next; in a blend, where that leads."""
        return {name: track.shown(self.now) for name, track in self._ensemble.running.items()}

    def copy(self) -> Performer:
        """Return the same character where it is now, to go on by itself."""
        other = copy(self)
        other._ensemble = self._ensemble.copy()
        return other

    def runs(self, graph: str) -> bool:
        """Return whether `graph` plays a motion of its own."""
        return graph in self._ensemble.running

    def timeline(self) -> Timeline:
        """Return all that has been played up to `now`."""
        return self._ensemble.timeline()

    # Changing what plays

    def _change(self, changing: Mapping[str, Sequence[str]], afresh: str | None) -> None:
        """Lead graphs of one level into one of their candidates each, at the same time, after what runs below them.

        The graph `afresh` enters its motion where that begins.
        """
        ensemble = self._ensemble
        self._end(ensemble.below(changing))
        aims = {
            graph: candidates if graph == afresh else aim(ensemble, graph, candidates)
            for graph, candidates in changing.items()
        }
        returning = [g for g in changing if g != afresh and ensemble.motion_above(g) in aims[g]]
        if returning:
            self._end(returning)
            # Time has passed: the others are asked anew.
            self._change({graph: changing[graph] for graph in changing if graph not in returning}, afresh)
            return
        self._end_detours(changing)
        self._set_out(Departing(ensemble, aims, afresh).departures())

    def _set_out(self, departures: Mapping[str, Departure]) -> None:
        """Let graphs set out, and time pass until all have arrived."""
        running = self._ensemble.running
        for graph, departure in departures.items():
            if graph not in running:
                own = self.library.by_name[graph]
                running[graph] = Track(own, departure.position.motion, departure.position, departure.time)
            running[graph].play(departure.segments)
            running[graph].home = departure.home
        self._ensemble.hold_until(max((departure.arrives for departure in departures.values()), default=self.now))

    def _begins(self, graph: str) -> bool:
        """Return whether a graph has just begun its motion: it could be entered no earlier."""
        track = self._ensemble.running.get(graph)
        if track is None or track.position.motion != track.home:
            return False
        return track.position.frame <= track.graph.window

    def _end_detours(self, joining: Collection[str]) -> None:
        """Let the graphs that parts are about to leave come back from a way round that the parts could not mind."""
        for parent in map(self.library.parent, joining):
            if parent is not None:
                track = self._ensemble.driver(parent)
                if self._ensemble.path_home(track, joining) is None:
                    self._ensemble.lead_home(track)

    def _at_home(self, graph: str) -> Track:
        """Return what drives a graph, brought back from a way round."""
        track = self._ensemble.driver(graph)
        self._ensemble.lead_home(track)
        return track

    def _play_clip(self, track: Track, n_frames: int) -> None:
        track.play(play_clip(track.time, track.position, n_frames))
        self._ensemble.hold_until(track.time)

    # Ending parts (rule 2)

    def _end(self, graphs: Collection[str]) -> None:
        """Lead running parts, and those below them, back to the graphs above them.

        The lowest come first, parts of one level at the same time.
        """
        ensemble = self._ensemble
        below = ensemble.below(graphs)
        levels = ensemble.levels([graph for graph in ensemble.running if graph in graphs or graph in below])
        for ending in reversed(levels):
            now = self.now
            ways = [self._way_back(ensemble.running[graph]) for graph in ending]
            for graph, way in zip(ending, ways, strict=True):
                ensemble.running[graph].play(way)
                now = max(now, ensemble.running[graph].time)
            # What was looked ahead at holds only as long as the graphs above mind the parts that come back.
            ensemble.hold_until(now, but=ending)
            for graph in ending:
                ensemble.give_back(graph)

    def _way_back(self, track: Track) -> tuple[Segment, ...]:
        deadline = self.now + round(LONGEST_RETURN_S * self.library.frame_rate)
        driver = self._ensemble.driver(self.library.ancestors(track.graph.name)[0])
        above = list(self._ensemble.clips_above(track.graph, driver, deadline=deadline))
        way = find_return(track.graph, track.position, track.time, above, deadline)
        if way is not None:
            return way
        own, ahead = self._ensemble.stay(track), self._ensemble.coming(driver)
        return release(self._longest_steps, track.graph, own, driver.graph, ahead, deadline)
