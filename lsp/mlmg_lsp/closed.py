"""The scripts in the folders of a client that are not open there -> those that use what is asked about."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from mlmg_lang.source import Source
from mlmg_lsp.libraries import Stamp
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.scripts_below import BOUNDS, Below, Found, scripts_below

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.front_end import Analysis

_MOST_NAMED: Final = 3
"""So many files are named that were not looked at."""

Paths: TypeAlias = tuple[str, tuple[str, ...]]
"""The name of a script, and the paths in it, as they are written."""


@dataclass(frozen=True, slots=True)
class Dependents:
    """The scripts that use a file and are not open.

    Attributes
    ----------
    analyses : without a library: what scripts give names to is known without.
    unread : why some are not known that use the file, or may, in words.
    left_out : what was not looked at, in words; empty if all was.
    """

    analyses: tuple[Analysis, ...] = ()
    unread: tuple[str, ...] = ()
    left_out: str = ""


@dataclass(frozen=True, slots=True)
class _Look:
    """What is kept of a file: the paths in it; or why it cannot be read."""

    stamp: Stamp
    paths: tuple[str, ...]
    wrong: str = ""


class ClosedScripts:
    """Looks for scripts that are not open; in a file that has not changed it looks once."""

    def __init__(self, files: Callable[[Path], Files]) -> None:
        """Take what says where the script at a path finds the files that it uses."""
        self._files = files
        self._looks: dict[str, _Look] = {}

    def users(self, home: str, folders: Sequence[Path], snapshot: Snapshot) -> Dependents:
        """Return the scripts in some folders, and below, that use a file, themselves or by way of others.

        Parameters
        ----------
        home : the path of the file.
        snapshot : of one of the open texts: what these and the files that they use say is taken as it is there.
        """
        below = scripts_below(folders)
        opened = {os.path.realpath(name) for name in snapshot.opened}
        closed = {one.real: one for one in below.scripts if one.real not in opened}
        self._looks = looks = {real: self._look(one) for real, one in closed.items() if one not in below.too_large}
        known = _known(snapshot)
        paths = {real: (closed[real].path, look.paths) for real, look in looks.items()} | _paths(known)
        reached = _users(os.path.realpath(home), paths)
        read = [self._analysed(closed[real], known) for real in sorted(reached & looks.keys())]
        unread = [f"{closed[real].path} {look.wrong}" for real, look in looks.items() if look.wrong]
        unread += [one for one in read if isinstance(one, str)]
        analyses = tuple(one for one in read if not isinstance(one, str))
        return Dependents(analyses, tuple(unread), _left_out(below, opened))

    def _look(self, script: Found) -> _Look:
        before = self._looks.get(script.real)
        return before if before is not None and before.stamp == script.stamp else _look(script)

    def _analysed(self, script: Found, known: dict[str, Source]) -> Analysis | str:
        """Return what is known of a script; or, in words, why it cannot be read."""
        from mlmg_lang.front_end import Question, analyse_for
        from mlmg_lang.script_files import read_script

        source = known.get(script.real)
        if source is None:
            try:
                source, wrong = read_script(script.path)
            except OSError as error:
                return f"{script.path} cannot be read: {error.strerror}"
            if wrong:
                return f"{script.path} cannot be read: {wrong[0].message}"
            known[script.real] = source
        files = _ReadOnce(self._files(Path(source.name)), known)
        return analyse_for(source, Question(None, None, None, files))


@dataclass(frozen=True, slots=True)
class _ReadOnce:
    """Finds used files, each with one text for all who use it: edits of several scripts have to fit together.

    Attributes
    ----------
    known : by their paths without links, also under the names that they go by in the client.
    """

    files: Files
    known: dict[str, Source]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file and what is wrong with its bytes; or, in words, why it cannot be used."""
        found = self.files.find(path, user)
        if isinstance(found, str):
            return found
        real = os.path.realpath(found[0].name)
        if real in self.known:
            return self.known[real], ()
        if not found[1]:
            self.known[real] = found[0]
        return found


def _look(script: Found) -> _Look:
    from mlmg_lang.ide.links import paths_in

    try:
        data = Path(script.path).read_bytes()
    except FileNotFoundError:  # it has gone meanwhile
        return _Look(script.stamp, ())
    except OSError as error:
        return _Look(script.stamp, (), f"may use this too, and cannot be read: {error.strerror}")
    # Nearly all can be passed over by this alone.
    paths = paths_in(data.decode("utf-8", "replace")) if b"use" in data.lower() else ()
    return _Look(script.stamp, paths)


def _known(snapshot: Snapshot) -> dict[str, Source]:
    """Return the open texts and the files that they use, by their paths without links."""
    # The text that is asked about comes last, so that what it has holds.
    known = (*reversed(snapshot.others), snapshot.analysis)
    sources = (source for one in known for source in (*one.source.used, one.source))
    return {os.path.realpath(source.name): Source(source.text, source.name) for source in sources}


def _paths(known: Mapping[str, Source]) -> dict[str, Paths]:
    from mlmg_lang.ide.links import paths_in

    return {real: (source.name, paths_in(source.text)) for real, source in known.items()}


def _users(home: str, scripts: Mapping[str, Paths]) -> set[str]:
    """Return the scripts that use one of them, or another that does; all by their paths without links."""
    names = {os.path.basename(path) for real, (name, _) in scripts.items() for path in (real, name)}
    users: dict[str, list[str]] = {}
    for real, (name, paths) in scripts.items():
        for path in paths:
            if os.path.basename(path) in names:
                users.setdefault(_real(name, path), []).append(real)
    found, waiting = set[str](), [home]
    while waiting:
        new = [user for user in users.get(waiting.pop(), ()) if user not in found]
        found.update(new)
        waiting.extend(new)
    return found


def _real(user: str, path: str) -> str:
    try:
        return os.path.realpath(os.path.normpath(Path(user).parent / path))
    except ValueError:  # there is a NUL in it, or half a character
        return ""


def _left_out(below: Below, opened: set[str]) -> str:
    """Return what was not looked at, in words; empty if all was."""
    large = [one.path for one in below.too_large if one.real not in opened]
    named = ", ".join(large[:_MOST_NAMED]) + (f" and {len(large) - _MOST_NAMED} more" if large[_MOST_NAMED:] else "")
    said = [f"{named}: larger than {BOUNDS.n_bytes:,} bytes"] if large else []
    if not below.is_all:
        said.append(
            f"what lies deeper than the first {BOUNDS.n_scripts:,} scripts or {BOUNDS.n_entries:,} files of the folders"
        )
    return "; ".join(said)
