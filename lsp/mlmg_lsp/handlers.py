"""What answers, or takes, each message of a client."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified
from pygls.lsp.server import LanguageServer

from mlmg_lsp.features import (
    ASKED_AGAIN,
    EDITING,
    FEATURES,
    INLAY_HINT,
    OF_A_PLACE,
    OF_ALL_TEXTS,
    RESOLVING,
    WORKSPACE_SYMBOL,
    answer_named,
)
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.session import ClientSession
from mlmg_lsp.work import off_loop


def register(server: LanguageServer, session: ClientSession) -> None:
    """Let a server hand on what its client tells and asks."""
    handed_on: tuple[tuple[str, Callable[[Any], Any]], ...] = (
        (types.INITIALIZED, session.begun),
        (types.TEXT_DOCUMENT_DID_OPEN, session.opened),
        (types.TEXT_DOCUMENT_DID_CHANGE, session.changed),
        (types.TEXT_DOCUMENT_DID_SAVE, session.saved),
        (types.TEXT_DOCUMENT_DID_CLOSE, session.closed),
        (types.WORKSPACE_DID_CHANGE_CONFIGURATION, session.settings_changed),
        (types.WORKSPACE_DID_CHANGE_WATCHED_FILES, session.files_changed),
        (types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS, session.folders_changed),
        (types.WORKSPACE_EXECUTE_COMMAND, session.executor.execute),
    )
    for method, handler in handed_on:
        server.feature(method)(partial(handler))  # pygls writes on what it is given, which methods do not let it do
    for method, options, name in FEATURES:
        answering = _of_all_texts_at if name in OF_ALL_TEXTS else _of_text
        server.feature(method, options)(answering(session, name))
    for method, name in RESOLVING:
        server.feature(method)(_of_item(session, name))
    server.feature(types.TEXT_DOCUMENT_INLAY_HINT)(_of_hints(session))
    server.feature(types.WORKSPACE_SYMBOL)(_of_all_texts(session))


def _of_text(session: ClientSession, name: str) -> Callable[[Any], Any]:
    """Return what answers a request about a text, off the thread that reads messages."""

    async def handler(params: Any) -> Any:
        is_early = ASKED_AGAIN.get(name) in session.documents.client.refreshed
        line = _last_line(params) if is_early or name in OF_A_PLACE else None
        snapshot = await session.snapshot(params.text_document.uri, line)
        return await _answer(session, name, snapshot, params)

    return handler


def _of_all_texts_at(session: ClientSession, name: str) -> Callable[[Any], Any]:
    """Return what answers a request about a place by all open texts, and by closed ones that use the same file."""

    async def handler(params: Any) -> Any:
        await session.documents.all_read()
        snapshot = await session.snapshot(params.text_document.uri)
        users = await session.closed_users(snapshot, params)
        return await _answer(session, name, snapshot, params, users)

    return handler


def _of_hints(session: ClientSession) -> Callable[[Any], Any]:
    """Return what answers for hints: with what is foreseen of the text, if that is wanted."""

    async def handler(params: types.InlayHintParams) -> Any:
        snapshot = await session.snapshot(params.text_document.uri)
        kinds = session.workspace.settings.hints
        outlook = await session.foresight.of(snapshot) if kinds & {"motions", "arrivals"} else None
        return await _answer(session, INLAY_HINT, snapshot, params, outlook, kinds)

    return handler


def _of_all_texts(session: ClientSession) -> Callable[[Any], Any]:
    """Return what looks for names in all open texts; one that is edited meanwhile is left out."""

    async def handler(params: types.WorkspaceSymbolParams) -> Any:
        snapshots = []
        for document in session.documents.all():
            with suppress(JsonRpcContentModified):
                snapshots.append(await session.snapshot(document.uri))
        return await off_loop(lambda: answer_named(WORKSPACE_SYMBOL)(snapshots, params))

    return handler


def _of_item(session: ClientSession, name: str) -> Callable[[Any], Any]:
    """Return what adds to an item that was answered before; it says itself of which text it is."""

    async def handler(item: Any) -> Any:
        uri = item.data.get("uri") if isinstance(item.data, dict) else None
        if not isinstance(uri, str):
            return item
        snapshot = await session.snapshot(uri, 0 if name in OF_A_PLACE else None)
        return await _answer(session, name, snapshot, item)

    return handler


async def _answer(session: ClientSession, name: str, snapshot: Snapshot, *asked: Any) -> Any:
    """Return what is answered of a text.

    Raises
    ------
    JsonRpcContentModified
        If these are edits, and what they are for has been edited meanwhile.
    """
    answer = await off_loop(lambda: answer_named(name)(snapshot, *asked))
    if name in EDITING and not session.documents.is_current(snapshot, name in OF_ALL_TEXTS):
        raise JsonRpcContentModified(f"{snapshot.uri} has changed")
    return answer


def _last_line(params: Any) -> int:
    """Return the last line that a request is about; the first if it names none."""
    places = (getattr(params, "position", None), getattr(getattr(params, "range", None), "end", None))
    return max((place.line for place in places if place is not None), default=0)
