"""From a resolved plan to motion: each statement is performed, and the timeline becomes frames and a report."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, TypeAlias

from mlmg_lang.execution import expected_steps
from mlmg_lang.planning.resolved import Command, ResolvedPlan
from mlmg_lang.staging import Executed, begin
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import bvh_from_poses, resample, same_rate
from mlmg_runtime.files import atomic_output
from mlmg_runtime.library import Library
from mlmg_runtime.playing.report import joints_from_timeline, output_frame, tracks_from_timeline
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Timeline

Progress: TypeAlias = Callable[[str, int, int], object]


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """What a script gave: the motion, and the report of how it came about (see docs/report.md)."""

    bvh: Bvh
    report: dict[str, Any]

    @property
    def summary(self) -> str:
        """Return how long the motion is, and how much of it leads from one command to the next."""
        n_frames, rate = self.report["n_frames"], self.report["frame_rate"]
        under_way = sum(command["arrive"] - command["begin"] for command in self.report["commands"])
        return (
            f"{n_frames} frames, {n_frames / rate:.1f} s, {under_way / rate:.1f} s of them on the way between motions"
        )


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
    progress: Progress = lambda *_: None,
) -> Performance:
    """Play a plan on the library that it was resolved against.

    Parameters
    ----------
    seed : of what `choose` draws; the same plan, library and seed always give the same frames.
    frame_rate : of the motion, frames a second; None for the library's.
    blend : "c1" or "linear", for all transitions; None for what each graph was configured with.
    feet : whether planted feet are kept from sliding in transitions.
    progress : called with what is being done, how much of it is done, and of how much.

    Raises
    ------
    ScriptError
        With the line of the statement that cannot be played.
    """
    rehearsal = rehearse(plan, library, seed, progress)
    timeline = rehearsal.timeline
    progress("poses", 0, 1)
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


def report_text(report: dict[str, Any]) -> str:
    """Return a report as it is written."""
    return json.dumps(report, ensure_ascii=False, indent=1) + "\n"


def write_report(report: dict[str, Any], path: str | Path) -> None:
    """Write a report, all or nothing.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    with atomic_output(path) as temporary:
        temporary.write_text(report_text(report), encoding="utf-8")


def rehearse(plan: ResolvedPlan, library: Library, seed: int = 0, progress: Progress = lambda *_: None) -> Rehearsal:
    """Decide what a plan plays when, as `perform` does; clips are read only where that depends on them.

    Raises
    ------
    ScriptError
        With the line of the statement that cannot be played.
    """
    stage = begin(library, plan.start, seed)
    n_done, n_steps = count(1), math.ceil(expected_steps(plan.statements))
    steps = stage.play(plan, lambda: progress("statements", min(next(n_done), n_steps), n_steps))
    timeline = stage.finish()
    last = () if stage.last is None else (stage.last,)
    return Rehearsal((*steps[:-1], *last), timeline)


def _command_entry(plan: ResolvedPlan, step: Executed, ratio: float, n_frames: int) -> dict[str, Any]:
    begin, arrive, end = (output_frame(frame, ratio, n_frames) for frame in (step.begin, step.arrive, step.end))
    span = step.statement.span
    text = " ".join(plan.source.slice(span).split())
    location = list(plan.source.location(span))
    return {"text": text, "span": location, "begin": begin, "arrive": arrive, "end": end, "motions": dict(step.motions)}
