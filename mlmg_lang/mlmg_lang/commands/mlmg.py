"""The command `mlmg`: a name for each thing that can be done with libraries, scripts and motions."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from mlmg_lang.commands.console import (
    DONE,
    WRONG_USAGE,
    one_thread_a_product,
    run_command,
    seldom_collect,
    utf8_streams,
)
from mlmg_lang.commands.version import VersionAction

# Subcommand -> what it does. Its module is imported when it is called.
SUBCOMMANDS = {
    "build": "build a library of motions from clips and a configuration",
    "info": "tell what is in a built library",
    "check": "check scripts without playing them",
    "rule": "tell what a diagnostic means",
    "fmt": "rewrite scripts in the one canonical form",
    "explain": "tell what a script will do and why, as a tree, JSON or a flowchart",
    "view": "look at a motion: a player in the browser, a picture, a GIF",
    "repl": "converse with a character: each command is played on and answered at once",
    "lsp": "serve editors: what the compiler knows, by the language server protocol",
    "completion": "write what completes commands, options and files in a shell",
}

# The language server stands above this package, which does not know it but by name.
_ELSEWHERE = {"lsp": "mlmg_lsp.command"}

_DESCRIPTION = """\
Motion Script commands human motion. A script is played with the command mlmgc; mlmg does the rest.

commands:
{commands}

examples:
  mlmg build library.toml -o my.mlmg
  mlmg info my.mlmg
  mlmg check stroll.ms --library my.mlmg
  mlmgc stroll.ms --library my.mlmg -o stroll.bvh
  mlmg view stroll.bvh

`mlmg COMMAND --help` says more of each.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `mlmg` and return its exit code."""
    utf8_streams()
    one_thread_a_product()
    seldom_collect()
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words and words[0] in SUBCOMMANDS:
        return _run(words[0], words[1:])
    parser = argparse.ArgumentParser(
        prog="mlmg",
        usage="mlmg COMMAND ...",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description=_DESCRIPTION.format(commands="\n".join(f"  {n:<10} {text}" for n, text in SUBCOMMANDS.items())),
    )
    parser.add_argument("--version", action=VersionAction, nargs=0, help="show the version and leave")
    parser.add_argument("command", nargs="?", help=argparse.SUPPRESS)
    parser.add_argument("rest", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)
    parsed = parser.parse_args(words)
    if parsed.command is None:
        parser.print_help()
        return DONE
    _unknown(parsed.command)
    return WRONG_USAGE


def module_of(name: str) -> Any:
    """Return the module of a subcommand: its docstring, `add_arguments` and `run` are the command."""
    return import_module(_ELSEWHERE.get(name, f"mlmg_lang.commands.{name}"))


def _run(name: str, words: Sequence[str]) -> int:
    module = module_of(name)
    parser = argparse.ArgumentParser(
        prog=f"mlmg {name}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description=module.__doc__,
    )
    module.add_arguments(parser)
    parsed = parser.parse_args(words)
    return run_command(f"mlmg {name}", lambda: int(module.run(parsed)))


def _unknown(command: str) -> None:
    from difflib import get_close_matches

    near = get_close_matches(command, SUBCOMMANDS, n=1)
    meant = f"did you mean `mlmg {near[0]}`?" if near else f"there are {', '.join(SUBCOMMANDS)}"
    print(f"mlmg: error: no command `{command}`; {meant}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
