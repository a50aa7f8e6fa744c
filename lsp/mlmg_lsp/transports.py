"""How a client is served, over whatever its messages come: standard input and output, TCP, web sockets."""

from __future__ import annotations

import asyncio
import re
import signal
from asyncio import StreamReader
from collections.abc import Callable
from contextlib import suppress
from typing import Final, Protocol

MOST_READ: Final = 1 << 28
"""So long may a message be, in bytes; what announces a longer one is no message."""
MOST_UNREAD: Final = 1 << 26
"""A client that has left more than so many bytes unread, and asks on, is treated as one that has gone."""
CLOSING_S: Final = 2.0
"""So long clients may take at the end to read what is still to be read."""

_LENGTH: Final = re.compile(rb"content-length:\s*(\d{1,11})\s*$", re.IGNORECASE)
_HEAD_LINE: Final = re.compile(rb"(content-length:\s*\d{1,11}|content-type:.*)?\s*$", re.IGNORECASE)


class Server(Protocol):
    """What serves one client.

    Attributes
    ----------
    ended : set when the client has ended it, or is no longer there. orderly : whether it has said that it would.
    """

    ended: asyncio.Event
    orderly: bool

    def connect(self, send: Callable[[bytes], object], headers: bool) -> None:
        """Take what sends a message."""

    def receive(self, body: bytes | str) -> None:
        """Take a message; one that is not well-formed is passed over."""

    def leave(self) -> None:
        """Let go of all."""


def told_to_end(ended: asyncio.Event) -> list[int]:
    """Return where the signals are noted that the process is told to end by.

    They set `ended` in a turn of the loop: an exception in the midst of something could come out anywhere, even where
    Python can but write it down and go on.
    """
    told: list[int] = []

    def end(number: int) -> None:
        told.append(number)
        ended.set()

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            with suppress(NotImplementedError):  # there is no such thing on Windows
                asyncio.get_running_loop().add_signal_handler(number, end, number)
    return told


async def until_ended(server: Server, reading: object) -> None:
    """Read messages until there are no more, or the server is to end."""
    task = asyncio.ensure_future(reading)  # type: ignore[call-overload]
    ended = asyncio.ensure_future(server.ended.wait())
    try:
        await asyncio.wait((task, ended), return_when=asyncio.FIRST_COMPLETED)
    finally:  # also where the process is interrupted
        for one in (task, ended):
            one.cancel()
        server.leave()


async def read_all(server: Server, reader: StreamReader, is_trusted: bool) -> None:
    """Hand on all messages; a body that is not well-formed is passed over.

    Parameters
    ----------
    is_trusted : whether only the client itself can have sent what is read. If so, what is no message is passed over up
        to the next. If not, it is the end: a page in a browser can send to any address of the machine what begins as a
        request by HTTP, with messages in its body.
    """
    with suppress(asyncio.IncompleteReadError, ConnectionError):
        while not server.ended.is_set():
            length = await _read_head(reader, is_trusted)
            if length is None:
                return
            server.receive(await reader.readexactly(length))
            await asyncio.sleep(0)  # what is asked begins with the text as it is now, before the next edit


async def _read_head(reader: StreamReader, is_trusted: bool) -> int | None:
    """Return the length of the next message; None where what comes is none, unless it is to be passed over."""
    length = 0
    while True:
        try:
            line = await reader.readuntil(b"\n")
        except asyncio.LimitOverrunError as error:
            if not is_trusted:
                return None
            await reader.readexactly(error.consumed)
            continue
        if not (is_trusted or _HEAD_LINE.match(line)):
            return None
        if found := _LENGTH.search(line):  # behind a body that is longer than it was said to be, not at the beginning
            length = int(found[1]) if int(found[1]) <= MOST_READ else 0
        elif length and not line.strip():
            return length
