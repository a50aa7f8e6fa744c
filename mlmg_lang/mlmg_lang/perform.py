"""From a resolved plan to motion: each statement is performed, and the timeline becomes frames and a report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mlmg_lang.planning.resolved import Command, ResolvedPlan
from mlmg_lang.staging import Executed, begin
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import bvh_from_poses, resample, same_rate
from mlmg_runtime.library import Library
from mlmg_runtime.playing.report import joints_from_timeline, output_frame, tracks_from_timeline
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Timeline


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """What a script gave: the motion, and the report of how it came about (see docs/report.md)."""

    bvh: Bvh
    report: dict[str, Any]


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
    stage = begin(library, plan.start, seed)
    steps = stage.play(plan)
    timeline = stage.finish()
    last = () if stage.last is None else (stage.last,)
    return Rehearsal((*steps[:-1], *last), timeline)


def _command_entry(plan: ResolvedPlan, step: Executed, ratio: float, n_frames: int) -> dict[str, Any]:
    begin, arrive, end = (output_frame(frame, ratio, n_frames) for frame in (step.begin, step.arrive, step.end))
    span = step.statement.span
    text = " ".join(plan.source.slice(span).split())
    location = list(plan.source.location(span))
    return {"text": text, "span": location, "begin": begin, "arrive": arrive, "end": end, "motions": dict(step.motions)}
