"""The library that is played on where none is named."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import ProgressLine, tell

if TYPE_CHECKING:
    from mlmg_runtime.library import Library


def library_or_demo(path: Path | None, program: str) -> Library:
    """Open a library; where none is named, the demo library, and say so in one line.

    Parameters
    ----------
    program : the command, as it calls itself.
    """
    from mlmg_runtime.library import open_library

    if path is not None:
        return open_library(path)
    from mlmg_runtime.demo.library import demo_library

    progress = ProgressLine()
    try:
        path = demo_library(progress)
    finally:
        progress.clear()
    tell(f"{program}: no library is named (--library, MLMG_LIBRARY, mlmg.toml): playing on the demo library")
    return open_library(path)
