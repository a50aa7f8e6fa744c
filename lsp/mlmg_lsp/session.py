"""What is open in one client, and what is done where the client tells that it has changed."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified
from pygls.lsp.server import LanguageServer

from mlmg_lsp.background import Background
from mlmg_lsp.client import client_from
from mlmg_lsp.client_requests import ClientRequests
from mlmg_lsp.closed import ClosedScripts, Dependents
from mlmg_lsp.documents import Documents
from mlmg_lsp.executing import Executor
from mlmg_lsp.features import FEATURES, get_ahead, warm
from mlmg_lsp.finding import LibraryFinder
from mlmg_lsp.foresight import Foresight
from mlmg_lsp.libraries import Shelf, Shelved
from mlmg_lsp.open_text import Document, Snapshot, Superseded, path_of
from mlmg_lsp.publishing import DiagnosticsPublisher
from mlmg_lsp.work import off_loop
from mlmg_lsp.workspace import Settings, Workspace, folders_of

if TYPE_CHECKING:
    from mlmg_lang.ide.hints import Outlook


class ClientSession:
    """Brings together all that is there for one client.

    Attributes
    ----------
    background : what goes on by itself for it, which ends with it.
    """

    def __init__(self, server: LanguageServer, settings: Settings, shelf: Shelf) -> None:
        """Take what speaks to the client, the settings of the command, and the libraries that are open."""
        self._server = server
        self.background = Background()
        self.workspace = Workspace(settings, shelf)
        self._closed = ClosedScripts(self.workspace.files_on_disk)
        self._publisher = DiagnosticsPublisher(server)
        self.documents = Documents(self.workspace.files, self._publisher.tell, warm, get_ahead, self._is_whole)
        self._requests = ClientRequests(server, self.documents, self.background)
        self._finder = LibraryFinder(server, self.workspace, self.documents, self.background, self._take_library)
        self.foresight = Foresight(
            self._get_hints, partial(self._requests.refresh, "inlay_hint"), self._tell_not_foreseen
        )
        self.executor = Executor(server, self.documents, self.snapshot, self.background)

    # --- beginning and end ---

    def begin(self, params: types.InitializeParams) -> None:
        """Take in what the client says of itself."""
        self.documents.client = client_from(params.capabilities)
        for uri in folders_of(params):
            self.workspace.add(uri)
        self.workspace.set_client(params.initialization_options)

    def begun(self, _params: types.InitializedParams) -> None:
        """Get ready, and ask the client for what it can be asked for."""
        self.background.begin(self.documents.warm())
        self._requests.watch_files()
        self._requests.tell_settings(self._set_settings)

    def end(self) -> None:
        """Let go of all."""
        self.documents.close_all()
        self.foresight.end()
        self.executor.end()
        self.background.end()

    # --- texts ---

    async def snapshot(self, uri: str, line: int | None = None) -> Snapshot:
        """Return an open text with all that is known of it.

        Parameters
        ----------
        line : where a beginning of the text will do, a line that it has.

        Raises
        ------
        JsonRpcContentModified
            If the text is edited before that is known, or is not open.
        """
        try:
            return await self.documents.snapshot(uri, line)
        except Superseded as error:
            raise JsonRpcContentModified(str(error)) from None

    async def closed_users(self, snapshot: Snapshot, params: Any) -> Dependents:
        """Return the scripts that are not open and use the file which defines the name at a place."""

        def look() -> Dependents:
            from mlmg_lsp.features.navigation import home_of

            home = home_of(snapshot, params)
            if home is None:
                return Dependents()
            own = path_of(snapshot.uri)
            folders = self.workspace.folders_around(home, *(() if own is None else (own,)))
            return self._closed.users(str(home), folders, snapshot)

        users = await off_loop(look)
        if users.left_out:
            message = f"Not all scripts were looked at. Left out: {users.left_out}."
            self._server.window_show_message(types.ShowMessageParams(types.MessageType.Warning, message))
        return users

    def opened(self, params: types.DidOpenTextDocumentParams) -> None:
        """Take in a text, and look again at those that use it if it is another than what they have read."""
        document = self.documents.open(params.text_document)
        self._publisher.opened(document.name, document.uri)
        self._finder.look(document)
        outdated = [] if document.path is None else self.documents.outdated_users(document.path)
        self._look_again([*outdated, *self.documents.incomplete()])

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Edit a text, and look again at those that use it."""
        self.foresight.stop(params.text_document.uri)
        document = self.documents.change(params)
        if document is not None and document.path is not None:
            self._used_changed(document.path)

    def saved(self, params: types.DidSaveTextDocumentParams) -> None:
        """Look whether a library is another, or a file is there by now: not all clients tell of that."""
        document = self.documents.get(params.text_document.uri)
        if document is not None:
            self._finder.look(document)
        self._look_again(self.documents.incomplete())

    def closed(self, params: types.DidCloseTextDocumentParams) -> None:
        """Let go of a text, with what was said of it."""
        uri = params.text_document.uri
        document = self.documents.get(uri)
        self.documents.close(uri)
        self.foresight.forget(uri)
        self.foresight.keep(one.shelved for one in self.documents.all())
        if document is not None:
            self._publisher.forget(document.name, self.documents.client.pulls)
        path = path_of(uri)
        if path is not None:
            self._used_changed(path)
        self._look_again(self.documents.incomplete())

    # --- settings, files and folders ---

    def settings_changed(self, params: types.DidChangeConfigurationParams) -> None:
        """Take the settings that the client sends; one that can be asked for them may send none."""
        if self.documents.client.configuration:
            self._requests.tell_settings(self._set_settings)
        else:
            self._set_settings(params.settings)

    def files_changed(self, params: types.DidChangeWatchedFilesParams) -> None:
        """Look again at what files that have changed have to do with."""
        paths = [path for change in params.changes if (path := path_of(change.uri)) is not None]
        if any(path.suffix != ".ms" for path in paths):
            self._finder.look_for_all()
        for path in paths:
            if path.suffix == ".ms":
                self._used_changed(path)
        self._look_again(self.documents.incomplete())

    def folders_changed(self, params: types.DidChangeWorkspaceFoldersParams) -> None:
        """Open and close folders."""
        for folder in params.event.added:
            self.workspace.add(folder.uri)
        for folder in params.event.removed:
            self.workspace.remove(folder.uri)
        self._finder.look_for_all()

    # --- what follows from that ---

    def _set_settings(self, settings: Any) -> None:
        before = self.workspace.settings
        self.workspace.set_client(settings)
        now = self.workspace.settings
        if now.hints != before.hints:
            self._requests.refresh("inlay_hint")
        if replace(now, hints=before.hints) != before:
            self._finder.look_for_all()
            for document in self.documents.all():
                self.documents.reconsider(document)
            self._requests.refresh()

    def _is_whole(self) -> None:
        """Let the client ask again for what has been answered by a beginning."""
        self._requests.refresh(*(feature.refreshed for feature in FEATURES if feature.refreshed))

    def _take_library(self, document: Document, shelved: Shelved | None) -> None:
        """Look again at a text that has another library than before."""
        is_another = shelved is not document.shelved
        document.shelved = shelved
        if is_another:  # what is kept would keep the other library, which may be large
            document.kept = {}
            self.foresight.forget(document.uri)
            self.foresight.keep(one.shelved for one in self.documents.all())
        document.found.set()
        if is_another and document.begun:
            self.documents.analyse(document, afresh=True)
            self._requests.refresh()

    def _used_changed(self, path: Path) -> None:
        """Look again at the texts that use a file."""
        self._look_again(self.documents.users_of_changed(path))

    def _look_again(self, users: list[Document]) -> None:
        for document in users:
            self.documents.analyse(document, afresh=True)
        if users:
            self._requests.refresh()

    def _get_hints(self, snapshot: Snapshot, outlook: Outlook) -> None:
        from mlmg_lsp.features import inlay_hint

        inlay_hint.get_ahead(snapshot, outlook, self.workspace.settings.hints)

    def _tell_not_foreseen(self, error: Exception) -> None:
        message = f"What commands will play cannot be foreseen: {error!r}"
        self._server.window_log_message(types.LogMessageParams(types.MessageType.Warning, message))
