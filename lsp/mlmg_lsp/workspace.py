"""The folders of a client and its settings -> which library each text has, and which files it can use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mlmg_lang.libraries import DEMO, Progress, find_library
from mlmg_lsp.libraries import Shelf, Shelved
from mlmg_lsp.open_text import Document, path_of
from mlmg_lsp.positions import Encoding
from mlmg_lsp.reading import OpenFiles
from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from lsprotocol import types

    from mlmg_lang.definitions.gather import Files

HINTS: Final = frozenset({"motions", "arrivals", "units", "parameters"})
"""The kinds of hints, by the names of their settings, which `ide.hints.Kind` has too."""


@dataclass(frozen=True, slots=True)
class Settings:
    """What is set by options of the command, or by the client.

    Attributes
    ----------
    library : the path of a library, from the folder that a script is in the workspace by; or `demo`.
    allowed : folders outside, from which scripts may use files.
    encoding : what a client counts characters in that does not say so; only the command can set it.
    hints : the kinds of hints that are wanted.
    """

    library: str | None = None
    allowed: tuple[str, ...] = ()
    encoding: Encoding = "utf-16"
    hints: frozenset[str] = HINTS

    def with_those_of(self, client: Any) -> Settings:
        """Return settings with those that a client has sent in the place of its others.

        What it does not name stays; what is not as it should be counts as if it were empty.
        """
        own = client.get("mlmg", client) if isinstance(client, Mapping) else {}
        if not isinstance(own, Mapping):
            return self
        library, allowed = own.get("library", self.library), own.get("allowUse", list(self.allowed))
        folders = tuple(map(str, allowed)) if isinstance(allowed, list) else ()
        named = library if isinstance(library, str) and library else None
        return Settings(named, folders, hints=_hints(own) if "inlayHints" in own else self.hints)

    def over(self, others: Settings) -> Settings:
        """Return settings in which these come before others."""
        hints = self.hints & others.hints
        return Settings(self.library or others.library, (*self.allowed, *others.allowed), self.encoding, hints)


def _hints(own: Mapping[str, Any]) -> frozenset[str]:
    """Return the kinds of hints that a client has not switched off."""
    switches = own.get("inlayHints")
    return frozenset(kind for kind in HINTS if not isinstance(switches, Mapping) or switches.get(kind) is not False)


class Workspace:
    """The folders that are open in a client.

    Attributes
    ----------
    given : the settings of the command. settings : with those of the client.
    """

    def __init__(self, given: Settings, shelf: Shelf) -> None:
        """Take the settings of the command, and the libraries that are open."""
        self.given = given
        self.settings = given
        self._client = Settings()
        self.shelf = shelf
        self._roots: dict[str, Path] = {}

    def set_client(self, settings: Any) -> None:
        """Take the settings of the client."""
        self._client = self._client.with_those_of(settings)
        self.settings = self.given.over(self._client)

    def add(self, uri: str) -> None:
        """Open a folder."""
        path = path_of(uri)
        if path is not None:
            self._roots[uri] = path

    def remove(self, uri: str) -> None:
        """Close a folder."""
        self._roots.pop(uri, None)

    def place_of(self, document: Document) -> Path:
        """Return the path of a text, or where one without would be."""
        if document.path is not None:
            return document.path
        return next(iter(self._roots.values()), Path.cwd()) / "untitled.ms"

    def files(self, document: Document, text_of: Callable[[str], str | None]) -> Files:
        """Return what finds the files that a text uses; `text_of` has the texts of those that are open."""
        from mlmg_lang.script_files import used_files

        place = self.place_of(document)
        found = used_files(place, self.settings.allowed)
        return OpenFiles(replace(found, script=document.name, place=place), text_of)

    def files_on_disk(self, script: Path) -> Files:
        """Return what finds the files that a script uses which is not open."""
        from mlmg_lang.script_files import used_files

        return used_files(script, self.settings.allowed)

    async def find(self, document: Document, progress: Progress, loading: Callable[[], object]) -> Shelved | None:
        """Return the library of a text, opened; None if nothing names one.

        Parameters
        ----------
        progress : told, in another thread, how far the demo library is built.
        loading : called before a library is opened that is not open yet.

        Raises
        ------
        mlmg_runtime.errors.MlmgError
            If what names it, or the library itself, is not as it should be.
        OSError
            If a file cannot be read.
        """
        place, option = self.place_of(document), self._option(document)
        # Whole, as it imports what builds the demo library.
        path = await off_loop(lambda: find_library(place, option, progress), is_whole=True)
        if path is None:
            return None
        if not self.shelf.has(path):
            loading()
        return await self.shelf.get(path)

    def _option(self, document: Document) -> Path | str | None:
        """Return the library that is set, as a path from the folder that a text is in the workspace by."""
        named = self.settings.library
        if named is None or named == DEMO:
            return named
        if self.given.library is not None:
            return Path.cwd() / named
        return self.folder_of(document) / named

    def folder_of(self, document: Document) -> Path:
        """Return the folder that a text is in the workspace by; without one, that in which it is."""
        return self._folder(self.place_of(document))

    def folders_around(self, *files: Path) -> tuple[Path, ...]:
        """Return the folders of the workspace; for files that lie in none, those too in which they are.

        All of a file system is nobody's folder of scripts.
        """
        own = (folder for folder in map(self._folder, files) if folder != folder.parent)
        return tuple(dict.fromkeys((*self._roots.values(), *own)))

    def _folder(self, place: Path) -> Path:
        own = [root for root in self._roots.values() if place.is_relative_to(root)]
        return max(own, key=lambda root: len(root.parts), default=place.parent)


def folders_of(params: types.InitializeParams) -> list[str]:
    """Return the URIs of the folders that a client begins with."""
    if params.workspace_folders:
        return [folder.uri for folder in params.workspace_folders]
    if params.root_uri:
        return [params.root_uri]
    return [Path(params.root_path).absolute().as_uri()] if params.root_path else []
