"""Folders -> the scripts in them and below, within bounds: a folder may hold anything."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mlmg_lsp.libraries import Stamp, stamp_of

_SUFFIX: Final = ".ms"
_PASSED_OVER: Final = frozenset({"node_modules", "__pycache__"})
"""Folders in which nobody keeps scripts, beside those that are hidden."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """How many scripts are looked at, of how many bytes each, among how many files and folders."""

    n_scripts: int = 2_000
    n_bytes: int = 1_000_000
    n_entries: int = 100_000


BOUNDS: Final = Bounds()


@dataclass(frozen=True, slots=True)
class Found:
    """A script on disk.

    Attributes
    ----------
    path : as its folder was named. real : without links.
    """

    path: str
    real: str
    stamp: Stamp


@dataclass(frozen=True, slots=True)
class Below:
    """The scripts in some folders and below.

    Attributes
    ----------
    scripts : each file once.
    too_large : those among them that are too large to be read.
    is_all : False if there are more scripts, or more of anything, than are looked at.
    """

    scripts: tuple[Found, ...]
    too_large: tuple[Found, ...]
    is_all: bool


def scripts_below(folders: Iterable[Path], bounds: Bounds = BOUNDS) -> Below:
    """Return the scripts in some folders and below, the nearest first; what cannot be listed is passed over."""
    found: dict[str, Found] = {}
    for number, entry in enumerate(_entries(map(str, folders))):
        script = _script(entry)
        if number >= bounds.n_entries or (script is not None and len(found) >= bounds.n_scripts):
            return _below(found.values(), bounds, is_all=False)
        if script is not None:
            found.setdefault(script.real, script)
    return _below(found.values(), bounds, is_all=True)


def _below(found: Iterable[Found], bounds: Bounds, is_all: bool) -> Below:
    scripts = tuple(found)
    return Below(scripts, tuple(one for one in scripts if one.stamp[1] > bounds.n_bytes), is_all)


def _entries(folders: Iterable[str]) -> Iterator[os.DirEntry[str]]:
    """Yield what is in folders and in those below, each once: links may lead in a circle."""
    waiting, seen = deque(folders), set[str]()
    while waiting:
        folder = waiting.popleft()
        real = os.path.realpath(folder)
        if real in seen:
            continue
        seen.add(real)
        try:
            with os.scandir(folder) as listed:
                entries = sorted(listed, key=lambda entry: entry.name)
        except OSError:
            continue
        yield from entries
        waiting.extend(entry.path for entry in entries if _may_hold_scripts(entry))


def _may_hold_scripts(entry: os.DirEntry[str]) -> bool:
    try:
        return not entry.name.startswith(".") and entry.name not in _PASSED_OVER and entry.is_dir()
    except OSError:  # links that lead in a circle
        return False


def _script(entry: os.DirEntry[str]) -> Found | None:
    try:
        stamp = stamp_of(Path(entry.path)) if entry.name.endswith(_SUFFIX) and entry.is_file() else None
    except OSError:  # links that lead in a circle
        return None
    return None if stamp is None else Found(entry.path, os.path.realpath(entry.path), stamp)
