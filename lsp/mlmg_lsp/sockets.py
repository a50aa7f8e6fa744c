"""Messages over TCP and web sockets, of all clients that connect to an address. Each has a server.

Every page in a browser of this machine can reach the address too: what it can send is no message here, and web sockets
are refused to pages of web sites.
"""

from __future__ import annotations

import asyncio
import re
from asyncio import StreamReader, StreamWriter
from collections.abc import Callable
from contextlib import suppress
from http import HTTPStatus
from typing import TYPE_CHECKING, Final

from mlmg_lang.commands.console import UsageError, tell
from mlmg_lsp.transports import CLOSING_S, MOST_READ, MOST_UNREAD, Server, read_all, told_to_end, until_ended

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

_HERE: Final = r"(localhost|127\.0\.0\.1|\[::1\])(:\d+)?"
_HOST: Final = re.compile(_HERE, re.IGNORECASE)
_ORIGIN: Final = re.compile(rf"https?://{_HERE}/?|vscode-webview://[^/]*", re.IGNORECASE)
"""Pages that are served from this machine, and those that an extension of VS Code shows there."""


def serve_tcp(build: Callable[[], Server], host: str, port: int) -> int:
    """Serve all who connect until the process is told to end; return the exit code."""
    return asyncio.run(_serve_tcp(build, host, port))


async def _serve_tcp(build: Callable[[], Server], host: str, port: int) -> int:
    clients: dict[asyncio.Task[None], Server] = {}

    def begin(reader: StreamReader, writer: StreamWriter) -> None:
        server = build()
        task = asyncio.ensure_future(_serve_streams(server, reader, writer))
        clients[task] = server
        task.add_done_callback(clients.pop)

    ended = asyncio.Event()
    told = told_to_end(ended)
    listening = await asyncio.start_server(begin, host, port)
    _tell_where("tcp", listening.sockets[0].getsockname())
    try:
        await ended.wait()
    finally:  # also where the process is interrupted
        listening.close()
        for server in clients.values():
            server.ended.set()
        if clients:
            await asyncio.wait(clients, timeout=CLOSING_S)
    return 128 + told[0]


async def _serve_streams(server: Server, reader: StreamReader, writer: StreamWriter) -> None:
    def send(message: bytes) -> None:
        if writer.transport.get_write_buffer_size() > MOST_UNREAD:
            server.ended.set()
        elif not writer.is_closing():  # what is asked last may be answered when nobody is there any more
            writer.write(message)

    server.connect(send, True)
    await until_ended(server, read_all(server, reader, is_trusted=False))
    with suppress(OSError, TimeoutError):  # it may have gone
        writer.close()
        async with asyncio.timeout(CLOSING_S):
            await writer.wait_closed()
    writer.transport.abort()


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
        outgoing = _Outgoing(connection, server.ended)
        server.connect(outgoing.send, False)
        await until_ended(server, _receive_all(server, connection))
        await outgoing.finish()

    ended = asyncio.Event()
    told = told_to_end(ended)
    listening = await serve(
        client,
        host,
        port,
        max_size=MOST_READ,
        compression=None,  # what stays on the machine would only take longer
        close_timeout=CLOSING_S,
        process_request=_refusal,
    )
    _tell_where("ws", next(iter(listening.sockets)).getsockname())
    try:
        await ended.wait()
    finally:
        listening.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(CLOSING_S):
                await listening.wait_closed()
    return 128 + told[0]


def _refusal(connection: ServerConnection, request: Request) -> Response | None:
    """Return what to answer to a page of a web site, even if the name of that site leads to this machine."""
    hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
    if all(map(_HOST.fullmatch, hosts)) and all(map(_ORIGIN.fullmatch, origins)):
        return None
    return connection.respond(HTTPStatus.FORBIDDEN, "Only editors and pages of this machine may connect.\n")


class _Outgoing:
    """Sends messages over a web socket, in order."""

    def __init__(self, connection: ServerConnection, ended: asyncio.Event) -> None:
        """Take the connection, and what to set when the client does not read."""
        self._connection = connection
        self._ended = ended
        self._left: asyncio.Queue[bytes | None] = asyncio.Queue()
        self._n_left = 0
        self._sending = asyncio.ensure_future(self._send_all())

    def send(self, message: bytes) -> None:
        """Send a message, after all that were sent before."""
        if self._n_left > MOST_UNREAD:
            self._ended.set()
        else:
            self._n_left += len(message)
            self._left.put_nowait(message)

    async def finish(self) -> None:
        """Wait until all is sent, or the client has had its time to read it."""
        self._left.put_nowait(None)
        await asyncio.wait((self._sending,), timeout=CLOSING_S)
        if not self._sending.done():
            self._sending.cancel()
            self._connection.transport.abort()  # else it would be waited for until the client reads

    async def _send_all(self) -> None:
        from websockets.exceptions import ConnectionClosed

        with suppress(ConnectionClosed):
            while message := await self._left.get():
                await self._connection.send(message.decode("utf-8"))  # text: clients in browsers want no bytes
                self._n_left -= len(message)


async def _receive_all(server: Server, connection: ServerConnection) -> None:
    from websockets.exceptions import ConnectionClosed

    with suppress(ConnectionClosed):
        async for message in connection:
            server.receive(message)
            await asyncio.sleep(0)


def _tell_where(way: str, address: tuple[object, ...]) -> None:
    tell(f"mlmg lsp: serving on {way}://{address[0]}:{address[1]}")
