"""The errors that the runtime raises, each with the file and line that a person has to look at."""

from __future__ import annotations

from pathlib import Path


class MlmgError(Exception):
    """What went wrong, where, and what to do, in one sentence that a person can act on."""


class ShapeError(MlmgError, ValueError):
    """An array has another shape than asked for."""


class FileError(MlmgError):
    """A file whose content is wrong.

    Parameters
    ----------
    path : the file, as the person named it.
    line : the line that is wrong, from 1, or None where the file as a whole is.
    message : what was found and what was expected.
    """

    def __init__(self, path: str | Path, line: int | None, message: str) -> None:
        """Say what is wrong where."""
        self.path = str(path)
        self.line = line
        self.message = message
        where = self.path if line is None else f"{self.path}:{line}"
        super().__init__(f"{where}: {message}")


class BvhError(FileError):
    """A BVH file that cannot be read."""


class ConfigurationError(FileError):
    """A library configuration (TOML) that cannot be used."""


class LibraryError(FileError):
    """A built library that cannot be opened, or clips that do not fit together."""


class PlayError(MlmgError):
    """A library does not allow what is to be played."""
