"""What was played -> for each statement, how it went: what was taken, when it arrived, by which transitions."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mlmg_lang.explaining.explanation import Event, Execution, Played, Taken
from mlmg_lang.planning.resolved import Command, End, Once
from mlmg_lang.source import Span
from mlmg_lang.staging import Executed
from mlmg_runtime.library import Library
from mlmg_runtime.playing.timeline import Blend, Segment

if TYPE_CHECKING:
    from mlmg_lang.perform import Rehearsal


def executions_of(rehearsal: Rehearsal, library: Library, start: str) -> Mapping[Span, tuple[Execution, ...]]:
    """Return, by the spans of statements, how they went each time that they were executed.

    Parameters
    ----------
    start : the motion that the character started in.
    """
    teller = Teller(library, rehearsal.timeline.tracks, {library.root.name: start})
    found: dict[Span, list[Execution]] = {}
    for step in rehearsal.steps:
        found.setdefault(step.statement.span, []).append(teller.execution(step))
    return {span: tuple(executions) for span, executions in found.items()}


def played_of(rehearsal: Rehearsal, executions: Mapping[Span, tuple[Execution, ...]], rate: float, seed: int) -> Played:
    """Return what came of playing a script, in all."""
    every = [one for executed in executions.values() for one in executed]
    under_way = sum(one.arrived_s for one in every)
    cost = sum(one.cost for one in every)
    return Played(seed, round(rehearsal.timeline.n_frames / rate, 3), round(under_way, 3), round(cost, 3))


@dataclass(slots=True)
class Teller:
    """Goes through what was executed; `homes` are the motions that graphs were last led to, while they run."""

    library: Library
    tracks: Mapping[str, tuple[Segment, ...]]
    homes: dict[str, str]
    _told: dict[str, int] = field(default_factory=dict)

    def execution(self, step: Executed) -> Execution:
        """Return how a statement went."""
        moved = self._moved(step)
        events = sorted(
            (event for graph in self.library.graphs if graph in moved for event in self._events(graph, step)),
            key=lambda event: event.begin_s,
        )
        self._remember(step, moved)
        return Execution(
            self._seconds(step.begin),
            self._seconds(step.arrive - step.begin),
            self._seconds(step.end - step.arrive),
            round(sum(event.cost or 0.0 for event in events), 3),
            tuple(Taken(graph, motion, self._shown(graph, motion, step)) for graph, motion in step.motions.items()),
            tuple(events),
        )

    def _moved(self, step: Executed) -> set[str]:
        """Return the graphs that a statement led elsewhere or ended; others only stayed in their motions meanwhile."""
        match step.statement:
            case Command(layers=layers, duration=duration):
                named = [layer.graph for layer in layers]
                afresh = named[:1] if isinstance(duration, Once) else []
                moved = {graph for graph in named if graph in afresh or self.homes.get(graph) != step.motions[graph]}
                ended = {graph for graph in self.library.graphs if graph not in named and self._is_below(graph, named)}
                below = {graph for graph in named if self._is_below(graph, moved)}
                return moved | ended | below
            case End(graph=graph):
                return {graph, *(one for one in self.library.graphs if self._is_below(one, {graph}))}
        return set()

    def _remember(self, step: Executed, moved: set[str]) -> None:
        for graph in moved:
            self.homes.pop(graph, None)
        self.homes.update(step.motions)

    def _is_below(self, graph: str, others: Collection[str]) -> bool:
        return any(above in others for above in self.library.ancestors(graph))

    def _events(self, graph: str, step: Executed) -> Iterator[Event]:
        """Yield the blends of a graph that began while a statement was under way."""
        segments = self.tracks.get(graph, ())
        # Statements come in the order of time, so that what has been told need not be looked at again.
        at = self._told.get(graph, 0)
        while at < len(segments) and segments[at].begin < step.arrive:
            segment = segments[at]
            at += 1
            if isinstance(segment, Blend) and segment.begin >= step.begin:
                yield self._event(graph, segment)
        self._told[graph] = at

    def _shown(self, graph: str, motion: str, step: Executed) -> float | None:
        """Return the share of the time after a statement's arrival in which a motion is shown on a graph."""
        if step.end == step.arrive:
            return None
        for driver in (graph, *self.library.ancestors(graph)):
            during = self._during(driver, step.arrive, step.end)
            if during:
                home = self.library.by_name[driver].index[motion]
                frames = sum(
                    min(segment.end, step.end) - max(segment.begin, step.arrive)
                    for segment in during
                    if _shows(segment, home)
                )
                return round(frames / (step.end - step.arrive), 3)
        return None

    def _during(self, graph: str, begin: int, end: int) -> Sequence[Segment]:
        """Return what a graph plays by itself in a time; nothing, if it does what the graph above does."""
        segments = self.tracks.get(graph, ())
        first = bisect_right(segments, begin, key=lambda segment: segment.end)
        return segments[first : max(first, bisect_left(segments, end, key=lambda segment: segment.begin))]

    def _event(self, graph: str, blend: Blend) -> Event:
        motions = self.library.by_name[graph].motions
        source = (motions[blend.source.motion], blend.source.frame)
        target = None if blend.target is None else (motions[blend.target.motion], blend.target.frame)
        what = "transition" if blend.transition is not None else "blend" if target is not None else "return"
        cost = None if blend.transition is None else round(blend.transition.cost, 3)
        return Event(graph, what, self._seconds(blend.begin), source, target, cost)

    def _seconds(self, n_frames: int) -> float:
        return round(n_frames / self.library.frame_rate, 3)


def _shows(segment: Segment, motion: int) -> bool:
    """Return whether nothing but one motion is shown in a segment."""
    if isinstance(segment, Blend):
        return segment.source.motion == motion and segment.target is not None and segment.target.motion == motion
    return segment.first.motion == motion
