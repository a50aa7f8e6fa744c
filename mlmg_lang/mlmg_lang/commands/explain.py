"""Tell what a script will do and why, without playing it.

For each statement: what may be playing before it, how its words were understood, on each body part the
motions in question in the order in which they are tried, why others were left out, what is ended, and how
many seconds all this is expected to take. With --analyze the script is played too, and what happened
stands beside what was expected.

examples:
  mlmg explain stroll.ms
  mlmg explain stroll.ms --library my.mlmg --analyze
  mlmg explain stroll.ms --plan global                 choose over the whole script, and tell what that gains
  mlmg explain stroll.ms --format json -o plan.json    for other programs
  mlmg explain stroll.ms --format mermaid              a flowchart, for a page or a wiki

Without --library, MLMG_LIBRARY or a key `library` in mlmg.toml, the demo library is taken.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import (
    DONE,
    WRONG_CONTENT,
    add_use_option,
    refuse_overwriting,
    refuse_unwritable,
    tell,
)

if TYPE_CHECKING:
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.explaining.explanation import Explanation
    from mlmg_lang.source import Source

FORMATS = ("text", "json", "mermaid")
_NARROWEST = 60


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    parser.add_argument("script", metavar="SCRIPT.ms", help="the script; - reads standard input")
    parser.add_argument("--library", metavar="L.mlmg", help="the library that it is for; demo is the demo library")
    parser.add_argument("--start", metavar="MOTION", help="the motion of the whole body to start in")
    parser.add_argument(
        "--analyze", action="store_true", help="play it too, and set what happened beside the estimates"
    )
    parser.add_argument(
        "--seed", metavar="N", type=int, default=0, help="for what is drawn by chance, as it is played (0)"
    )
    parser.add_argument(
        "--plan",
        choices=("greedy", "global"),
        default="greedy",
        help="how motions are chosen: command by command (greedy), or over the whole script; as for mlmgc",
    )
    parser.add_argument("--format", choices=FORMATS, default="text", help="how it is told")
    parser.add_argument("-o", "--output", metavar="FILE", default="-", help="the file to write; - for standard output")
    add_use_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Explain a script; return 1 if it has errors."""
    from mlmg_lang.commands.demo import library_or_demo, named_library
    from mlmg_lang.explaining.explain import explanation_from_analysis
    from mlmg_lang.front_end import analyse
    from mlmg_lang.looking_ahead import look_ahead
    from mlmg_lang.script_files import read_script, used_files

    path = named_library(arguments.script, arguments.library)
    refuse_overwriting([arguments.output], [arguments.script, path])
    refuse_unwritable([arguments.output])
    source, unreadable = read_script(arguments.script)
    if unreadable:
        _show(source, unreadable)
        return WRONG_CONTENT
    library = library_or_demo(path, "mlmg explain")
    analysis = analyse(source, library, arguments.start, used_files(arguments.script, arguments.allow_use))
    refuse_overwriting([arguments.output], [file.name for file in analysis.source.used])
    _show(analysis.source, analysis.diagnostics)
    if analysis.resolved is None:
        return WRONG_CONTENT
    if not analysis.resolved.statements:
        tell(f"mlmg explain: error: {source.name}: there is nothing to play; expected a command, as `WALK for 10 sec`")
        return WRONG_CONTENT
    seed = arguments.seed if arguments.analyze else None
    ahead = look_ahead(analysis.resolved, library, arguments.seed) if arguments.plan == "global" else None
    explanation = explanation_from_analysis(analysis, library, arguments.start, ahead, seed)
    _write(explanation, arguments.format, arguments.output)
    return DONE


def _show(source: Source, diagnostics: tuple[Diagnostic, ...]) -> None:
    from mlmg_lang.rendering import render_full, wants_colour

    if diagnostics:
        sys.stderr.write(render_full(diagnostics, source, wants_colour(sys.stderr)))


def _write(explanation: Explanation, form: str, output: str) -> None:
    from mlmg_runtime.files import atomic_output

    if output == "-":
        sys.stdout.write(_told(explanation, form, is_shown=sys.stdout.isatty()))
        return
    text = _told(explanation, form, is_shown=False)
    with atomic_output(output) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _told(explanation: Explanation, form: str, is_shown: bool) -> str:
    """Return an explanation in one of the formats; `is_shown`: on a terminal."""
    if form == "json":
        from mlmg_lang.explaining.plan_json import plan_to_json

        return plan_to_json(explanation)
    if form == "mermaid":
        from mlmg_lang.explaining.mermaid import render_mermaid

        return render_mermaid(explanation)
    from mlmg_lang.explaining.text import WIDTH, render_text
    from mlmg_lang.rendering import wants_colour

    columns = shutil.get_terminal_size().columns if is_shown else WIDTH
    return render_text(explanation, min(max(columns, _NARROWEST), WIDTH), is_shown and wants_colour(sys.stdout))
