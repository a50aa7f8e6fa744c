"""The library of a command: the one that is named, or else the demo library."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import ProgressLine, tell

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mlmg_runtime.library import Library


def named_library(script: str | Path, option: str | Path | None) -> Path | None:
    """Return the path of the library that is named for a script, as `find_library` does, with a line of progress."""
    from mlmg_lang.libraries import find_library

    with _progress() as progress:
        return find_library(script, option, progress)


def demo_path() -> Path:
    """Return the path of the demo library, with a line of progress while it is built."""
    from mlmg_runtime.demo.library import demo_library

    with _progress() as progress:
        return demo_library(progress)


def library_or_demo(path: Path | None, program: str) -> Library:
    """Open a library; where none is named, the demo library, and say so in one line.

    Parameters
    ----------
    program : the command, as it calls itself.
    """
    from mlmg_runtime.library import open_library

    if path is not None:
        return open_library(path)
    path = demo_path()
    tell(f"{program}: no library is named (--library, MLMG_LIBRARY, mlmg.toml): playing on the demo library")
    return open_library(path)


@contextmanager
def _progress() -> Iterator[ProgressLine]:
    line = ProgressLine()
    try:
        yield line
    finally:
        line.clear()
