"""Which library a script is read against."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

SETTINGS = "mlmg.toml"
VARIABLE = "MLMG_LIBRARY"
DEMO = "demo"
"""What the demo library is called where a library is named, unless there is a file of that name."""

_DEMO_FILE: Final = re.compile(r"demo-[0-9a-f]{12}\.mlmg")

Progress: TypeAlias = Callable[[str, int, int], None]


def find_library(
    script: str | Path, option: str | Path | None = None, progress: Progress = lambda *_: None
) -> Path | None:
    """Return the path of the library for a script, or None if nothing names one.

    It is the first there is of: the option; the environment variable `MLMG_LIBRARY`; the key `library` of the
    nearest `mlmg.toml`, in the script's folder or one above it, as a path from that file. Each may say `demo`, for the
    demo library, which is built when it is first needed; a file or folder `demo` at that place is meant before it.

    Parameters
    ----------
    script : the path of the script; `-` is taken to stand in the current folder.
    progress : called while the demo library is built.

    Raises
    ------
    mlmg_runtime.errors.ConfigurationError
        If that `mlmg.toml` is not TOML, holds another key, or its `library` is not text.
    OSError
        If it cannot be read, or the demo library cannot be written.
    """
    named = option or os.environ.get(VARIABLE)
    if named:
        return _named(named, Path(), progress)
    folder = Path.cwd() if str(script) == "-" else Path(script).absolute().parent
    for place in (folder, *folder.parents):
        settings = place / SETTINGS
        if settings.is_file():
            return _library_of(settings, progress)
    return None


def is_demo(library: Path) -> bool:
    """Return whether a library is the demo library, by what its file is called."""
    return _DEMO_FILE.fullmatch(library.name) is not None


def _named(name: str | Path, folder: Path, progress: Progress) -> Path:
    """Return the path of a library that is named in a folder."""
    if str(name) != DEMO or (folder / name).exists():
        return folder / name
    from mlmg_runtime.demo.library import demo_library

    return demo_library(progress)


def _library_of(settings: Path, progress: Progress) -> Path | None:
    """Return the library that a settings file names, if it names one."""
    from mlmg_runtime.building.toml_files import read_toml

    file = read_toml(settings)
    file.check_keys(file.document, (), ("library",))
    named = file.document.get("library")
    if named is None:
        return None
    if not isinstance(named, str) or not named:
        file.fail(("library",), f"`library` should be the path of a library, as text; found {named!r}")
    return _named(named, settings.parent, progress)
