"""Check scripts without playing them.

What is wrong is written to standard output, with the place and, where there is one, a remedy. With a library
(--library, else MLMG_LIBRARY, else the key `library` of the nearest mlmg.toml) names and types are checked
too; without one, syntax and structure only.

examples:
  mlmg check stroll.ms
  mlmg check --library my.mlmg --format concise *.ms
  generate | mlmg check --format json -
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, WRONG_USAGE, add_use_option, tell

if TYPE_CHECKING:
    from mlmg_lang.catalog import Catalog
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.source import Source

FORMATS = ("full", "concise", "json")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    parser.add_argument("scripts", nargs="+", metavar="SCRIPT", help="a script; - reads standard input")
    parser.add_argument("--library", metavar="L.mlmg", help="the library that the scripts are for")
    add_use_option(parser)
    parser.add_argument("--format", choices=FORMATS, default="full", help="how diagnostics are written")


def run(arguments: argparse.Namespace) -> int:
    """Check the scripts; return 1 if one has errors, 2 if one cannot be read."""
    from mlmg_lang.diagnostics import has_errors

    checked: list[tuple[Source, tuple[Diagnostic, ...]]] = []
    libraries = _Libraries(arguments.library)
    unread = False
    for script in arguments.scripts:
        try:
            checked.append(_check(script, libraries, arguments.allow_use))
        except OSError as error:
            unread = True
            tell(f"mlmg check: error: {error.filename or script}: {error.strerror or error}")
    _write(checked, arguments.format)
    if arguments.format == "full":
        _sum_up(checked, libraries)
    if unread:
        return WRONG_USAGE
    return WRONG_CONTENT if any(has_errors(found) for _, found in checked) else DONE


class _Libraries:
    """Opens each library once."""

    def __init__(self, option: str | None) -> None:
        self.without = False
        self._option = option
        self._opened: dict[Path, Catalog] = {}

    def for_script(self, script: str) -> Catalog | None:
        """Return the library of a script, if it has one."""
        from mlmg_lang.libraries import find_library

        path = find_library(script, self._option)
        if path is None:
            self.without = True
            return None
        if path not in self._opened:
            from mlmg_runtime.library import open_library

            self._opened[path] = open_library(path)
        return self._opened[path]


def _check(script: str, libraries: _Libraries, allowed: list[str]) -> tuple[Source, tuple[Diagnostic, ...]]:
    from mlmg_lang.front_end import analyse
    from mlmg_lang.script_files import read_script, used_files

    source, unreadable = read_script(script)
    if unreadable:
        return source, unreadable
    analysis = analyse(source, libraries.for_script(script), files=used_files(script, allowed))
    return analysis.source, analysis.diagnostics


def _write(checked: list[tuple[Source, tuple[Diagnostic, ...]]], form: str) -> None:
    """Write what was found to standard output."""
    from mlmg_lang.rendering import render_concise, render_full, render_json, wants_colour

    if form == "json":
        sys.stdout.write(render_json(checked))
    elif form == "concise":
        sys.stdout.writelines(render_concise(found, source) for source, found in checked)
    else:
        colour = wants_colour(sys.stdout)
        drawn = (render_full(found, source, colour) for source, found in checked if found)
        sys.stdout.write("\n".join(drawn))


def _sum_up(checked: list[tuple[Source, tuple[Diagnostic, ...]]], libraries: _Libraries) -> None:
    """Say on standard error how many diagnostics there were, and what was not looked at."""
    from mlmg_lang.diagnostics import Severity

    found = [one.severity for _, diagnostics in checked for one in diagnostics]
    counts = [(found.count(severity), severity.value) for severity in Severity]
    told = ", ".join(f"{n} {word}{'' if n == 1 else 's'}" for n, word in counts if n)
    limits = "; without a library, names were not checked" if libraries.without else ""
    if checked:
        tell(f"{told or 'nothing wrong'}{limits}")
