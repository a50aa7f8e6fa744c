"""Check scripts without playing them.

What is wrong is written to standard output, with the place and, where there is one, a remedy. With a library
(--library, else MLMG_LIBRARY, else the key `library` of the nearest mlmg.toml) names and types are checked
too; without one, syntax and structure only. `mlmg rule CODE` says more of a diagnostic.

Many diagnostics come with an edit. --fix applies those that say surely what was meant, --unsafe-fixes all, the
likeliest of each diagnostic, and both do so until none is left; --diff writes what they would change and changes
nothing. Where standard input is fixed (-), the text goes to standard output and what is left to say to standard error.

examples:
  mlmg check stroll.ms
  mlmg check --library my.mlmg --format concise *.ms
  mlmg check --diff stroll.ms
  mlmg check --fix stroll.ms
  generate | mlmg check --format json -
"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, WRONG_USAGE, UsageError, add_use_option, tell

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from mlmg_lang.catalog import Catalog
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.fixing import Diagnose
    from mlmg_lang.source import Source

FORMATS = ("full", "concise", "json", "github", "sarif")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    parser.add_argument("scripts", nargs="+", metavar="SCRIPT", help="a script; - reads standard input")
    parser.add_argument("--library", metavar="L.mlmg", help="the library that the scripts are for")
    add_use_option(parser)
    parser.add_argument("--format", choices=FORMATS, default="full", help="how diagnostics are written (full)")
    parser.add_argument("--fix", action="store_true", help="apply the edits that are safe")
    parser.add_argument("--unsafe-fixes", action="store_true", help="apply edits that are only likely, too")
    parser.add_argument("--diff", action="store_true", help="show what would be edited, and edit nothing")


def run(arguments: argparse.Namespace) -> int:
    """Check the scripts; return 1 if one has errors, 2 if one cannot be read or written."""
    from mlmg_lang.diagnostics import has_errors

    task = _task(arguments)
    done: list[_Checked] = []
    failed = False
    for script in arguments.scripts:
        try:
            done.append(task.check(script))
        except OSError as error:
            failed = True
            tell(f"mlmg check: error: {error.filename or script}: {error.strerror or error}")
    done = list(_once(done))
    if not task.diff:
        to_standard_error = task.fixes and "-" in arguments.scripts
        _write(done, arguments.format, sys.stderr if to_standard_error else sys.stdout)
    if done and (task.fixes or arguments.format == "full"):
        tell(_summed_up(done, task) + ("; without a library, names were not checked" if task.libraries.without else ""))
    if failed:
        return WRONG_USAGE
    judged = (one.before if task.diff else one.diagnostics for one in done)
    return WRONG_CONTENT if any(has_errors(tuple(found)) for found in judged) else DONE


def _task(arguments: argparse.Namespace) -> _Task:
    """Return what is to be done with each script."""
    if arguments.diff and arguments.format != "full":
        raise UsageError("--diff shows edits and no diagnostics, so there is nothing to write as --format says")
    fixes = arguments.fix or arguments.unsafe_fixes or arguments.diff
    libraries = _Libraries(arguments.library)
    return _Task(libraries, arguments.allow_use, fixes, arguments.unsafe_fixes, arguments.diff)


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
            from mlmg_runtime.library_names import open_names

            self._opened[path] = open_names(path)
        return self._opened[path]


@dataclass(frozen=True, slots=True)
class _Checked:
    """A script as it is at the end.

    Attributes
    ----------
    diagnostics : what is left to say of it.
    before : what there was to say of it at first.
    n_fixed : how many edits were made.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...]
    before: tuple[Diagnostic, ...]
    n_fixed: int = 0


@dataclass(frozen=True, slots=True)
class _Task:
    """What is done with each script.

    Attributes
    ----------
    allowed : folders from which scripts may use files.
    fixes : whether edits are applied; `unsafe` ones too; with `diff` only to show them.
    """

    libraries: _Libraries
    allowed: Sequence[str]
    fixes: bool
    unsafe: bool
    diff: bool

    def check(self, script: str) -> _Checked:
        """Check one script, and apply its edits if that is asked for."""
        from mlmg_lang.script_files import source_from_bytes

        data = sys.stdin.buffer.read() if script == "-" else Path(script).read_bytes()
        source, unreadable = source_from_bytes(data, "<stdin>" if script == "-" else script)
        if unreadable:
            return _Checked(source, unreadable, unreadable)
        library = self.libraries.for_script(script)

        def diagnose(source: Source) -> tuple[Source, tuple[Diagnostic, ...]]:
            return _diagnosed(source, library, script, self.allowed)

        whole, found = diagnose(source)
        if not self.fixes:
            return _Checked(whole, found, found)
        return self._fix(script, data, _Checked(whole, found, found), diagnose)

    def _fix(self, script: str, data: bytes, checked: _Checked, diagnose: Diagnose) -> _Checked:
        """Apply the edits of a script, and write them where they belong."""
        from mlmg_lang.fixing import fix_all

        fixed = fix_all(checked.source, checked.diagnostics, diagnose, self.unsafe)
        if self.diff:
            _show_changes(checked.source, fixed.source)
        elif script == "-" or fixed.n_fixed:
            _write_back(script, data, fixed.source.text)
        return replace(checked, source=fixed.source, diagnostics=fixed.diagnostics, n_fixed=fixed.n_fixed)


def _diagnosed(
    source: Source, library: Catalog | None, script: str, allowed: Sequence[str]
) -> tuple[Source, tuple[Diagnostic, ...]]:
    from mlmg_lang.front_end import analyse
    from mlmg_lang.script_files import used_files

    analysis = analyse(source, library, files=used_files(script, allowed))
    return analysis.source, analysis.diagnostics


# --- the edits -------------------------------------------------------------------------------------------


def _write_back(script: str, data: bytes, text: str) -> None:
    """Write a script anew, all or nothing; a byte order mark is kept."""
    from codecs import BOM_UTF8

    from mlmg_runtime.files import atomic_output

    changed = (BOM_UTF8 if data.startswith(BOM_UTF8) else b"") + text.encode("utf-8")
    if script == "-":
        sys.stdout.flush()
        sys.stdout.buffer.write(changed)
        return
    with atomic_output(script) as temporary:
        temporary.write_bytes(changed)


def _show_changes(before: Source, after: Source) -> None:
    """Write the difference of two texts to standard output, as `patch` reads it."""
    from mlmg_lang.rendering.changes import render_changes
    from mlmg_lang.rendering.colour import wants_colour

    sys.stdout.write(render_changes(before, after, wants_colour(sys.stdout)))


# --- what is said ----------------------------------------------------------------------------------------


def _once(done: Sequence[_Checked]) -> Iterator[_Checked]:
    """Yield scripts without what has been said already: a file that several use is looked at with each of them."""
    said: set[tuple[object, ...]] = set()
    for one in done:
        new = {_identity(diagnostic, one.source): diagnostic for diagnostic in one.diagnostics}
        yield replace(one, diagnostics=tuple(new[key] for key in new if key not in said))
        said.update(new)


def _identity(diagnostic: Diagnostic, source: Source) -> tuple[object, ...]:
    """Return what two diagnostics have in common that say the same of the same place in a file."""
    file, location = source, None
    if diagnostic.span is not None:
        file, location = source.file(diagnostic.span.start)[0], source.location(diagnostic.span)
    return os.path.realpath(file.name), location, diagnostic.code, diagnostic.message


def _write(done: Sequence[_Checked], form: str, stream: TextIO) -> None:
    """Write what was found."""
    checked = [(one.source, one.diagnostics) for one in done]
    if form in ("full", "concise") and not any(one.diagnostics for one in done):
        return
    from mlmg_lang import rendering

    if form == "json":
        stream.write(rendering.render_json(checked))
    elif form == "sarif":
        stream.write(rendering.render_sarif(checked))
    elif form == "github":
        stream.write(rendering.render_github(checked))
    elif form == "concise":
        stream.writelines(rendering.render_concise(found, source) for source, found in checked)
    else:
        colour = rendering.wants_colour(stream)
        stream.write("\n".join(rendering.render_full(found, source, colour) for source, found in checked if found))


def _summed_up(done: Sequence[_Checked], task: _Task) -> str:
    """Return how many diagnostics there are, and what edits did or could do about them."""
    left = [one for script in done for one in script.diagnostics]
    told = _counted(left)
    if not task.fixes:
        return (told or "nothing wrong") + _fixable(left)
    n_fixed = sum(script.n_fixed for script in done)
    verb = "would be fixed" if task.diff else "fixed"
    return f"{n_fixed or 'nothing'} {verb}, {f'{len(left)} left ({told})' if left else 'nothing left'}"


def _counted(found: Sequence[Diagnostic]) -> str:
    """Return how many diagnostics there are of each severity."""
    from mlmg_lang.diagnostics import Severity

    severities = [one.severity for one in found]
    counts = [(severities.count(severity), severity.value) for severity in Severity]
    return ", ".join(f"{n} {word}{'' if n == 1 else 's'}" for n, word in counts if n)


def _fixable(found: Sequence[Diagnostic]) -> str:
    """Return which options would mend how many diagnostics."""
    safe = sum(any(fix.safe for fix in one.fixes) for one in found)
    likely = sum(bool(one.fixes) for one in found)
    options = [f"--fix mends {safe}"] if safe else []
    options += [f"--unsafe-fixes {'' if safe else 'mends '}{likely}"] if likely > safe else []
    return f"; {', '.join(options)}" if options else ""
