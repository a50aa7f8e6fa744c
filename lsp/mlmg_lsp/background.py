"""What goes on by itself for one client, beside the messages that are read."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from contextlib import suppress
from typing import Any

from pygls.exceptions import JsonRpcException


class Background:
    """All that goes on, until it is done or the client has gone."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._tasks: set[asyncio.Task[None]] = set()

    def begin(self, work: Coroutine[Any, Any, object]) -> asyncio.Task[None]:
        """Begin some work; a client that does not do as asked is no failure of it."""

        async def done() -> None:
            with suppress(JsonRpcException, ConnectionError):
                await work

        task = asyncio.ensure_future(done())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda _: work.close())  # it may have been cancelled before it began
        return task

    def end(self) -> None:
        """Stop all."""
        for task in list(self._tasks):
            task.cancel()
