"""A file, or standard input -> a source, or why its bytes are no text; and the files that a script uses."""

from __future__ import annotations

import os
import sys
from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.libraries import SETTINGS
from mlmg_lang.source import Source, Span

_HEAD = 200
"""So many bytes at the beginning of a file tell whether it is a clip."""
_MOST_LISTED = 10_000
"""So many files of a folder are looked at for scripts among them."""
_ALLOWING = "`--allow-use FOLDER`, or `mlmg.allowUse` in an editor,"


def read_script(path: str | Path) -> tuple[Source, tuple[Diagnostic, ...]]:
    """Return the text of a script, and a diagnostic if it is no UTF-8, or no script; then that is not to be analysed.

    Parameters
    ----------
    path : of a file; `-` reads standard input. A byte order mark is left out.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    if str(path) == "-":
        return source_from_bytes(sys.stdin.buffer.read(), "<stdin>")
    return source_from_bytes(Path(path).read_bytes(), str(path))


def source_from_bytes(data: bytes, name: str) -> tuple[Source, tuple[Diagnostic, ...]]:
    """Return the text of some bytes, and a diagnostic if they are not UTF-8, or those of a clip."""
    body = data.removeprefix(BOM_UTF8)
    if body[:_HEAD].split()[:2] == [b"HIERARCHY", b"ROOT"]:
        return Source(body[:_HEAD].decode("ascii", errors="replace").lstrip().split("\n", 1)[0], name), (_clip(),)
    try:
        return Source(body.decode("utf-8"), name), ()
    except UnicodeDecodeError as error:
        at = len(body[: error.start].decode("utf-8"))
        return Source(body.decode("utf-8", errors="replace"), name), (_not_utf8(body, error.start, at),)


@dataclass(frozen=True, slots=True)
class UsedFiles:
    """Finds the files that a script uses: from the folder of the file that names them, and not outside of `folders`.

    Attributes
    ----------
    script : the script's name, which its own file keeps.
    folders : absolute, without links.
    place : where a script stands whose name does not say so.
    """

    script: str
    folders: tuple[Path, ...]
    place: Path | None = None

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file, and what is wrong with its bytes; or, in words, why it cannot be used."""
        name = os.path.normpath(self._folder_of(user) / path)
        try:
            real = Path(os.path.realpath(name))
        except ValueError:  # there is a NUL in it, or half a character
            return f"`{path}` cannot be the path of a file"
        if not self._is_allowed(real):
            return f"`{path}` lies outside of the script's own folders; {_ALLOWING} would allow it"
        if real == Path(os.path.realpath(self.script)):
            name = self.script
        try:
            if real.exists() and not real.is_file():
                return f"`{path}` is not a file"
            return source_from_bytes(real.read_bytes(), name)
        except FileNotFoundError:
            return f"there is no file `{path}`{_alike(real)}"
        except OSError as error:
            return f"`{path}` cannot be read: {error.strerror}"

    def paths(self, begun: str, user: str) -> tuple[str, ...]:
        """Return the other scripts of the folder that the beginning of a path leads to, named as that begins."""
        folder = begun[: begun.rfind("/") + 1]
        place = self._folder_of(user) / folder
        own = os.path.realpath(self.place or self.script)
        try:
            if not self._is_allowed(Path(os.path.realpath(place))):
                return ()
            with os.scandir(place) as entries:
                listed = [one for one in islice(entries, _MOST_LISTED) if one.name.endswith(".ms") and one.is_file()]
        except (OSError, ValueError):
            return ()
        return tuple(sorted(f"{folder}{one.name}" for one in listed if os.path.realpath(one.path) != own))

    def _folder_of(self, user: str) -> Path:
        place = self.place if self.place is not None and user == self.script else Path(user)
        return place.parent

    def _is_allowed(self, real: Path) -> bool:
        return any(real.is_relative_to(folder) for folder in self.folders)


def used_files(script: str | Path, allowed: Sequence[str | Path] = ()) -> UsedFiles:
    """Return what finds the files that a script uses.

    They may lie in the script's folder, or in that of the nearest `mlmg.toml` above it, and below.

    Parameters
    ----------
    script : its path; `-` is taken to stand in the current folder.
    allowed : further folders.
    """
    folder = Path(os.path.realpath(os.curdir if str(script) == "-" else Path(script).parent))
    settings = next((place for place in (folder, *folder.parents) if (place / SETTINGS).is_file()), folder)
    return UsedFiles(str(script), (settings, *(Path(os.path.realpath(other)) for other in allowed)))


def _alike(missing: Path) -> str:
    """Return what to say of files with nearly the name of one that is missing."""
    from mlmg_lang.spelling import nearest

    try:
        near = nearest(missing.name, sorted(other.name for other in missing.parent.glob("*.ms")), limit=1)
    except OSError:
        near = ()
    return f"; there is `{near[0]}`" if near else ""


def _clip() -> Diagnostic:
    message = "this is a clip (BVH), not a script: it begins with `HIERARCHY`"
    advice = "a script says what is to be seen, as in `WALK for 10 sec`; `mlmg build` makes a library of clips"
    return Diagnostic("MS008", message, Span(0, len("HIERARCHY")), advice)


def _not_utf8(data: bytes, first: int, at: int) -> Diagnostic:
    message = f"this file is not UTF-8: byte 0x{data[first]:02X} cannot stand here"
    utf16 = data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))
    advice = "it looks like UTF-16; save it as UTF-8" if utf16 else "save it as UTF-8"
    return Diagnostic("MS001", message, Span(at, at + 1), advice)
