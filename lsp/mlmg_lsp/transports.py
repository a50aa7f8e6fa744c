"""The ways over which messages come: standard input and output, TCP, web sockets. Each client has a server."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import sys
from asyncio import StreamReader
from collections.abc import Callable
from contextlib import suppress
from threading import Thread
from typing import TYPE_CHECKING, BinaryIO, Final, Protocol

from mlmg_lang.commands.console import DONE, WRONG_CONTENT, UsageError, tell

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection

_LENGTH: Final = re.compile(rb"content-length:\s*(\d+)\s*", re.IGNORECASE)
_MOST_READ: Final = 1 << 28
"""So long may a message be, in bytes; what announces a longer one is no message."""
_CHUNK: Final = 1 << 16
_CLOSING_S: Final = 2.0
"""So long clients may take to read what is still to be read, when the process is told to end."""


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


def serve_stdio(build: Callable[[], Server]) -> int:
    """Serve over standard input and output until the client ends it or is gone; return the exit code."""
    output, sys.stdout = sys.stdout, sys.stderr  # what is printed by mistake is no message
    return asyncio.run(_serve_pipes(build, sys.stdin.fileno(), output.buffer))


async def _serve_pipes(build: Callable[[], Server], incoming: int, outgoing: BinaryIO) -> int:
    server, reader = build(), StreamReader()

    def send(message: bytes) -> None:
        try:
            outgoing.write(message)
            outgoing.flush()
        except (OSError, ValueError):
            server.ended.set()

    server.connect(send, True)
    told = _told_to_end(server.ended)
    # Nothing can interrupt a thread that waits for input; this one ends with the process.
    Thread(target=_feed, args=(incoming, reader, asyncio.get_running_loop()), daemon=True).start()
    await _until_ended(server, _read_all(server, reader))
    if told:
        return 128 + told[0]
    return DONE if server.orderly else WRONG_CONTENT


def _told_to_end(ended: asyncio.Event) -> list[int]:
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


def _feed(incoming: int, reader: StreamReader, loop: asyncio.AbstractEventLoop) -> None:
    with suppress(RuntimeError, OSError, ValueError):
        # Not by way of `sys.stdin`, whose lock this thread would still hold when the process ends.
        while data := os.read(incoming, _CHUNK):
            loop.call_soon_threadsafe(reader.feed_data, data)
        loop.call_soon_threadsafe(reader.feed_eof)


async def _until_ended(server: Server, reading: object) -> None:
    """Read messages until there are no more, or the server is to end."""
    task = asyncio.ensure_future(reading)  # type: ignore[call-overload]
    ended = asyncio.ensure_future(server.ended.wait())
    try:
        await asyncio.wait((task, ended), return_when=asyncio.FIRST_COMPLETED)
    finally:  # also where the process is interrupted
        for one in (task, ended):
            one.cancel()
        server.leave()


async def _read_all(server: Server, reader: StreamReader) -> None:
    """Hand on all messages; what is not well-formed is passed over."""
    with suppress(asyncio.IncompleteReadError, ConnectionError):
        while not server.ended.is_set():
            length = await _read_head(reader)
            if length is None:
                return
            server.receive(await reader.readexactly(length))
            await asyncio.sleep(0)  # what is asked begins with the text as it is now, before the next edit


async def _read_head(reader: StreamReader) -> int | None:
    """Return the length of the next message; None where there are no more."""
    length = 0
    while True:
        try:
            line = await reader.readuntil(b"\n")
        except asyncio.LimitOverrunError as error:
            await reader.readexactly(error.consumed)
            continue
        if found := _LENGTH.search(line):
            length = int(found[1]) if len(found[1]) < 12 else 0
            length = length if length <= _MOST_READ else 0
        elif not line.strip() and length:
            return length


# --- addresses ---


def serve_tcp(build: Callable[[], Server], host: str, port: int) -> int:
    """Serve all who connect until the process is told to end; return the exit code."""
    return asyncio.run(_serve_tcp(build, host, port))


async def _serve_tcp(build: Callable[[], Server], host: str, port: int) -> int:
    clients: dict[asyncio.Task[None], Server] = {}

    def begin(reader: StreamReader, writer: asyncio.StreamWriter) -> None:
        server = build()
        task = asyncio.ensure_future(_serve_streams(server, reader, writer))
        clients[task] = server
        task.add_done_callback(clients.pop)

    ended = asyncio.Event()
    told = _told_to_end(ended)
    listening = await asyncio.start_server(begin, host, port)
    _tell_where("tcp", listening.sockets[0].getsockname())
    try:
        await ended.wait()
    finally:  # also where the process is interrupted
        listening.close()
        for server in clients.values():
            server.ended.set()
        if clients:
            await asyncio.wait(clients, timeout=_CLOSING_S)
    return 128 + told[0]


async def _serve_streams(server: Server, reader: StreamReader, writer: asyncio.StreamWriter) -> None:
    def send(message: bytes) -> None:
        if not writer.is_closing():  # what is asked last may be answered when nobody is there any more
            writer.write(message)

    server.connect(send, True)
    await _until_ended(server, _read_all(server, reader))
    with suppress(OSError):  # it may have gone
        writer.close()
        await writer.wait_closed()


def serve_ws(build: Callable[[], Server], host: str, port: int) -> int:
    """Serve all who connect by web sockets until the process is told to end; return the exit code.

    Raises
    ------
    UsageError
        If `websockets` is not installed.
    """
    try:
        import websockets  # noqa: F401
    except ImportError:
        raise UsageError('--ws needs web sockets: pip install "mlmg[ws]"') from None
    return asyncio.run(_serve_ws(build, host, port))


async def _serve_ws(build: Callable[[], Server], host: str, port: int) -> int:
    from websockets.asyncio.server import serve

    async def client(connection: ServerConnection) -> None:
        server = build()
        outgoing: asyncio.Queue[bytes] = asyncio.Queue()
        server.connect(outgoing.put_nowait, False)
        sending = asyncio.ensure_future(_send_all(connection, outgoing))
        await _until_ended(server, _receive_all(server, connection))
        sending.cancel()

    ended = asyncio.Event()
    told = _told_to_end(ended)
    listening = await serve(client, host, port, max_size=_MOST_READ)
    _tell_where("ws", next(iter(listening.sockets)).getsockname())
    try:
        await ended.wait()
    finally:
        listening.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(_CLOSING_S):
                await listening.wait_closed()
    return 128 + told[0]


async def _send_all(connection: ServerConnection, outgoing: asyncio.Queue[bytes]) -> None:
    from websockets.exceptions import ConnectionClosed

    with suppress(ConnectionClosed):
        while True:
            await connection.send((await outgoing.get()).decode("utf-8"))  # text: clients in browsers want no bytes


async def _receive_all(server: Server, connection: ServerConnection) -> None:
    from websockets.exceptions import ConnectionClosed

    with suppress(ConnectionClosed):
        async for message in connection:
            server.receive(message)
            await asyncio.sleep(0)


def _tell_where(way: str, address: tuple[object, ...]) -> None:
    tell(f"mlmg lsp: serving on {way}://{address[0]}:{address[1]}")
