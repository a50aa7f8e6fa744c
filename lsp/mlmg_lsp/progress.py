"""How far long work is, as a client shows it."""

from __future__ import annotations

import asyncio
from uuid import uuid4

from lsprotocol import types
from pygls.lsp.server import LanguageServer


class Bar:
    """What a client shows while something is loaded; nothing where it cannot. The work does not wait for the client."""

    def __init__(self, server: LanguageServer, shown: bool) -> None:
        """Take the server that speaks to the client, and whether that shows such things."""
        self._server = server
        self._shown = shown
        self._token = str(uuid4())
        self._loop = asyncio.get_running_loop()
        self._beginning: asyncio.Task[None] | None = None
        self._begun = False

    def begin(self, title: str) -> None:
        """Begin to show something, as soon as the client agrees."""
        if self._shown and self._beginning is None:
            self._beginning = asyncio.ensure_future(self._begin(title))

    async def _begin(self, title: str) -> None:
        await self._server.work_done_progress.create_async(self._token)
        self._begun = True
        self._server.work_done_progress.begin(self._token, types.WorkDoneProgressBegin(title))

    def report(self, stage: str, done: int, total: int) -> None:
        """Tell, from any thread, that some steps of a stage are done."""
        self._loop.call_soon_threadsafe(self._report, stage, done, total)

    def _report(self, stage: str, done: int, total: int) -> None:
        self.begin("Building the demo library")
        if self._begun:
            percentage = 100 * done // max(total, 1)
            value = types.WorkDoneProgressReport(message=f"{stage} {done}/{total}", percentage=percentage)
            self._server.work_done_progress.report(self._token, value)

    def end(self) -> None:
        """Show it no longer."""
        if self._beginning is not None:
            self._beginning.cancel()
        if self._begun:
            self._server.work_done_progress.end(self._token, types.WorkDoneProgressEnd())
            self._begun = False
