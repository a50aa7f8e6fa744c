"""The names of files as services that show diagnostics beside code expect them."""

from __future__ import annotations

import os
from pathlib import Path

STDIN = "<stdin>"


def relative(name: str) -> str:
    """Return a path from the current folder, where that has the file in it, else an absolute one; with `/`."""
    if name == STDIN:
        return name
    path = Path(os.path.abspath(name))
    folder = Path.cwd()
    return (path.relative_to(folder) if path.is_relative_to(folder) else path).as_posix()
