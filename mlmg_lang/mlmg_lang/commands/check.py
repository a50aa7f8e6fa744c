"""Check scripts without playing them.

Of a folder, all files *.ms in it and below are checked, but for folders whose names begin with a dot.
What is wrong is written to standard output, with the place and, where there is one, a remedy. With a library
(--library, else MLMG_LIBRARY, else the key `library` of the nearest mlmg.toml) names and types are checked
too; without one, syntax and structure only. `mlmg rule CODE` says more of a diagnostic.

Many diagnostics come with an edit. --fix applies those that say surely what was meant, --unsafe-fixes all, the
likeliest of each diagnostic, and both do so until none is left; --diff writes what they would change and changes
nothing. Only scripts that are named, or lie in a folder that is, are edited, not the files that they use. Where
standard input is fixed (-), the text goes to standard output and what is left to say to standard error.

examples:
  mlmg check stroll.ms
  mlmg check --library demo stroll.ms                  against the demo library
  mlmg check --library my.mlmg --format concise .      all scripts here and below
  mlmg check --diff stroll.ms
  mlmg check --fix stroll.ms
  generate | mlmg check --format json -
"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, WRONG_USAGE, UsageError, add_use_option, tell
from mlmg_lang.commands.scripts import ENDING, STANDARD, scripts_named

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from mlmg_lang.catalog import Catalog
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.source import Source

FORMATS = ("full", "concise", "json", "github", "sarif")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    what = "a script, or a folder of them; - reads standard input"
    parser.add_argument("scripts", nargs="*", metavar="SCRIPT", help=what)
    parser.add_argument(
        "--library", metavar="L.mlmg", help="the library that the scripts are for; demo is the demo library"
    )
    add_use_option(parser)
    parser.add_argument("--format", choices=FORMATS, default="full", help="how diagnostics are written (full)")
    parser.add_argument("--fix", action="store_true", help="apply the edits that are safe")
    parser.add_argument("--unsafe-fixes", action="store_true", help="apply edits that are only likely, too")
    parser.add_argument("--diff", action="store_true", help="show what would be edited, and edit nothing")


def run(arguments: argparse.Namespace) -> int:
    """Check the scripts; return 1 if one has errors, 2 if one cannot be read or written."""
    from mlmg_lang.diagnostics import has_errors

    task = _task(arguments)
    done, failed = _all_checked(arguments.scripts, task)
    if not task.diff:
        to_standard_error = task.fixes and STANDARD in arguments.scripts
        _write(done, arguments.format, sys.stderr if to_standard_error else sys.stdout)
    if done and (task.fixes or arguments.format == "full"):
        tell(_summed_up(done, task) + ("; without a library, names were not checked" if task.libraries.without else ""))
    if failed:
        return WRONG_USAGE
    judged = (one.before if task.diff else one.diagnostics for one in done)
    return WRONG_CONTENT if any(has_errors(tuple(found)) for found in judged) else DONE


def _all_checked(names: Sequence[str], task: _Task) -> tuple[list[_Checked], bool]:
    """Return the scripts as they are at the end, and whether one of them could not be read or written."""
    done: list[_Checked] = []
    refused: list[OSError] = []

    def refuse(error: OSError, script: str = "") -> None:
        refused.append(error)
        tell(f"mlmg check: error: {error.filename or script}: {error.strerror or error}")

    for script in scripts_named(names, refuse, "mlmg check"):
        try:
            done.append(task.check(script))
        except OSError as error:
            refuse(error, script)
    if not done and not refused:
        tell(f"there is no script (*{ENDING}) in this folder")
    return list(_once(task.settled(done))), bool(refused)


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
        from mlmg_lang.commands.demo import named_library

        path = named_library(script, self._option)
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
    script : as it was named.
    diagnostics : what is left to say of it.
    before : what there was to say of it at first.
    n_fixed : how many edits were made.
    """

    script: str
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

        data = sys.stdin.buffer.read() if script == STANDARD else Path(script).read_bytes()
        source, unreadable = source_from_bytes(data, "<stdin>" if script == STANDARD else script)
        if unreadable:
            return _Checked(script, source, unreadable, unreadable)
        whole, found = self._diagnosed(source, script)
        checked = _Checked(script, whole, found, found)
        return self._fix(data, checked) if self.fixes else checked

    def settled(self, done: Sequence[_Checked]) -> Iterator[_Checked]:
        """Yield scripts with what is left to say of them when the files that they use have been edited, too."""
        is_edited = not self.diff and any(one.n_fixed for one in done)
        for one in done:
            if is_edited and one.source.used:
                whole, found = self._diagnosed(replace(one.source, used=()), one.script)
                yield replace(one, source=whole, diagnostics=found)
            else:
                yield one

    def _diagnosed(self, source: Source, script: str) -> tuple[Source, tuple[Diagnostic, ...]]:
        from mlmg_lang.front_end import analyse
        from mlmg_lang.script_files import used_files

        analysis = analyse(source, self.libraries.for_script(script), files=used_files(script, self.allowed))
        return analysis.source, analysis.diagnostics

    def _fix(self, data: bytes, checked: _Checked) -> _Checked:
        """Apply the edits of a script, and write them where they belong."""
        from mlmg_lang.fixing import fix_all

        script = checked.script
        diagnose = partial(self._diagnosed, script=script)
        fixed = fix_all(checked.source, checked.diagnostics, diagnose, self.unsafe)
        if self.diff:
            _show_changes(checked.source, fixed.source)
        elif script == STANDARD or fixed.n_fixed:
            _write_back(script, data, fixed.source.text)
        return replace(checked, source=fixed.source, diagnostics=fixed.diagnostics, n_fixed=fixed.n_fixed)


# --- the edits -------------------------------------------------------------------------------------------


def _write_back(script: str, data: bytes, text: str) -> None:
    """Write a script anew, all or nothing; a byte order mark is kept."""
    from codecs import BOM_UTF8

    from mlmg_runtime.files import atomic_output

    changed = (BOM_UTF8 if data.startswith(BOM_UTF8) else b"") + text.encode("utf-8")
    if script == STANDARD:
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


def _once(done: Iterable[_Checked]) -> Iterator[_Checked]:
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
        return (told or "nothing wrong") + _fixable(done)
    verb = "would be fixed" if task.diff else "fixed"
    n_fixed = sum(script.n_fixed for script in done)
    return (
        f"{n_fixed or 'nothing'} {verb}{_where_fixed(done)}, {f'{len(left)} left ({told})' if left else 'nothing left'}"
    )


def _where_fixed(done: Sequence[_Checked]) -> str:
    """Return how many edits there were in which script, where there are several scripts."""
    counts = [f"{one.n_fixed} in {one.source.name}" for one in done if one.n_fixed]
    if len(done) == 1 or not counts:
        return ""
    return f" ({', '.join(counts)})" if len(counts) > 1 else f" {counts[0].partition(' ')[2]}"


def _counted(found: Sequence[Diagnostic]) -> str:
    """Return how many diagnostics there are of each severity."""
    from mlmg_lang.diagnostics import Severity
    from mlmg_lang.spelling import counted

    severities = [one.severity for one in found]
    counts = [(severities.count(severity), severity.value) for severity in Severity]
    return ", ".join(counted(n, word) for n, word in counts if n)


def _fixable(done: Sequence[_Checked]) -> str:
    """Return which options would mend how many diagnostics, and in which other files there are some to mend."""
    safe = likely = 0
    elsewhere: dict[str, None] = {}
    named = {os.path.realpath(one.script) for one in done}
    for script in done:
        for one in script.diagnostics:
            file = _file_of(one, script.source)
            if one.fixes and file is not None and os.path.realpath(file) not in named:
                elsewhere[file] = None
            else:
                safe += any(fix.safe for fix in one.fixes)
                likely += bool(one.fixes)
    options = [f"--fix mends {safe}"] if safe else []
    options += [f"--unsafe-fixes {'' if safe else 'mends '}{likely}"] if likely > safe else []
    options += (
        [f"to mend {' and '.join(elsewhere)}, name {'it' if len(elsewhere) == 1 else 'them'} too"] if elsewhere else []
    )
    return f"; {', '.join(options)}" if options else ""


def _file_of(one: Diagnostic, source: Source) -> str | None:
    """Return the name of the used file that a diagnostic is about; None for the script itself."""
    if one.span is None or one.span.start <= len(source.text):
        return None
    return source.file(one.span.start)[0].name
