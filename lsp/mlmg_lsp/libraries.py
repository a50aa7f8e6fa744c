"""Opened libraries: each once, for all texts and all clients of a process, until its file is another."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias
from weakref import WeakValueDictionary

from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lang.ide.offers import Offers
    from mlmg_lang.planning.names import Names
    from mlmg_runtime.library import Library

Stamp: TypeAlias = tuple[int, int, int]
"""What tells a file from what it was before: when it was written, how long it is, and which it is."""


@dataclass(frozen=True, eq=False)
class Shelved:
    """A library that is open, with what has been worked out of it.

    Attributes
    ----------
    offers : its names, as completion ranks them.
    """

    library: Library
    names: Names
    offers: Offers
    stamp: Stamp | None


class Shelf:
    """All libraries that are open: those that somebody has, and the last that was asked for."""

    def __init__(self) -> None:
        """Begin with none."""
        self._open: WeakValueDictionary[Path, Shelved] = WeakValueDictionary()
        self._last: Shelved | None = None
        self._opening: dict[Path, asyncio.Task[Shelved]] = {}

    def has(self, path: Path) -> bool:
        """Return whether a library is open, and its file still the same."""
        return self._current(path) is not None

    async def get(self, path: Path) -> Shelved:
        """Return a library, which is opened if it is not open yet.

        Raises
        ------
        mlmg_runtime.errors.MlmgError
            If the file is no library, is damaged, or was built by another version.
        OSError
            If it cannot be opened.
        """
        known = self._current(path)
        if known is not None:
            self._last = known
            return known
        if path not in self._opening:
            self._opening[path] = asyncio.ensure_future(off_loop(lambda: _opened(path), is_whole=True))
        try:
            # Others may wait for the same library when the one who asked first has gone.
            shelved = await asyncio.shield(self._opening[path])
        finally:
            if path in self._opening and self._opening[path].done():
                del self._opening[path]
        self._open[path] = self._last = shelved
        return shelved

    def _current(self, path: Path) -> Shelved | None:
        shelved = self._open.get(path)
        return shelved if shelved is not None and shelved.stamp == stamp_of(path) else None


def stamp_of(path: Path) -> Stamp | None:
    """Return what tells a file from what it was before; None if there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _opened(path: Path) -> Shelved:
    # Imported here, as numpy takes long and is not needed until now.
    from mlmg_lang.ide.offers import Offers
    from mlmg_lang.planning.names import Names
    from mlmg_lsp.fits import Kept, LibraryFits
    from mlmg_runtime.library import open_library

    stamp = stamp_of(path)
    library = open_library(path)
    names = Names(library)
    offers = Offers(names, LibraryFits(library), {}, Kept())
    for graph in names.graphs:
        offers.on(graph, (library.start,))  # what it works out of a library alone takes longer than a key may
    return Shelved(library, names, offers, stamp)
