"""Which library a script is read against."""

from __future__ import annotations

import os
from pathlib import Path

SETTINGS = "mlmg.toml"
VARIABLE = "MLMG_LIBRARY"


def find_library(script: str | Path, option: str | Path | None = None) -> Path | None:
    """Return the path of the library for a script, or None if nothing names one.

    It is the first there is of: the option; the environment variable `MLMG_LIBRARY`; the key `library` of the
    nearest `mlmg.toml`, in the script's folder or one above it, as a path from that file.

    Parameters
    ----------
    script : the path of the script; `-` is taken to stand in the current folder.

    Raises
    ------
    mlmg_runtime.errors.ConfigurationError
        If that `mlmg.toml` is not TOML, holds another key, or its `library` is not text.
    OSError
        If it cannot be read.
    """
    named = option or os.environ.get(VARIABLE)
    if named:
        return Path(named)
    folder = Path.cwd() if str(script) == "-" else Path(script).absolute().parent
    for place in (folder, *folder.parents):
        settings = place / SETTINGS
        if settings.is_file():
            return _library_of(settings)
    return None


def _library_of(settings: Path) -> Path | None:
    """Return the library that a settings file names, if it names one."""
    from mlmg_runtime.building.toml_files import read_toml

    file = read_toml(settings)
    file.check_keys(file.document, (), ("library",))
    named = file.document.get("library")
    if named is None:
        return None
    if not isinstance(named, str) or not named:
        file.fail(("library",), f"`library` should be the path of a library, as text; found {named!r}")
    return settings.parent / named
