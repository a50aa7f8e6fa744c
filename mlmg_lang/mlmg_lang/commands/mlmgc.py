"""The command `mlmgc`: compiles a script, plays it, and writes the motion."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mlmg_lang.commands.console import (
    DONE,
    WRONG_CONTENT,
    WRONG_USAGE,
    UsageError,
    add_use_option,
    frame_rate,
    one_thread_a_product,
    refuse_overwriting,
    refuse_unwritable,
    run_command,
    tell,
    utf8_streams,
)
from mlmg_lang.commands.watching import Inputs, NotedFiles

if TYPE_CHECKING:
    from mlmg_lang.commands.watching import Stamp
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.perform import Performance
    from mlmg_lang.planning.resolved import ResolvedPlan
    from mlmg_lang.source import Source
    from mlmg_runtime.library import Library

_DESCRIPTION = """\
Compiles a script of Motion Script, plays it on a library of motions, and writes the motion as BVH.

examples:
  mlmgc stroll.ms --library my.mlmg -o stroll.bvh
  mlmgc stroll.ms -o stroll.bvh --report stroll.json    what plays when, and why
  mlmgc stroll.ms -o stroll.bvh --plan global           choose motions over the whole script, for less on the way
  mlmgc stroll.ms -o stroll.bvh --watch                 again at every save
  echo "WALK for 10 sec" | mlmgc - -o - > walk.bvh      standard input and output

Without --library, MLMG_LIBRARY or a key `library` in mlmg.toml, the demo library is played.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `mlmgc` and return its exit code."""
    utf8_streams()
    one_thread_a_product()
    parsed = argument_parser().parse_args(arguments)
    return run_command("mlmgc", lambda: _run(parsed))


def argument_parser() -> argparse.ArgumentParser:
    """Return what reads the command's arguments."""
    from mlmg_lang.commands.version import VersionAction

    parser = argparse.ArgumentParser(
        prog="mlmgc", description=_DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("script", metavar="SCRIPT.ms", help="the script; - reads standard input")
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT.bvh",
        required=True,
        help="the motion to write; - writes standard output",
    )
    parser.add_argument("--library", metavar="L.mlmg", help="the library to play on; demo is the demo library")
    parser.add_argument("--start", metavar="MOTION", help="the motion of the whole body to start in")
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="for what is drawn by chance (0)")
    parser.add_argument(
        "--plan",
        choices=("greedy", "global"),
        default="greedy",
        help="how motions are chosen: command by command (greedy, which is the default), or over the whole script",
    )
    parser.add_argument("--report", metavar="R.json", help="write what plays when; - writes standard output")
    parser.add_argument("--fps", metavar="N", type=frame_rate, help="frames a second of the motion; the library's")
    parser.add_argument(
        "--blend", choices=("c1", "linear"), help="how transitions are weighted; as the library is configured"
    )
    parser.add_argument(
        "--no-feet", dest="feet", action="store_false", help="let planted feet slide where motions are blended"
    )
    add_use_option(parser)
    parser.add_argument("--watch", action="store_true", help="play again at every save, until Ctrl-C")
    parser.add_argument("--version", action=VersionAction, nargs=0, help="show the version and leave")
    return parser


def _run(arguments: argparse.Namespace) -> int:
    if arguments.output == "-" and arguments.report == "-":
        raise UsageError("the motion and the report cannot both go to standard output")
    if arguments.watch:
        return _watch(arguments)
    return _play(arguments, Inputs(), Libraries(), tell)


def _refuse_other_formats(output: str) -> None:
    """Raise `UsageError` for a name that promises anything but BVH; a name without an ending promises nothing."""
    ending = Path(output).suffix
    if ending.lower() not in ("", ".bvh"):
        raise UsageError(f"{output}: a motion is written as BVH; expected a name that ends in .bvh, found {ending}")


def _watch(arguments: argparse.Namespace) -> int:
    """Play a script, and again whenever a file that it is made from changes; return if that cannot even begin."""
    _refuse_watching(arguments)
    libraries = Libraries()
    tell(f"mlmgc: watching {arguments.script}; Ctrl-C leaves")
    has_begun = False
    while True:
        inputs = Inputs()
        code = run_command("mlmgc", partial(_play, arguments, inputs, libraries, _tell_when))
        if code not in (DONE, WRONG_CONTENT, WRONG_USAGE) or (code == WRONG_USAGE and not has_begun):
            return code
        if code != DONE:
            _tell_when(f"{arguments.script}: not played; {arguments.output} stays as it was")
        has_begun = True
        inputs.wait_for_change()


def _refuse_watching(arguments: argparse.Namespace) -> None:
    """Raise `UsageError` for what cannot be read or written again and again."""
    script = Path(arguments.script)
    if arguments.script == "-" or (script.exists() and not script.is_file()):
        raise UsageError(f"--watch needs a file to be saved; the script is {arguments.script}")
    for option, output in (("-o", arguments.output), ("--report", arguments.report)):
        if output == "-":
            raise UsageError(f"--watch writes again and again, which {option} - cannot show; name a file")


def _tell_when(message: str) -> None:
    tell(f"{time.strftime('%H:%M:%S')} {message}")


def _play(arguments: argparse.Namespace, inputs: Inputs, libraries: Libraries, sum_up: Callable[[str], None]) -> int:
    """Compile and play a script, and say how much motion that is; return 1 if it has errors.

    Parameters
    ----------
    inputs : where the files are noted that this depends on.
    """
    from mlmg_lang.commands.demo import named_library
    from mlmg_lang.front_end import analyse
    from mlmg_lang.script_files import read_script, used_files

    inputs.note(arguments.script)
    inputs.note_settings(arguments.script)
    library_path = named_library(arguments.script, arguments.library)
    outputs = [arguments.output, arguments.report]
    refuse_overwriting(outputs, [arguments.script, library_path])
    _refuse_other_formats(arguments.output)
    refuse_unwritable(outputs)
    source, unreadable = read_script(arguments.script)
    if unreadable:
        _show(source, unreadable)
        return WRONG_CONTENT
    library = libraries.open(library_path, inputs)
    files = NotedFiles(used_files(arguments.script, arguments.allow_use), inputs)
    analysis = analyse(source, library, arguments.start, files)
    _show(analysis.source, analysis.diagnostics)
    refuse_overwriting(outputs, [file.name for file in analysis.source.used])
    if analysis.resolved is None:
        return WRONG_CONTENT
    if not analysis.resolved.statements:
        tell(f"mlmgc: error: {source.name}: there is nothing to play; expected a command such as `WALK for 10 sec`")
        return WRONG_CONTENT
    from mlmg_lang.perform import perform

    plan = _ahead(analysis.resolved, library, arguments.seed) if arguments.plan == "global" else analysis.resolved
    performance = perform(plan, library, arguments.seed, arguments.fps, arguments.blend, arguments.feet)
    _write(performance, arguments.output, arguments.report)
    if arguments.output != "-":
        sum_up(f"{arguments.output}: {performance.summary}")
    return DONE


def _ahead(plan: ResolvedPlan, library: Library, seed: int) -> ResolvedPlan:
    """Return a plan whose motions are chosen over the whole script, or the plan itself, and say why."""
    from mlmg_lang.looking_ahead import look_ahead

    ahead = look_ahead(plan, library, seed)
    if not ahead.planned:
        tell(f"mlmgc: note: motions are chosen command by command: {ahead.because}")
    return ahead.plan


@dataclass(slots=True)
class Libraries:
    """The library that was opened last, which is opened again only if its file has changed."""

    _opened: tuple[Path | None, Stamp | None, Library] | None = None

    def open(self, path: Path | None, inputs: Inputs) -> Library:
        """Return a library, and note its file; where none is named, the demo library."""
        from mlmg_lang.commands.demo import library_or_demo

        state = None if path is None else inputs.note(path)
        if self._opened is None or self._opened[:2] != (path, state):
            self._opened = (path, state, library_or_demo(path, "mlmgc"))
        return self._opened[2]


def _show(source: Source, diagnostics: tuple[Diagnostic, ...]) -> None:
    from mlmg_lang.rendering import render_full, wants_colour

    if diagnostics:
        sys.stderr.write(render_full(diagnostics, source, wants_colour(sys.stderr)))


def _write(performance: Performance, output: str, report: str | None) -> None:
    from mlmg_runtime import bvh

    if output == "-":
        bvh.write_to(performance.bvh, sys.stdout)
    else:
        bvh.write(performance.bvh, output)
    if report is not None:
        _write_report(performance.report, report)


def _write_report(report: dict[str, Any], path: str) -> None:
    from mlmg_lang.perform import report_text, write_report

    if path == "-":
        sys.stdout.write(report_text(report))
    else:
        write_report(report, path)


if __name__ == "__main__":
    sys.exit(main())
