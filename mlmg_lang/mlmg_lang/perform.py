"""From a resolved plan to motion: each statement is performed, and the timeline becomes frames and a report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mlmg_lang.planning.resolved import Command, End, ResolvedPlan, Statement, Wait
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import bvh_from_poses, resample, same_rate
from mlmg_runtime.errors import FileError, PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.report import joints_from_timeline, output_frame, tracks_from_timeline
from mlmg_runtime.playing.synthesis import synthesize


class ScriptError(FileError):
    """A script that compiles, but that the library does not allow to be played."""


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """What a script gave: the motion, and the report of how it came about (see docs/report.md)."""

    bvh: Bvh
    report: dict[str, Any]


def perform(
    plan: ResolvedPlan,
    library: Library,
    seed: int = 0,
    frame_rate: float | None = None,
    blend: str | None = None,
) -> Performance:
    """Play a plan on the library that it was resolved against.

    Parameters
    ----------
    seed : stated in the report; the same plan, library and seed always give the same frames.
    frame_rate : of the motion, frames a second; None for the library's.
    blend : "c1" or "linear", for all transitions; None for what each graph was configured with.

    Raises
    ------
    ScriptError
        With the line of the statement that cannot be played.
    """
    performer = Performer(library, plan.start)
    commands = []
    for number, statement in enumerate(plan.statements, start=1):
        begin = performer.now
        is_last = number == len(plan.statements)
        try:
            arrive = _execute(performer, statement, is_last)
        except PlayError as error:
            line, _ = plan.source.position(statement.span.start)
            raise ScriptError(plan.source.name, line, str(error)) from None
        if isinstance(statement, Command):
            motions = {layer.graph: performer.motion(layer.graph) for layer in statement.layers}
            commands.append((statement, begin, arrive, performer.now, motions))
    if performer.now == 0:
        performer.hold(1)
    timeline = performer.timeline()
    poses = synthesize(library, timeline, blend)
    rate = frame_rate or library.frame_rate
    poses = resample(poses, library.frame_rate, rate)
    ratio = 1.0 if same_rate(library.frame_rate, rate) else rate / library.frame_rate
    report = {
        "library": Path(library.path).name,
        "frame_rate": rate,
        "n_frames": poses.n_frames,
        "seed": seed,
        "up": library.up,
        "commands": [_command_entry(plan, *entry, ratio=ratio, n_frames=poses.n_frames) for entry in commands],
        "tracks": tracks_from_timeline(library, timeline, ratio, poses.n_frames),
        "joints": joints_from_timeline(library, timeline),
    }
    return Performance(bvh_from_poses(library.skeleton, poses, 1.0 / rate, library.up), report)


def _execute(performer: Performer, statement: Statement, is_last: bool) -> int:
    """Perform one statement; return the frame at which all of its parts have arrived."""
    rate = performer.library.frame_rate
    match statement:
        case Command(layers=layers, duration_s=duration_s):
            performer.bring([(layer.graph, layer.candidates) for layer in layers])
            arrive = performer.now
            if duration_s is not None:
                performer.hold(round(duration_s * rate))
            elif is_last:
                performer.play_out(layers[0].graph)
            return arrive
        case Wait(duration_s=duration_s):
            performer.hold(round(duration_s * rate))
        case End(graph=graph):
            performer.end(graph)
    return performer.now


def _command_entry(
    plan: ResolvedPlan,
    command: Command,
    begin: int,
    arrive: int,
    end: int,
    motions: dict[str, str],
    *,
    ratio: float,
    n_frames: int,
) -> dict[str, Any]:
    begin, arrive, end = (output_frame(frame, ratio, n_frames) for frame in (begin, arrive, end))
    text = " ".join(plan.source.slice(command.span).split())
    location = list(plan.source.location(command.span))
    return {"text": text, "span": location, "begin": begin, "arrive": arrive, "end": end, "motions": motions}
