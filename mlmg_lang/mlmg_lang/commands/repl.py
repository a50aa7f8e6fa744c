"""A conversation with a character: each command is played on from where it is, and answered at once.

examples:
  mlmg repl my.mlmg
  mlmg repl                                             with the library of mlmg.toml, else the demo library
  mlmg repl -c "WALK for 3 sec" -c ".save! a.bvh"       these lines, then leave
  mlmg repl --json < lines.txt                          for programs: a line of JSON for each reply

`.help` in it tells of all commands with a dot. Without a terminal, plain lines are read and written.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, UsageError, add_use_option
from mlmg_lang.commands.demo import library_or_demo, named_library

if TYPE_CHECKING:
    from mlmg_lang.repl.conversation import Conversation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("library", metavar="L.mlmg", nargs="?", help="the library to play on")
    parser.add_argument("--library", metavar="L.mlmg", dest="named", help="the same, as other commands have it")
    parser.add_argument(
        "-c", "--command", metavar="LINE", action="append", default=[], help="say this line; may be given again"
    )
    parser.add_argument("--start", metavar="MOTION", help="the motion of the whole body to start in")
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="for what is drawn by chance (0)")
    parser.add_argument("--json", action="store_true", help="answer each line with one line of JSON")
    add_use_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Converse."""
    conversation = _conversation(arguments)
    if not arguments.command and not arguments.json and sys.stdin.isatty() and sys.stdout.isatty():
        from mlmg_lang.repl.terminal.terminal import TerminalFace

        TerminalFace(conversation).run()
        return DONE
    from mlmg_lang.repl.plain import PlainFace

    face = PlainFace(conversation, sys.stdout, arguments.json)
    return DONE if face.run(arguments.command or sys.stdin) else WRONG_CONTENT


def _conversation(arguments: argparse.Namespace) -> Conversation:
    from mlmg_lang.rendering import wants_colour
    from mlmg_lang.repl.conversation import Conversation
    from mlmg_lang.repl.desk import Desk
    from mlmg_lang.script_files import used_files
    from mlmg_lang.session.session import Session

    library = library_or_demo(named_library("-", arguments.library or arguments.named), "mlmg repl")
    try:
        session = Session(library, arguments.start, arguments.seed, used_files("-", arguments.allow_use))
    except ValueError as error:
        raise UsageError(str(error)) from None
    allowed = tuple(map(Path, arguments.allow_use))
    return Conversation(Desk(session, _show, wants_colour(sys.stdout), allowed=allowed))


def _show(motion: Path, report: Path) -> str:
    """Open the player for a motion, in the browser where there is one, and return where it is."""
    from contextlib import redirect_stdout
    from io import StringIO

    from mlmg_lang.commands import view

    parser = argparse.ArgumentParser()
    view.add_arguments(parser)
    with redirect_stdout(StringIO()) as page:
        view.run(parser.parse_args([str(motion), "--report", str(report)]))
    return page.getvalue().strip()
