"""Builds a library from clips and a TOML configuration: motion graphs of all body parts, in one file.

example:
  mlmg build library.toml -o my.mlmg
"""

from __future__ import annotations

import argparse
import os
from contextlib import nullcontext
from pathlib import Path

from mlmg_lang.commands.console import DONE, ProgressLine, refuse_overwriting, refuse_unwritable, tell


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
    from mlmg_runtime.building.configuration import read_configuration
    from mlmg_runtime.database import write_database

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
    for warning in built.warnings:
        tell(f"mlmg build: warning: {warning}")
    for graph, report in zip(built.graphs, built.reports, strict=True):
        for motion in report.lost_motions:
            tell(
                f"mlmg build: warning: {graph.name}: no endless walk passes {motion}; it can be started in, not led to"
            )
        if report.bridges:
            widest = max(distance for _, _, distance in report.bridges)
            tell(
                f"mlmg build: note: {graph.name}: {len(report.bridges)} of {report.n_transitions} transitions are "
                f"bridges, up to {widest:.3g} apart where {report.threshold:.3g} is smooth: feet may slide there"
            )
    n_frames = sum(poses.n_frames for poses in built.poses.values())
    n_transitions = sum(report.n_transitions for report in built.reports)
    tell(
        f"{output}: {len(built.poses)} clips, {n_frames} frames, {len(built.graphs)} graphs, "
        f"{n_transitions} transitions; `mlmg info {output}` tells more"
    )
    return DONE


def _jobs(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"expected a number from 1 on, found {text!r}")
    return int(text)
