"""How far long work is, as a client shows it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from uuid import uuid4

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer


class WorkDoneProgress:
    """What a client shows while something is done; nothing where it cannot. The work does not wait for the client."""

    def __init__(self, server: LanguageServer, shown: bool, token: types.ProgressToken | None = None) -> None:
        """Take what it is shown by.

        Parameters
        ----------
        server : speaks to the client. shown : whether that shows such things without having asked for it.
        token : by which it has asked for it.
        """
        self._server = server
        self._shown = shown or token is not None
        self._token = str(uuid4()) if token is None else token
        self._is_asked_for = token is not None
        self._loop = asyncio.get_running_loop()
        self._beginning: asyncio.Task[None] | None = None
        self._begun = False
        self._told = ("", -1)

    def begin(self, title: str, cancelled: Callable[[], object] | None = None) -> None:
        """Begin to show something, as soon as the client agrees.

        Parameters
        ----------
        cancelled : called if the person wants no more of it; without it, the work cannot be given up.
        """
        if self._shown and self._beginning is None:
            self._beginning = asyncio.ensure_future(self._begin(title, cancelled))

    async def _begin(self, title: str, cancelled: Callable[[], object] | None) -> None:
        progress = self._server.work_done_progress
        with suppress(JsonRpcException):  # it would rather not
            if not self._is_asked_for:
                await progress.create_async(self._token)
            self._begun = True
            progress.begin(self._token, types.WorkDoneProgressBegin(title, cancellable=cancelled is not None))
            if cancelled is not None:
                progress.tokens[self._token].add_done_callback(lambda one: one.cancelled() and cancelled())

    def report(self, stage: str, done: int, total: int) -> None:
        """Tell, from any thread, that some steps of a stage of building the demo library are done."""
        self._loop.call_soon_threadsafe(self.begin, "Building the demo library")
        self.tell(f"{stage} {done}/{total}", 100 * done // max(total, 1))

    def tell(self, message: str, percentage: int) -> None:
        """Tell, from any thread, what is being done and how much of all is done; as often as it makes a difference."""
        self._loop.call_soon_threadsafe(self._tell, message, percentage)

    def _tell(self, message: str, percentage: int) -> None:
        stage = (message.partition(" ")[0], percentage)
        if self._begun and stage != self._told:
            self._told = stage
            value = types.WorkDoneProgressReport(message=message, percentage=percentage)
            self._server.work_done_progress.report(self._token, value)

    def end(self) -> None:
        """Show it no longer."""
        if self._beginning is not None:
            self._beginning.cancel()
        if self._begun:
            self._server.work_done_progress.end(self._token, types.WorkDoneProgressEnd())
            self._begun = False
        self._server.work_done_progress.tokens.pop(self._token, None)
