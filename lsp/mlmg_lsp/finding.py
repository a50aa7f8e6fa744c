"""Which library each text of a client has: looked for while texts are served; what is wrong with it is said once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from mlmg_lang.libraries import SETTINGS
from mlmg_lsp.background import Background
from mlmg_lsp.documents import Documents
from mlmg_lsp.libraries import Shelved
from mlmg_lsp.offering import offer_demo
from mlmg_lsp.open_text import Document
from mlmg_lsp.progress import WorkDoneProgress
from mlmg_lsp.workspace import Workspace
from mlmg_runtime.errors import MlmgError

_NO_LIBRARY: Final = (
    "No library is named, so names are not checked: set `library` in an mlmg.toml beside or above the script, "
    "or in the settings of the editor; `demo` is the demo library."
)


class LibraryFinder:
    """Looks for the libraries of all texts of one client."""

    def __init__(
        self,
        server: LanguageServer,
        workspace: Workspace,
        documents: Documents,
        background: Background,
        found: Callable[[Document, Shelved | None], object],
    ) -> None:
        """Take what speaks to the client, what knows of libraries and texts, and what is to be told.

        Parameters
        ----------
        background : where it is looked for them.
        found : called with a text and its library; with None if it has none, or that cannot be used.
        """
        self._server = server
        self._workspace = workspace
        self._documents = documents
        self._background = background
        self._found = found
        self._said: dict[str, str] = {}

    def look(self, document: Document) -> None:
        """Begin to look for the library of a text; what was begun before stops."""
        if document.finding is not None:
            document.finding.cancel()
        document.finding = self._background.begin(self._find(document))

    def look_for_all(self) -> None:
        """Begin to look for the libraries of all texts."""
        for document in self._documents.all():
            self.look(document)

    async def _find(self, document: Document) -> None:
        bar = WorkDoneProgress(self._server, self._documents.client.progress)
        try:
            shelved = await self._workspace.find(document, bar.report, lambda: bar.begin("Loading the library"))
            if shelved is None:
                self._background.begin(self._tell_of_none(document))
            else:
                self._said = {message: uri for message, uri in self._said.items() if uri != document.uri}
        except Exception as error:  # whatever it is, the text must not be waited for any longer
            shelved = None
            why = error if isinstance(error, MlmgError | OSError) else repr(error)
            message = f"The library cannot be used, so names are not checked: {why}"
            self._say_once(types.MessageType.Warning, message, document)
        finally:
            bar.end()
        self._found(document, shelved)

    async def _tell_of_none(self, document: Document) -> None:
        folder = self._workspace.folder_of(document)
        if not self._documents.client.offers or document.path is None or (folder / SETTINGS).exists():
            self._say_once(types.MessageType.Info, _NO_LIBRARY, document)
        elif _NO_LIBRARY not in self._said:
            self._said[_NO_LIBRARY] = document.uri
            try:
                if await offer_demo(self._server, _NO_LIBRARY, folder):
                    self.look_for_all()
            except OSError as error:
                message = f"{folder / SETTINGS} cannot be written: {error.strerror}"
                self._say_once(types.MessageType.Warning, message, document)

    def _say_once(self, kind: types.MessageType, message: str, document: Document) -> None:
        """Say something that has not been said before, unless the text that it was said of has had a library since."""
        if message not in self._said:
            self._said[message] = document.uri
            self._server.window_show_message(types.ShowMessageParams(kind, message))
