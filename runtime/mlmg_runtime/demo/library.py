"""The demo library as a file: built on first use into the user's cache folder."""

from __future__ import annotations

import errno
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path


def demo_library(progress: Callable[[str, int, int], None] = lambda *_: None) -> Path:
    """Return the demo library's file, building it first if this version has not yet.

    Processes that start at once may each build it; the file appears whole, and all of them write the same.

    Parameters
    ----------
    progress : called with what is being done, how much of it is done, and of how much.

    Raises
    ------
    OSError
        If the cache folder cannot be used; the error names it, and MLMG_CACHE, which names it or may name another.
    """
    path = cache_folder() / f"demo-{_fingerprint()}.mlmg"
    if not os.path.exists(path):
        _make_room(path)
        _build(path, progress)
    return path


def cache_folder() -> Path:
    """Return the user's folder for files that can be made again: MLMG_CACHE, else where the system keeps them."""
    if own := os.environ.get("MLMG_CACHE"):
        return Path(own)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "mlmg" / "Cache"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "mlmg"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mlmg"


def _make_room(path: Path) -> None:
    """Make the cache folder, and try whether a file can be written there, before the work that it is for."""
    from mlmg_runtime.files import check_output

    folder = path.parent
    try:
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        folder.mkdir(parents=True, exist_ok=True)
        check_output(path)
    except OSError as error:
        named = (
            "because MLMG_CACHE says so" if os.environ.get("MLMG_CACHE") else "unless MLMG_CACHE names another folder"
        )
        why = f"{error.strerror}; the demo library is kept here {named}"
        raise type(error)(error.errno, why, str(folder)) from None


def _fingerprint() -> str:
    """Return a short name for the code that makes the library, so that a new version makes a new one."""
    package = Path(__file__).parent.parent
    digest = hashlib.sha256()
    for path in sorted([*package.glob("*.py"), *package.glob("demo/*.py"), *package.glob("building/*.py")]):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def _build(path: Path, progress: Callable[[str, int, int], None]) -> None:
    """Write the clips and their configuration into a temporary folder, and build the library from there."""
    from mlmg_runtime import bvh
    from mlmg_runtime.building.build import build_library
    from mlmg_runtime.building.reading.read_configuration import read_configuration
    from mlmg_runtime.database import write_database
    from mlmg_runtime.demo.clips import demo_clips
    from mlmg_runtime.demo.configuration import demo_configuration

    with tempfile.TemporaryDirectory(prefix="mlmg-demo-") as folder:
        for name, clip in demo_clips().items():
            bvh.write(clip, Path(folder) / f"{name}.bvh")
        configuration = Path(folder) / "library.toml"
        configuration.write_text(demo_configuration(), encoding="utf-8")
        built = build_library(read_configuration(configuration), None, progress)
        write_database(replace(built, configuration=None), path)  # which is gone when this is done
