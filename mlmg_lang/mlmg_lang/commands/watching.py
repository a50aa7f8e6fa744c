"""Which files a run reads, and when one of them has changed since."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from mlmg_lang.libraries import SETTINGS

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.source import Source

POLL_S = 0.2
"""How long after a save it is noticed, at most; looking at some dozen files takes a thousandth of that."""


@dataclass(frozen=True, slots=True)
class Stamp:
    """What tells one state of a file from another.

    Attributes
    ----------
    inode : an editor that writes beside and renames gives the old name to another file.
    """

    modified_ns: int
    size: int
    inode: int


Stamps: TypeAlias = Mapping[Path, Stamp | None]
"""Files as they are at a moment; None where there is none of that name."""


def stamp(path: Path) -> Stamp | None:
    """Return the state of a file now, or None if there is none."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return Stamp(found.st_mtime_ns, found.st_size, found.st_ino)


def changed(before: Stamps, now: Stamps) -> tuple[Path, ...]:
    """Return the files, of those there were to look at before, that have been written, made, replaced or taken away."""
    return tuple(path for path, was in before.items() if now.get(path) != was)


@dataclass(frozen=True, slots=True)
class Inputs:
    """The files that a run reads, each as it was before it was read: a save in between is a change."""

    stamps: dict[Path, Stamp | None] = field(default_factory=dict)

    def note(self, path: str | Path) -> Stamp | None:
        """Keep a file's state, if it is not kept yet, and return what is kept."""
        absolute = Path(os.path.abspath(path))
        if absolute not in self.stamps:
            self.stamps[absolute] = stamp(absolute)
        return self.stamps[absolute]

    def note_settings(self, script: str | Path) -> None:
        """Keep the state of every `mlmg.toml` that could name the library of a script, also of those not there yet."""
        for folder in {*Path(script).absolute().parents, *Path(os.path.realpath(script)).parents}:
            self.note(folder / SETTINGS)

    def wait_for_change(self) -> None:
        """Return when one of the files has changed."""
        while not changed(self.stamps, {path: stamp(path) for path in self.stamps}):
            time.sleep(POLL_S)


@dataclass(frozen=True, slots=True)
class NotedFiles:
    """Finds the files that a script uses, and notes them, also those that are not there."""

    files: Files
    inputs: Inputs

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return what `files` finds."""
        self.inputs.note(Path(user).parent / path)
        return self.files.find(path, user)
