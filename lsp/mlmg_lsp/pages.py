"""Texts that are made to be shown, as files that a client can open, for as long as it is served."""

from __future__ import annotations

import tempfile
import zlib
from pathlib import Path


class Pages:
    """A folder of such files, which is made when it is first needed."""

    def __init__(self) -> None:
        """Begin with none."""
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def write(self, about: str, name: str, text: str) -> Path:
        """Return the file that holds a text.

        Parameters
        ----------
        about : what it tells of, so that files of one name do not stand in for each other.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="mlmg-lsp-", ignore_cleanup_errors=True)
        path = Path(self._folder.name, f"{zlib.crc32(about.encode('utf-8', 'replace')):08x}", name)
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def clear(self) -> None:
        """Take all of them away."""
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None
