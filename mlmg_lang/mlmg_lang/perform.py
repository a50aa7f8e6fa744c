"""From a resolved plan to motion: each statement is performed, and the timeline becomes frames and a report."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mlmg_lang.execution import Step, executed
from mlmg_lang.planning.resolved import Command, Cycles, End, Once, ResolvedPlan, Seconds, Wait
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import bvh_from_poses, resample, same_rate
from mlmg_runtime.errors import FileError, PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.report import joints_from_timeline, output_frame, tracks_from_timeline
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Timeline


class ScriptError(FileError):
    """A script that compiles, but that the library does not allow to be played."""


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """What a script gave: the motion, and the report of how it came about (see docs/report.md)."""

    bvh: Bvh
    report: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Executed:
    """A statement as it was executed, in frames of the library's rate.

    Attributes
    ----------
    arrive : when all parts had arrived; where nothing moves, `begin`.
    motions : by graph that a command names, what drove it on arrival.
    """

    statement: Step
    begin: int
    arrive: int
    end: int
    motions: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Rehearsal:
    """What is played when, before any pose is made."""

    steps: tuple[Executed, ...]
    timeline: Timeline


def perform(
    plan: ResolvedPlan,
    library: Library,
    seed: int = 0,
    frame_rate: float | None = None,
    blend: str | None = None,
    feet: bool = True,
) -> Performance:
    """Play a plan on the library that it was resolved against.

    Parameters
    ----------
    seed : of what `choose` draws; the same plan, library and seed always give the same frames.
    frame_rate : of the motion, frames a second; None for the library's.
    blend : "c1" or "linear", for all transitions; None for what each graph was configured with.
    feet : whether planted feet are kept from sliding in transitions.

    Raises
    ------
    ScriptError
        With the line of the statement that cannot be played.
    """
    rehearsal = rehearse(plan, library, seed)
    timeline = rehearsal.timeline
    poses = synthesize(library, timeline, blend, feet)
    rate = frame_rate or library.frame_rate
    poses = resample(poses, library.frame_rate, rate)
    ratio = 1.0 if same_rate(library.frame_rate, rate) else rate / library.frame_rate
    report = {
        "library": Path(library.path).name,
        "frame_rate": rate,
        "n_frames": poses.n_frames,
        "seed": seed,
        "plan": "global" if plan.ahead else "greedy",
        "up": library.up,
        "commands": [
            _command_entry(plan, step, ratio, poses.n_frames)
            for step in rehearsal.steps
            if isinstance(step.statement, Command)
        ],
        "tracks": tracks_from_timeline(library, timeline, ratio, poses.n_frames),
        "joints": joints_from_timeline(library, timeline),
    }
    return Performance(bvh_from_poses(library.skeleton, poses, 1.0 / rate, library.up), report)


def rehearse(plan: ResolvedPlan, library: Library, seed: int = 0) -> Rehearsal:
    """Decide what a plan plays when, as `perform` does; clips are read only where that depends on them.

    Raises
    ------
    ScriptError
        With the line of the statement that cannot be played.
    """
    performer = Performer(library, plan.start)
    steps = []
    counted = library.root.name
    for statement, is_last in _with_last(executed(plan, seed)):
        begin = performer.now
        try:
            arrive = _execute(performer, statement, counted, is_last)
        except PlayError as error:
            line, _ = plan.source.position(statement.span.start)
            raise ScriptError(plan.source.name, line, str(error)) from None
        motions: dict[str, str] = {}
        if isinstance(statement, Command):
            counted = statement.layers[0].graph
            motions = {layer.graph: performer.motion(layer.graph) for layer in statement.layers}
        steps.append(Executed(statement, begin, arrive, performer.now, motions))
    if performer.now == 0:
        performer.hold(1)
    return Rehearsal(tuple(steps), performer.timeline())


def _with_last(steps: Iterable[Step]) -> Iterator[tuple[Step, bool]]:
    """Yield each of some steps, and whether it is the last."""
    before: Step | None = None
    for step in steps:
        if before is not None:
            yield before, False
        before = step
    if before is not None:
        yield before, True


def _execute(performer: Performer, statement: Step, counted: str, is_last: bool) -> int:
    """Perform one statement; return the frame at which all of its parts have arrived.

    Parameters
    ----------
    counted : the graph whose cycles a `wait` counts.
    """
    match statement:
        case Command(layers=layers, duration=duration):
            wanted = [(layer.graph, layer.candidates) for layer in layers]
            if isinstance(duration, Once):
                performer.bring(wanted, from_start=True)
            else:
                performer.bring(wanted)
            arrive = performer.now
            if isinstance(duration, Once):
                performer.play_pass(layers[0].graph)
            elif duration is not None:
                performer.hold(_n_frames(performer, duration, layers[0].graph))
            elif is_last:
                performer.play_out(layers[0].graph)
            return arrive
        case Wait(duration=duration):
            begin = performer.now
            performer.hold(_n_frames(performer, duration, counted))
            return begin
        case End(graph=graph):
            performer.end(graph)
    return performer.now


def _n_frames(performer: Performer, duration: Seconds | Cycles, counted: str) -> int:
    """Return how many frames of the library a duration takes; a cycle is as long as the clip of a graph's motion."""
    if isinstance(duration, Seconds):
        return round(duration.number * performer.library.frame_rate)
    return round(duration.number * performer.library.n_frames(performer.motion(counted)))


def _command_entry(plan: ResolvedPlan, step: Executed, ratio: float, n_frames: int) -> dict[str, Any]:
    begin, arrive, end = (output_frame(frame, ratio, n_frames) for frame in (step.begin, step.arrive, step.end))
    span = step.statement.span
    text = " ".join(plan.source.slice(span).split())
    location = list(plan.source.location(span))
    return {"text": text, "span": location, "begin": begin, "arrive": arrive, "end": end, "motions": dict(step.motions)}
