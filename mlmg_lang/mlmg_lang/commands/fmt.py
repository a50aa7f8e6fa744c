"""Rewrite scripts in the one canonical form.

Of a folder, all files *.ms in it and below are taken, but for folders whose names begin with a dot. What is in the
form already is not touched. A statement with a mistake is kept as it is and told on standard error; the rest of its
script is rewritten all the same.

examples:
  mlmg fmt stroll.ms
  mlmg fmt .                            all scripts here and below
  mlmg fmt --check .                    write nothing, list what would be rewritten
  mlmg fmt --diff stroll.ms             write nothing, show what would change
  mlmg fmt --fix --library my.mlmg .    names as the library spells them, too
  generate | mlmg fmt -                 standard input and output

exit codes:
  0  done; with --check or --diff: nothing would change
  1  a script has mistakes, or is not UTF-8; with --check or --diff: something would change
  2  a file cannot be read or written
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, WRONG_USAGE, add_use_option, tell
from mlmg_lang.commands.scripts import ENDING, STANDARD, scripts_named

if TYPE_CHECKING:
    from mlmg_lang.catalog import Catalog
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.source import Source


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    what = "a script, or a folder of them; - reads standard input and writes standard output"
    parser.add_argument("scripts", nargs="*", metavar="SCRIPT", help=what)
    parser.add_argument("--check", action="store_true", help="write nothing; list the scripts that would be rewritten")
    parser.add_argument("--diff", action="store_true", help="write nothing; show what would change")
    parser.add_argument("--fix", action="store_true", help="write names as the library spells them, too")
    parser.add_argument(
        "--library", metavar="L.mlmg", help="the library whose spellings --fix takes; demo is the demo library"
    )
    add_use_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Rewrite the scripts; return 1 if one has mistakes or would be rewritten, 2 if one cannot be read or written."""
    only_shown = arguments.check or arguments.diff
    speller = _Speller(arguments.library, arguments.allow_use) if arguments.fix else None
    tally = _Tally()
    for script in scripts_named(arguments.scripts, tally.refused, "mlmg fmt"):
        try:
            rewriting = _rewrite(script, speller)
            if only_shown:
                _show(rewriting, arguments.diff)
            else:
                _write(rewriting)
        except BrokenPipeError:
            raise
        except OSError as error:
            tally.refused(error, script)
        else:
            tally.count(rewriting)
            _tell_mistakes(rewriting, only_shown)
    tally.sum_up("would be rewritten" if only_shown else "rewritten")
    return tally.exit_code(only_shown)


# --- one script ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Rewriting:
    """A script as it is, and as it should be.

    Attributes
    ----------
    script : the path, or `-`.
    source : as it was read.
    before : with its byte order mark, if it has one.
    whole : whether all of it could be read.
    unreadable : why it is no text; then it stays as it is.
    """

    script: str
    source: Source
    before: Source
    after: Source
    whole: bool = True
    unreadable: tuple[Diagnostic, ...] = ()

    @property
    def changes(self) -> bool:
        """Return whether there is anything to do."""
        return self.before.text != self.after.text


def _rewrite(script: str, speller: _Speller | None) -> _Rewriting:
    from mlmg_lang.formatting.format_script import format_script
    from mlmg_lang.script_files import source_from_bytes
    from mlmg_lang.source import Source

    is_standard = script == STANDARD
    data = sys.stdin.buffer.read() if is_standard else Path(script).read_bytes()
    source, unreadable = source_from_bytes(data, "<stdin>" if is_standard else script)
    if unreadable:
        return _Rewriting(script, source, source, source, unreadable=unreadable)
    formatted = format_script(source if speller is None else speller.spelt(source, script))
    before, after = (Source(text, source.name) for text in (data.decode("utf-8"), formatted.text))
    return _Rewriting(script, source, before, after, formatted.whole)


def _show(rewriting: _Rewriting, changes: bool) -> None:
    """Say on standard output that a script would be rewritten; with its changes, if they are asked for."""
    from mlmg_lang.rendering import wants_colour
    from mlmg_lang.rendering.changes import render_changes

    if changes:
        sys.stdout.write(render_changes(rewriting.before, rewriting.after, wants_colour(sys.stdout)))
    elif rewriting.changes:
        print(rewriting.before.name)


def _write(rewriting: _Rewriting) -> None:
    """Write a script in its place, unless it is there already."""
    from mlmg_runtime.files import atomic_output

    data = rewriting.after.text.encode("utf-8")
    if rewriting.script == STANDARD:
        if not rewriting.unreadable:
            sys.stdout.buffer.write(data)
    elif rewriting.changes:
        with atomic_output(rewriting.script) as beside:
            beside.write_bytes(data)


def _tell_mistakes(rewriting: _Rewriting, only_shown: bool) -> None:
    """Say on standard error what could not be read, with its place in what the file holds now."""
    from mlmg_lang.rendering import render_concise

    if rewriting.unreadable:
        sys.stderr.write(render_concise(rewriting.unreadable, rewriting.before))
    elif not rewriting.whole:
        source = rewriting.source if only_shown else rewriting.after
        sys.stderr.write(render_concise(_mistakes(source), source))


def _mistakes(source: Source) -> list[Diagnostic]:
    """Return what cannot be read in a script, in the order of the text."""
    from mlmg_lang.diagnostics import Severity
    from mlmg_lang.parsing.parse import parse
    from mlmg_lang.parsing.tokenize import tokenize

    errors = [one for one in parse(source, tokenize(source)).diagnostics if one.severity is Severity.ERROR]
    return sorted(errors, key=lambda one: (one.span is not None, one.span))


class _Speller:
    """Puts the spellings of a library into scripts; opens each library once."""

    def __init__(self, library: str | None, allowed: list[str]) -> None:
        """Take the options that say which library, and what scripts may use."""
        self._library = library
        self._allowed = allowed
        self._opened = cache(_open)
        self._told = False

    def spelt(self, source: Source, script: str) -> Source:
        """Return a script with exact names; as it is if it has no library, or uses definitions that are not there."""
        from mlmg_lang.commands.demo import named_library
        from mlmg_lang.formatting.exact_names import with_exact_names
        from mlmg_lang.front_end import analyse
        from mlmg_lang.script_files import used_files

        path = named_library(script, self._library)
        if path is None:
            if not self._told:
                tell("without a library, names are left as they are")
            self._told = True
            return source
        analysis = analyse(source, self._opened(path), files=used_files(script, self._allowed))
        if not analysis.definitions.complete:
            tell(f"{source.name}: a file that it uses cannot be read, so its names are left as they are")
            return source
        return with_exact_names(source, analysis.diagnostics)


def _open(path: Path) -> Catalog:
    from mlmg_runtime.library_names import open_names

    return open_names(path)


# --- all of them -----------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Tally:
    """What has become of the scripts."""

    rewritten: int = 0
    left: int = 0
    wrong: int = 0
    refusals: int = 0
    files: int = 0

    def count(self, rewriting: _Rewriting) -> None:
        """Count a script."""
        self.rewritten += rewriting.changes
        self.left += not rewriting.changes
        self.wrong += not rewriting.whole or bool(rewriting.unreadable)
        self.files += rewriting.script != STANDARD

    def refused(self, error: OSError, script: str = "") -> None:
        """Count and tell what cannot be read or written."""
        self.refusals += 1
        tell(f"mlmg fmt: error: {error.filename or script}: {error.strerror or error}")

    def sum_up(self, done: str) -> None:
        """Say on standard error how many scripts there were; of standard input alone there is nothing to say."""
        if self.files:
            counts = [(self.rewritten, done), (self.left, "left as they are" if self.left > 1 else "left as it is")]
            tell(", ".join(f"{n} script{'' if n == 1 else 's'} {what}" for n, what in counts if n))
        elif not (self.rewritten or self.left or self.refusals):
            tell(f"there is no script (*{ENDING}) in this folder")

    def exit_code(self, only_shown: bool) -> int:
        """Return how the command ends."""
        if self.refusals:
            return WRONG_USAGE
        return WRONG_CONTENT if self.wrong or (only_shown and self.rewritten) else DONE
