"""The server of one client: what is to be done with each message, and by which feature it is answered."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified, JsonRpcException, JsonRpcInternalError
from pygls.lsp.server import LanguageServer

from mlmg_lang.libraries import SETTINGS
from mlmg_lsp.client import client_from
from mlmg_lsp.documents import Document, Documents, Snapshot, Superseded, path_of
from mlmg_lsp.executing import Executor
from mlmg_lsp.features import (
    COMMANDS,
    FEATURES,
    HINTS_AHEAD,
    INLAY_HINT,
    RESOLVING,
    WORKSPACE_SYMBOL,
    answer_named,
    get_ahead,
    warm,
)
from mlmg_lsp.foresight import Foresight
from mlmg_lsp.libraries import Shelf
from mlmg_lsp.offering import offer_demo
from mlmg_lsp.progress import Bar
from mlmg_lsp.protocol import Protocol
from mlmg_lsp.telling import Telling
from mlmg_lsp.work import off_loop
from mlmg_lsp.workspace import Settings, Workspace, folders_of
from mlmg_runtime.errors import MlmgError

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.ide.hints import Outlook

_SECTION: Final = "mlmg"
_WATCHED: Final = ("**/*.ms", "**/*.mlmg", "**/library.toml", f"**/{SETTINGS}")
_LOOKED_FOR_S: Final = 3.0
"""So often it is looked whether the client is still there, if it has said which process it is."""
_NO_LIBRARY: Final = (
    "No library is named, so names are not checked: set `library` in an mlmg.toml beside or above the script, "
    "or in the settings of the editor; `demo` is the demo library."
)


class MotionScriptServer(LanguageServer):
    """Serves one client.

    Attributes
    ----------
    encoding : what the client counts characters in, if it does not say so.
    ended : set when the client has ended it, or is no longer there. orderly : whether it has said that it would.
    """

    protocol: Protocol

    def __init__(self, settings: Settings, shelf: Shelf) -> None:
        """Take the settings of the command, and the libraries that are open in this process."""
        super().__init__("mlmg lsp", version("mlmg"), protocol_cls=Protocol)
        self.encoding = settings.encoding
        self.ended = asyncio.Event()
        self.orderly = False
        self.folders = Workspace(settings, shelf)
        self.documents = Documents(self._files_of, self._publish, warm, get_ahead)
        self.telling = Telling(self._tell)
        self.foresight = Foresight(self._get_hints, lambda: self._refresh("inlay_hint"), self._foresight_failed)
        self.executor = Executor(self, self.documents, self.snapshot)
        self._said: set[str] = set()
        self._uris: dict[str, str] = {}
        self._tasks: set[asyncio.Future[Any]] = set()

    def _files_of(self, document: Document) -> Files:
        return self.folders.files(document, self.documents)

    # --- as a transport sees it ---

    def connect(self, send: Callable[[bytes], object], headers: bool) -> None:
        """Take what sends a message."""
        self.protocol.set_writer(_Writer(send), headers)

    def receive(self, body: bytes | str) -> None:
        """Take a message; one that is not well-formed is passed over."""
        self.protocol.receive(body)

    def leave(self) -> None:
        """Let go of all."""
        self.documents.close_all()
        self.foresight.end()
        self.executor.end()
        for task in list(self._tasks):
            task.cancel()

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Write a failure of our own into the client's log; what a client asks for in vain is no failure."""
        if isinstance(error, JsonRpcInternalError):
            self.window_log_message(types.LogMessageParams(types.MessageType.Error, f"{error.message}\n{error.data}"))

    # --- the beginning ---

    def begin(self, params: types.InitializeParams) -> None:
        """Take in what the client says of itself."""
        self.documents.client = client_from(params.capabilities)
        for uri in folders_of(params):
            self.folders.add(uri)
        self.folders.set_client(params.initialization_options)
        if params.process_id is not None and sys.platform != "win32":
            self._soon(self._watch_client(params.process_id))

    def fit(self, capabilities: types.ServerCapabilities) -> None:
        """Tell of commands; and not of answering for diagnostics where a client is told of them unasked."""
        capabilities.execute_command_provider = types.ExecuteCommandOptions(list(COMMANDS), work_done_progress=True)
        if not self.documents.client.pulls:
            capabilities.diagnostic_provider = None

    def begun(self, _params: types.InitializedParams) -> None:
        """Get ready, and ask the client for what it can be asked for."""
        self._soon(self.documents.warm())
        if self.documents.client.watches:
            self._soon(self._ask_to_watch())
        if self.documents.client.configuration:
            self._soon(self._ask_for_settings())

    async def _ask_to_watch(self) -> None:
        watchers = [types.FileSystemWatcher(pattern) for pattern in _WATCHED]
        options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
        method = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
        await self.client_register_capability_async(
            types.RegistrationParams([types.Registration("watched", method, options)])
        )

    async def _ask_for_settings(self) -> None:
        items = [types.ConfigurationItem(section=_SECTION)]
        found = await self.workspace_configuration_async(types.ConfigurationParams(items))
        if found and found[0] is not None:
            self.set_settings(found[0])

    async def _watch_client(self, process: int) -> None:
        while not self.ended.is_set():
            try:
                os.kill(process, 0)
            except ProcessLookupError:
                self.ended.set()
            except PermissionError:
                pass  # it is there, and another user's
            await asyncio.sleep(_LOOKED_FOR_S)

    # --- texts ---

    def opened(self, params: types.DidOpenTextDocumentParams) -> None:
        """Take in a text."""
        document = self.documents.open(params.text_document)
        self._uris[document.name] = document.uri
        self._find_library(document)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Edit a text, and look again at those that use it."""
        self.foresight.stop(params.text_document.uri)
        document = self.documents.change(params)
        if document is not None and document.path is not None:
            self._used_changed(document.path)

    def saved(self, params: types.DidSaveTextDocumentParams) -> None:
        """Look whether a library is another by now: not all clients tell of that."""
        document = self.documents.get(params.text_document.uri)
        if document is not None:
            self._find_library(document)

    def closed(self, params: types.DidCloseTextDocumentParams) -> None:
        """Let go of a text, with what was said of it."""
        uri = params.text_document.uri
        document = self.documents.get(uri)
        self.documents.close(uri)
        self.foresight.forget(uri)
        if document is not None:
            self.telling.forget(document.name, self.documents.client.pulls)
        path = path_of(uri)
        if path is not None:
            self._used_changed(path)

    def _used_changed(self, path: Path) -> None:
        """Look again at the texts that use a file."""
        users = list(self.documents.users(path))
        for document in users:
            self.documents.analyse(document, afresh=True)
        if users:
            self._refresh()

    # --- libraries and settings ---

    def settings_changed(self, params: types.DidChangeConfigurationParams) -> None:
        """Take the settings that the client sends; one that can be asked for them may send none."""
        if self.documents.client.configuration:
            self._soon(self._ask_for_settings())
        else:
            self.set_settings(params.settings)

    def set_settings(self, settings: Any) -> None:
        """Take the settings of the client."""
        before = self.folders.settings
        self.folders.set_client(settings)
        now = self.folders.settings
        if now.hints != before.hints:
            self._refresh("inlay_hint")
        if replace(now, hints=before.hints) != before:
            self._look_again()
            for document in self.documents.all():
                self.documents.reconsider(document)
            self._refresh()

    def files_changed(self, params: types.DidChangeWatchedFilesParams) -> None:
        """Look again at what files that have changed have to do with."""
        paths = [path for change in params.changes if (path := path_of(change.uri)) is not None]
        if any(path.suffix != ".ms" for path in paths):
            self._look_again()
        for path in paths:
            if path.suffix == ".ms":
                self._used_changed(path)
        if any(change.type == types.FileChangeType.Created for change in params.changes):
            self._found_missing()

    def folders_changed(self, params: types.DidChangeWorkspaceFoldersParams) -> None:
        """Open and close folders."""
        for folder in params.event.added:
            self.folders.add(folder.uri)
        for folder in params.event.removed:
            self.folders.remove(folder.uri)
        self._look_again()

    def _found_missing(self) -> None:
        """Look again at texts that use a file which was not there."""
        for document in self.documents.all():
            if document.analysis is not None and not document.analysis.definitions.complete:
                self.documents.analyse(document, afresh=True)
        self._refresh()

    def _look_again(self) -> None:
        for document in self.documents.all():
            self._find_library(document)

    def _find_library(self, document: Document) -> None:
        if document.finding is not None:
            document.finding.cancel()
        document.finding = self._soon(self._find(document))

    async def _find(self, document: Document) -> None:
        bar = Bar(self, self.documents.client.progress)
        try:
            shelved = await self.folders.find(document, bar.report, lambda: bar.begin("Loading the library"))
            if shelved is None:
                self._soon(self._tell_no_library(document))
            else:
                self._said.clear()
        except (MlmgError, OSError) as error:
            shelved = None
            self._say_once(types.MessageType.Warning, f"The library cannot be used, so names are not checked: {error}")
        finally:
            bar.end()
        is_another = shelved is not document.shelved
        document.shelved = shelved
        if is_another:  # what is kept would keep the other library, which may be large
            document.kept = {}
            self.foresight.end()
        document.found.set()
        if is_another and document.begun:
            self.documents.analyse(document, afresh=True)
            self._refresh()

    async def _tell_no_library(self, document: Document) -> None:
        folder = self.folders.folder_of(document)
        if not self.documents.client.offers or document.path is None or (folder / SETTINGS).exists():
            self._say_once(types.MessageType.Info, _NO_LIBRARY)
        elif _NO_LIBRARY not in self._said:
            self._said.add(_NO_LIBRARY)
            try:
                if await offer_demo(self, _NO_LIBRARY, folder):
                    self._look_again()
            except OSError as error:
                self._say_once(types.MessageType.Warning, f"{folder / SETTINGS} cannot be written: {error.strerror}")

    def _say_once(self, kind: types.MessageType, message: str) -> None:
        if message not in self._said:
            self._said.add(message)
            self.window_show_message(types.ShowMessageParams(kind, message))

    # --- what the client is told of unasked ---

    async def _publish(self, document: Document) -> None:
        """Tell the client what there is to say of a text, if it does not ask, and of the files that the text uses."""
        if document.analysis is None:
            return
        client, version = self.documents.client, document.version
        snapshot = Snapshot(document.uri, version, document.analysis, document.shelved, client, self.documents.opened())
        from mlmg_lsp.convert import diagnostics_of, diagnostics_of_used

        own, used = await off_loop(lambda: (diagnostics_of(snapshot), diagnostics_of_used(snapshot)))
        self.telling.take(document.name, version, own, used, client.pulls)

    def _tell(self, name: str, found: list[types.Diagnostic], version: int | None) -> None:
        uri = self._uris[name] if name in self._uris else Path(name).as_uri()
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, found, version=version))

    def _get_hints(self, snapshot: Snapshot, outlook: Outlook) -> None:
        answer_named(HINTS_AHEAD)(snapshot, outlook, self.folders.settings.hints)

    def _foresight_failed(self, error: Exception) -> None:
        message = f"What commands will play cannot be foreseen: {error!r}"
        self.window_log_message(types.LogMessageParams(types.MessageType.Warning, message))

    def _refresh(self, *names: str) -> None:
        """Let a client ask again for what it has asked for before, of all texts: for these, or all that there is."""
        asking = {
            "diagnostics": self.workspace_diagnostic_refresh_async,
            "code_lens": self.workspace_code_lens_refresh_async,
            "inlay_hint": self.workspace_inlay_hint_refresh_async,
            "semantic_tokens": self.workspace_semantic_tokens_refresh_async,
        }
        for name, ask in asking.items():
            if name in self.documents.client.refreshed and (not names or name in names):
                self._soon(ask(None))

    # --- requests ---

    async def execute(self, params: types.ExecuteCommandParams) -> Any:
        """Execute a command; see `executing`."""
        return await self.executor.execute(params)

    async def snapshot(self, uri: str) -> Snapshot:
        """Return an open text with all that is known of it.

        Raises
        ------
        JsonRpcContentModified
            If the text is edited before that is known, or is not open.
        """
        try:
            return await self.documents.snapshot(uri)
        except Superseded as error:
            raise JsonRpcContentModified(str(error)) from None

    def _soon(self, work: Coroutine[Any, Any, Any]) -> asyncio.Task[Any]:
        """Begin some work that goes on by itself; a client that does not do as asked is no failure of it."""

        async def done() -> None:
            with suppress(JsonRpcException, ConnectionError):
                await work

        task = asyncio.ensure_future(done())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda _: work.close())  # it may have been cancelled before it began
        return task


class _Writer:
    """What pygls sends by."""

    def __init__(self, send: Callable[[bytes], object]) -> None:
        self._send = send

    def write(self, data: bytes | str) -> None:
        self._send(data.encode("utf-8") if isinstance(data, str) else data)

    def close(self) -> None:
        """Do nothing: transports close what they have opened."""


def build_server(settings: Settings, shelf: Shelf) -> MotionScriptServer:
    """Return a server with all its features, for one client."""
    server = MotionScriptServer(settings, shelf)
    told: tuple[tuple[str, Callable[[Any], None]], ...] = (
        (types.INITIALIZE, server.begin),
        (types.INITIALIZED, server.begun),
        (types.TEXT_DOCUMENT_DID_SAVE, server.saved),
        (types.WORKSPACE_DID_CHANGE_CONFIGURATION, server.settings_changed),
        (types.WORKSPACE_DID_CHANGE_WATCHED_FILES, server.files_changed),
        (types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS, server.folders_changed),
    )
    for method, take in told:
        server.feature(method)(partial(take))  # pygls writes on what it is given, which methods do not let it do
    for method, options, name in FEATURES:
        server.feature(method, options)(_of_text(server, name))
    for method, name in RESOLVING:
        server.feature(method)(_of_item(server, name))
    server.feature(types.TEXT_DOCUMENT_INLAY_HINT)(_of_hints(server))
    server.feature(types.WORKSPACE_SYMBOL)(_of_all_texts(server))
    return server


def _of_text(server: MotionScriptServer, name: str) -> Callable[[Any], Any]:
    """Return what answers a request about a text, off the thread that reads messages."""

    async def handler(params: Any) -> Any:
        snapshot = await server.snapshot(params.text_document.uri)
        return await off_loop(lambda: answer_named(name)(snapshot, params))

    return handler


def _of_hints(server: MotionScriptServer) -> Callable[[Any], Any]:
    """Return what answers for hints: with what is foreseen of the text, if that is wanted."""

    async def handler(params: types.InlayHintParams) -> Any:
        snapshot = await server.snapshot(params.text_document.uri)
        kinds = server.folders.settings.hints
        outlook = await server.foresight.of(snapshot) if kinds & {"motions", "arrivals"} else None
        return await off_loop(lambda: answer_named(INLAY_HINT)(snapshot, params, outlook, kinds))

    return handler


def _of_all_texts(server: MotionScriptServer) -> Callable[[Any], Any]:
    """Return what looks for names in all open texts; one that is edited meanwhile is left out."""

    async def handler(params: types.WorkspaceSymbolParams) -> Any:
        snapshots = []
        for document in server.documents.all():
            with suppress(JsonRpcContentModified):
                snapshots.append(await server.snapshot(document.uri))
        return await off_loop(lambda: answer_named(WORKSPACE_SYMBOL)(snapshots, params))

    return handler


def _of_item(server: MotionScriptServer, name: str) -> Callable[[Any], Any]:
    """Return what adds to an item that was answered before; it says itself of which text it is."""

    async def handler(item: Any) -> Any:
        uri = item.data.get("uri") if isinstance(item.data, dict) else None
        if not isinstance(uri, str):
            return item
        snapshot = await server.snapshot(uri)
        return await off_loop(lambda: answer_named(name)(snapshot, item))

    return handler
