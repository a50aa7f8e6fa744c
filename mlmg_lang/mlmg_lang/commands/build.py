"""Builds a library from clips and a TOML configuration: motion graphs of all body parts, in one file.

example:
  mlmg build library.toml -o my.mlmg
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import DONE, ProgressLine, UsageError, refuse_overwriting, refuse_unwritable, tell
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.spelling import counted

if TYPE_CHECKING:
    from mlmg_runtime.built_library import GraphReport
    from mlmg_runtime.motion_graph import MotionGraph

_MOST_NAMES = 6


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("configuration", metavar="LIBRARY.toml", type=Path, help="the library's configuration")
    parser.add_argument(
        "-o",
        "--output",
        metavar="L.mlmg",
        type=Path,
        help="the library to write; without it, beside the configuration",
    )
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=_jobs,
        default=os.cpu_count() or 1,
        help="motions compared at once; all processors",
    )


def run(arguments: argparse.Namespace) -> int:
    """Build a library, and say what came of it."""
    from concurrent.futures import ThreadPoolExecutor

    from mlmg_runtime.building.build import build_library
    from mlmg_runtime.building.reading.read_configuration import read_configuration
    from mlmg_runtime.database import write_database

    _refuse_what_is_no_configuration(arguments.configuration)
    configuration = read_configuration(arguments.configuration)
    output = arguments.output or arguments.configuration.with_suffix(".mlmg")
    refuse_overwriting([output], [arguments.configuration, *(clip.path for clip in configuration.clips)])
    refuse_unwritable([output])
    progress = ProgressLine()
    try:
        with nullcontext() if arguments.jobs == 1 else ThreadPoolExecutor(arguments.jobs) as executor:
            built = build_library(configuration, executor, progress)
        write_database(built, output)
    finally:
        progress.clear()
    if configuration.left_out:
        n_left_out = len(configuration.left_out)
        tell(f"mlmg build: note: {_clips(n_left_out)} on no graph and left out: {_some(configuration.left_out)}")
    for warning in built.warnings:
        tell(f"mlmg build: warning: {warning}")
    for graph, report in zip(built.graphs, built.reports, strict=True):
        for line in _told_of(graph, report):
            tell(f"mlmg build: {line}")
    n_frames = sum(poses.n_frames for poses in built.poses.values())
    n_transitions = sum(report.n_transitions for report in built.reports)
    tell(
        f"{output}: {counted(len(built.poses), 'clip')}, {counted(n_frames, 'frame')}, "
        f"{counted(len(built.graphs), 'graph')}, {counted(n_transitions, 'transition')}; "
        f"`mlmg info {output}` tells more"
    )
    return DONE


def _refuse_what_is_no_configuration(path: Path) -> None:
    """Raise `UsageError` for what people name instead: the folder of the clips, or one of them."""
    if path.is_dir():
        inside = sorted(path.glob("*.toml"))
        meant = f"did you mean {inside[0]}?" if inside else "write one, as docs/library.md shows, and name it"
        raise UsageError(f"{path} is a folder; expected a library's configuration (TOML): {meant}")
    if path.suffix.lower() == ".bvh":
        raise UsageError(f"{path} is a clip; expected a library's configuration (TOML), which names the clips")


def _told_of(graph: MotionGraph, report: GraphReport) -> Iterator[str]:
    """Yield what a person should know of a graph: what cannot be reached or held, and what will not look smooth."""
    from mlmg_runtime.playing.holding import hardly_held

    if not report.n_transitions and len(graph.motions) > 1:
        yield (
            f"warning: {graph.name}: no motion can follow another, nor itself: there is no transition. "
            "A greater `threshold`, a smaller `window` or longer clips may help"
        )
    elif report.lost_motions:
        yield (
            f"warning: {graph.name}: no transition leads to {_some(report.lost_motions)} and on from there: "
            "a script can start there, but never come there"
        )
    held = hardly_held(graph)
    if held:
        shares = [f"{script_name(motion)} ({share:.0%})" for motion, share in held.items()]
        yield (
            f"warning: {graph.name}: held for long, {_some(shares)} would be shown for less than half of the time: "
            "nothing leads from late in them to early in them, and a way round over other motions takes longer. "
            "Clips that end as they begin, a greater `threshold`, or clips that lie between would help"
        )
    if report.bridges:
        widest = max(distance for _, _, distance in report.bridges)
        yield (
            f"note: {graph.name}: {len(report.bridges)} of {report.n_transitions} transitions are bridges, "
            f"up to {widest:.3g} apart where {report.threshold:.3g} is smooth: feet may slide there; "
            "clips that lie between would help"
        )


def _clips(number: int) -> str:
    return "1 clip is" if number == 1 else f"{number} clips are"


def _some(names: Sequence[str]) -> str:
    """Return names, but only the first of many."""
    most = _MOST_NAMES if len(names) > _MOST_NAMES + 1 else len(names)
    more = [f"{len(names) - most} more"] if most < len(names) else []
    return ", ".join([*names[:most], *more])


def _jobs(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"expected a number from 1 on, found {text!r}")
    return int(text)
