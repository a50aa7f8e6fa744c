"""Writes what completes commands, options and files in a shell, for `mlmg` and `mlmgc`.

examples:
  eval "$(mlmg completion bash)"                        in ~/.bashrc
  eval "$(mlmg completion zsh)"                         in ~/.zshrc, after compinit
  mlmg completion fish > ~/.config/fish/conf.d/mlmg.fish
"""

from __future__ import annotations

import argparse
import sys

from mlmg_lang.commands.console import DONE
from mlmg_lang.commands.version import VersionAction

SHELLS = ("bash", "zsh", "fish", "powershell")

_FILES = ("FILE", "OUT", "SCRIPT")
_FOLDERS = ("FOLDER",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("shell", choices=SHELLS, help="the shell that it is for")


def run(arguments: argparse.Namespace) -> int:
    """Write the text that the shell is to run."""
    from shtab import complete

    from mlmg_lang.commands import mlmgc

    parsers = (_mlmg(), mlmgc.argument_parser())
    for parser in parsers:
        _tell_files(parser)
    sys.stdout.writelines(complete(parser, arguments.shell) + "\n" for parser in parsers)
    return DONE


def _mlmg() -> argparse.ArgumentParser:
    """Return one parser of all subcommands; to run one of them, only that one's is made."""
    from mlmg_lang.commands.mlmg import SUBCOMMANDS, module_of

    parser = argparse.ArgumentParser(prog="mlmg")
    parser.add_argument("--version", action=VersionAction, nargs=0, help="show the version and leave")
    commands = parser.add_subparsers()
    for name, text in SUBCOMMANDS.items():
        subparser = commands.add_parser(name, help=text)
        module_of(name).add_arguments(subparser)
        _tell_files(subparser)
    return parser


def _tell_files(parser: argparse.ArgumentParser) -> None:
    """Say which arguments are files: those whose placeholder has an ending, and some more."""
    from shtab import DIRECTORY, FILE

    for action in parser._actions:
        placeholder = str(action.metavar)
        if "." in placeholder or placeholder in _FILES:
            action.complete = FILE  # type: ignore[attr-defined]
        elif placeholder in _FOLDERS:
            action.complete = DIRECTORY  # type: ignore[attr-defined]
