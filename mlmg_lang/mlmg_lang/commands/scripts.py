"""The scripts that a command is to work at: those named, and those in the folders named."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final

from mlmg_lang.commands.console import UsageError

STANDARD: Final = "-"
"""Standard input."""
ENDING: Final = ".ms"


def scripts_named(names: Sequence[str], refused: Callable[[OSError], None], program: str) -> Iterator[str]:
    """Return every script once, those of folders in the order of their paths.

    Of a folder, all files *.ms in it and below are taken, but for folders whose names begin with a dot.

    Parameters
    ----------
    refused : told of each folder that cannot be read.
    program : the command, as it calls itself.

    Raises
    ------
    UsageError
        If nothing is named.
    """
    if not names:
        raise UsageError(
            f"no script is named; `{program} stroll.ms` takes one, `{program} .` all in this folder and below"
        )
    return _each_once(names, refused)


def _each_once(names: Iterable[str], refused: Callable[[OSError], None]) -> Iterator[str]:
    taken: set[str] = set()
    for name in names:
        is_folder = name != STANDARD and os.path.isdir(name)
        for script in _in_folder(name, refused) if is_folder else [name]:
            real = script if script == STANDARD else os.path.realpath(script)
            if real not in taken:
                taken.add(real)
                yield script


def _in_folder(folder: str, refused: Callable[[OSError], None]) -> Iterator[str]:
    for place, folders, files in os.walk(folder, onerror=refused):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from (os.path.normpath(os.path.join(place, name)) for name in sorted(files) if name.endswith(ENDING))
