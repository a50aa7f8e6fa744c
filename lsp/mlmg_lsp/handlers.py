"""What answers, or takes, each message of a client."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any, Final, TypeAlias

from lsprotocol import types
from pygls.exceptions import JsonRpcContentModified
from pygls.lsp.server import LanguageServer

from mlmg_lsp.features import FEATURES, Feature, Scope, answer_named
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.session import ClientSession
from mlmg_lsp.work import off_loop

Answering: TypeAlias = Callable[[ClientSession, Feature, Any], Awaitable[Any]]
"""Answers a request by its parameters, off the thread that reads messages."""


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
    for feature in FEATURES:
        server.feature(feature.method, feature.options)(partial(_ANSWERING[feature.scope], session, feature))


async def _of_text(session: ClientSession, feature: Feature, params: Any) -> Any:
    is_early = feature.early or feature.refreshed in session.documents.client.refreshed
    snapshot = await session.snapshot(params.text_document.uri, _last_line(params) if is_early else None)
    return await _answer(session, feature, snapshot, params)


async def _of_users(session: ClientSession, feature: Feature, params: Any) -> Any:
    await session.documents.all_read()
    snapshot = await session.snapshot(params.text_document.uri)
    users = await session.closed_users(snapshot, params)
    return await _answer(session, feature, snapshot, params, users)


async def _of_foreseen(session: ClientSession, feature: Feature, params: types.InlayHintParams) -> Any:
    """Answer with what is foreseen of the text, if that is wanted."""
    snapshot = await session.snapshot(params.text_document.uri)
    kinds = session.workspace.settings.hints
    outlook = await session.foresight.of(snapshot) if kinds & {"motions", "arrivals"} else None
    return await _answer(session, feature, snapshot, params, outlook, kinds)


async def _of_all_open(session: ClientSession, feature: Feature, params: Any) -> Any:
    """Answer by all open texts; one that is edited meanwhile is left out."""
    snapshots = []
    for document in session.documents.all():
        with suppress(JsonRpcContentModified):
            snapshots.append(await session.snapshot(document.uri))
    return await off_loop(lambda: answer_named(feature.answer)(snapshots, params))


async def _of_item(session: ClientSession, feature: Feature, item: Any) -> Any:
    uri = item.data.get("uri") if isinstance(item.data, dict) else None
    if not isinstance(uri, str):
        return item
    snapshot = await session.snapshot(uri, 0 if feature.early else None)
    return await _answer(session, feature, snapshot, item)


_ANSWERING: Final[Mapping[Scope, Answering]] = {
    Scope.TEXT: _of_text,
    Scope.FORESEEN: _of_foreseen,
    Scope.USERS: _of_users,
    Scope.ALL_OPEN: _of_all_open,
    Scope.ITEM: _of_item,
}


async def _answer(session: ClientSession, feature: Feature, snapshot: Snapshot, *asked: Any) -> Any:
    """Return what is answered of a text.

    Raises
    ------
    JsonRpcContentModified
        If these are edits, and what they are for has been edited meanwhile.
    """
    answer = await off_loop(lambda: answer_named(feature.answer)(snapshot, *asked))
    if feature.edits and not session.documents.is_current(snapshot, feature.scope is Scope.USERS):
        raise JsonRpcContentModified(f"{snapshot.uri} has changed")
    return answer


def _last_line(params: Any) -> int:
    """Return the last line that a request is about; the first if it names none."""
    places = (getattr(params, "position", None), getattr(getattr(params, "range", None), "end", None))
    return max((place.line for place in places if place is not None), default=0)
