"""Messages over standard input and output, of the one client that has started the process."""

from __future__ import annotations

import asyncio
import os
import select
import sys
from asyncio import AbstractEventLoop, StreamReader
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from threading import Thread
from typing import Final

from mlmg_lang.commands.console import DONE, WRONG_CONTENT
from mlmg_lsp.transports import CLOSING_S, MOST_UNREAD, Server, read_all, told_to_end, until_ended

_CHUNK: Final = 1 << 16


def serve_stdio(build: Callable[[], Server]) -> int:
    """Serve over standard input and output until the client ends it or is gone; return the exit code."""
    output, sys.stdout = sys.stdout, sys.stderr  # what is printed by mistake is no message
    return asyncio.run(_serve_pipes(build, sys.stdin.fileno(), output.fileno()))


async def _serve_pipes(build: Callable[[], Server], incoming: int, outgoing: int) -> int:
    server, reader, loop = build(), StreamReader(), asyncio.get_running_loop()
    writer = _Writer(outgoing, lambda: loop.call_soon_threadsafe(server.ended.set))
    server.connect(writer.send, True)
    told = told_to_end(server.ended)
    # Nothing can interrupt a thread that waits for input; this one ends with the process.
    Thread(target=_feed, args=(incoming, reader, loop), daemon=True).start()
    try:
        await until_ended(server, read_all(server, reader, is_trusted=True))
    finally:
        writer.finish()
    if told:
        return 128 + told[0]
    return DONE if server.orderly else WRONG_CONTENT


def _feed(incoming: int, reader: StreamReader, loop: AbstractEventLoop) -> None:
    with suppress(RuntimeError, OSError, ValueError):
        # Not by way of `sys.stdin`, whose lock this thread would still hold when the process ends.
        while data := _read(incoming):
            loop.call_soon_threadsafe(reader.feed_data, data)
        loop.call_soon_threadsafe(reader.feed_eof)


def _read(incoming: int) -> bytes:
    while True:
        try:
            return os.read(incoming, _CHUNK)
        except BlockingIOError:  # it is the same socket or terminal that a message is just written to
            select.select((incoming,), (), ())


class _Writer:
    """Writes messages at once and in order, and does not wait for a client that does not read.

    What a pipe does not take is left to a thread, which can wait. As the thread would get its turn later beside those
    that work, it is only left to it where it has to be.
    """

    def __init__(self, outgoing: int, fail: Callable[[], object]) -> None:
        """Take where to write to, and what to call, in whatever thread, when that fails."""
        self._outgoing = outgoing
        self._fail = fail
        self._left: SimpleQueue[bytes | None] = SimpleQueue()
        self._n_left = 0  # bytes that were ever left to the thread, and those that it has written
        self._n_written = 0
        self._thread = Thread(target=self._write_left, daemon=True)
        self._thread.start()

    def send(self, message: bytes) -> None:
        """Send a message, after all that were sent before."""
        n_waiting = self._n_left - self._n_written
        try:
            n_written = 0 if n_waiting else self._write_at_once(message)
        except OSError:
            self._fail()
            return
        if n_waiting > MOST_UNREAD:
            self._fail()
        elif n_written < len(message):
            self._n_left += len(message) - n_written
            self._left.put(message[n_written:])

    def finish(self) -> None:
        """Wait until all is written, or the client has had its time to read it."""
        self._left.put(None)
        self._thread.join(CLOSING_S)

    def _write_at_once(self, message: bytes) -> int:
        """Return how much of a message could be written without waiting."""
        if sys.platform == "win32":  # pipes always wait there
            return 0
        # Only for the moment, and with the thread idle: others may have the same file, and not expect it to be so.
        os.set_blocking(self._outgoing, False)
        try:
            return os.write(self._outgoing, message)
        except BlockingIOError:
            return 0
        finally:
            os.set_blocking(self._outgoing, True)

    def _write_left(self) -> None:
        try:
            while message := self._left.get():
                rest = memoryview(message)
                while rest:
                    rest = rest[os.write(self._outgoing, rest) :]
                self._n_written += len(message)
        except OSError:
            with suppress(RuntimeError):  # the loop has ended
                self._fail()
