"""Clients over pipes, TCP and web sockets: who may connect, and who leaves, vanishes or does not read."""

from __future__ import annotations

import json
import re
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import BinaryIO

import pytest

MESSAGES = (
    {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
    {"method": "initialized", "params": {}},
)
URI = "untitled:x"


def program(library, *words: str) -> list[str]:
    return [sys.executable, "-m", "mlmg_lang.commands.mlmg", "lsp", *words, "--library", str(library.path)]


@contextmanager
def serving(way: str, folder, library) -> Iterator[tuple[subprocess.Popen[bytes], int]]:
    words = program(library, f"--{way}", "127.0.0.1:0")
    with subprocess.Popen(words, stderr=subprocess.PIPE, cwd=folder) as process:
        try:
            said = process.stderr.readline().decode()
            found = re.search(r"://127\.0\.0\.1:(\d+)", said)
            assert found is not None, said
            yield process, int(found[1])
        finally:
            process.kill()


@pytest.fixture(scope="module", params=["tcp", "ws"])
def address(request, tmp_path_factory, demo_library) -> Iterator[tuple[str, int]]:
    """Return where a server is that those tests share which leave it as it is."""
    with serving(request.param, tmp_path_factory.mktemp(request.param), demo_library) as (_, port):
        yield request.param, port


def framed(*messages: object) -> bytes:
    bodies = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    return b"".join(b"Content-Length: %d\r\n\r\n%b" % (len(body), body) for body in bodies)


class Stream:
    """A client over what is read from and written to as a file is."""

    def __init__(self, incoming: BinaryIO, send_raw: Callable[[bytes], object]) -> None:
        self.file = incoming
        self.send_raw = send_raw

    def send(self, message: object) -> None:
        self.send_raw(framed(message))

    def receive(self) -> object:
        message = self.next()
        assert message is not None, "the server has gone"
        return message

    def next(self) -> object:
        """Return the next message, which has to be whole; None where no more comes."""
        head = b""
        while (line := self.file.readline()).strip():
            head += line
        if not line:
            assert head == b""
            return None
        length = int(head.removeprefix(b"Content-Length:").split(b"\r\n")[0])
        body = self.file.read(length)
        assert len(body) == length
        return json.loads(body)

    def expect_end(self) -> None:
        """Fail unless nothing comes any more, once all that is still to come has; a reset would raise."""
        while self.next() is not None:
            pass


class Tcp(Stream):
    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        super().__init__(self.socket.makefile("rb"), self.socket.sendall)

    def vanish(self) -> None:
        """Go in the middle of a message, as when the machine is switched off."""
        self.socket.sendall(b'Content-Length: 1000\r\n\r\n{"jsonrpc"')
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.close()

    def close(self) -> None:
        self.file.close()
        self.socket.close()


class Ws:
    def __init__(self, port: int) -> None:
        from websockets.sync.client import connect

        self.stack = ExitStack()
        self.connection = self.stack.enter_context(connect(f"ws://127.0.0.1:{port}"))

    def send(self, message: object) -> None:
        self.connection.send(json.dumps({"jsonrpc": "2.0", **message}))

    def receive(self) -> object:
        message = self.connection.recv(timeout=60)
        assert isinstance(message, str)
        return json.loads(message)

    def expect_end(self, code: int = 1001) -> None:
        """Fail unless it is closed with a code, by itself that it goes away, once all that is to come has come."""
        from websockets.exceptions import ConnectionClosedOK

        with suppress(ConnectionClosedOK):
            while True:
                self.connection.recv(timeout=60)
        assert self.connection.close_code == code

    def vanish(self) -> None:
        self.connection.socket.shutdown(socket.SHUT_RDWR)
        self.close()

    def close(self) -> None:
        self.stack.close()


def told(client, text: str) -> list[str]:
    document = {"uri": URI, "languageId": "motion-script", "version": 1, "text": text}
    client.send({"method": "textDocument/didOpen", "params": {"textDocument": document}})
    while (message := client.receive()).get("method") != "textDocument/publishDiagnostics":
        pass
    return [one["code"] for one in message["params"]["diagnostics"]]


def test_each_client_has_its_own_texts_and_one_that_leaves_leaves_the_others(address):
    way, port = address
    clients = [{"tcp": Tcp, "ws": Ws}[way](port) for _ in range(2)]
    for client in clients:
        for message in MESSAGES:
            client.send(message)
        assert client.receive()["result"]["serverInfo"]["name"] == "mlmg lsp"
    one, other = clients
    assert told(one, "WLAK") == ["MS021"]
    one.close()
    assert told(other, "WALK") == []
    other.close()


def test_a_client_that_vanishes_while_it_is_answered_leaves_the_others_and_those_that_come(address):
    way, port = address
    clients = []
    for _ in range(4):
        clients.append({"tcp": Tcp, "ws": Ws}[way](port))
        for message in MESSAGES:
            clients[-1].send(message)
        assert clients[-1].receive()["id"] == 1
        if len(clients) < 3:
            document = {"uri": URI, "languageId": "motion-script", "version": 1, "text": "WALK   for 3 sec\n" * 5_000}
            asked = {"textDocument": {"uri": URI}, "options": {"tabSize": 4, "insertSpaces": True}}
            clients[-1].send({"method": "textDocument/didOpen", "params": {"textDocument": document}})
            clients[-1].send({"id": 2, "method": "textDocument/formatting", "params": asked})
            clients[-1].vanish()
    for client in clients[2:]:
        assert told(client, "WLAK") == ["MS021"]
        client.close()


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize(("name", "code"), [("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_signal_ends_it_without_a_word_whatever_it_is_at(name, code, tmp_path, demo_library):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(program(demo_library), cwd=tmp_path, **pipes) as process:
        item = {"uri": URI, "languageId": "motion-script", "version": 1, "text": "WALK for 2 sec\nIDLE\n" * 500}
        process.stdin.write(framed(*MESSAGES, {"method": "textDocument/didOpen", "params": {"textDocument": item}}))
        process.stdin.flush()
        assert process.stdout.readline().startswith(b"Content-Length")
        process.send_signal(getattr(signal, name))
        process.stdout.read()
        assert process.stderr.read() == b""
        assert process.wait() == code


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize(
    ("name", "code", "said"),
    [("SIGTERM", 143, b""), ("SIGHUP", 129, b""), ("SIGINT", 130, b"mlmg lsp: interrupted\n")],
)
@pytest.mark.parametrize("way", ["tcp", "ws"])
def test_a_signal_ends_it_and_all_connections_in_order_whatever_it_is_at(way, name, code, said, tmp_path, demo_library):
    item = {"uri": URI, "languageId": "motion-script", "version": 1, "text": "WALK for 2 sec\nIDLE\n" * 500}
    asked = {"textDocument": {"uri": URI}}
    of_none = {"textDocument": {"uri": "untitled:none"}, "position": {"line": 0, "character": 0}}
    with serving(way, tmp_path, demo_library) as (process, port):
        clients = [{"tcp": Tcp, "ws": Ws}[way](port) for _ in range(2)]
        for client in clients:
            for message in MESSAGES:
                client.send(message)
            assert client.receive()["id"] == 1
        clients[0].send({"method": "textDocument/didOpen", "params": {"textDocument": item}})
        for number in range(2, 12):
            clients[0].send({"id": number, "method": "textDocument/semanticTokens/full", "params": asked})
        clients[0].send({"id": 12, "method": "textDocument/hover", "params": of_none})
        while clients[0].receive().get("id") != 12:  # now all has been read
            pass
        process.send_signal(getattr(signal, name))
        assert process.wait(timeout=60) == code
        assert process.stderr.read() == said
        for client in clients:
            client.expect_end()
            client.close()


def test_an_answer_that_comes_when_nobody_waits_for_it_any_more_is_passed_over_without_a_word(tmp_path, demo_library):
    item = {"uri": URI, "languageId": "motion-script", "version": 1, "text": "WLAK"}
    with serving("tcp", tmp_path, demo_library) as (process, port):
        client = Tcp(port)
        can = {"processId": None, "rootUri": None, "capabilities": {"window": {"workDoneProgress": True}}}
        client.send({"id": 1, "method": "initialize", "params": can})
        client.send({"method": "initialized", "params": {}})
        client.send({"method": "textDocument/didOpen", "params": {"textDocument": item}})
        asked = None
        while not (message := client.receive()).get("params", {}).get("diagnostics"):  # until the library is there
            asked = message["id"] if message.get("method") == "window/workDoneProgress/create" else asked
        assert asked is not None
        client.send({"id": asked, "result": None})
        client.send({"id": 2, "method": "shutdown"})
        while client.receive().get("id") != 2:
            pass
        process.terminate()
        client.close()
        assert process.stderr.read() == b""


# --- who may connect ---


@pytest.mark.parametrize(
    "head",
    [
        b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
        b"POST /?Content-Length:5 HTTP/1.1\r\nContent-Length: 9999\r\n\r\n",
        b"POST /Content-Length: 5\r\n\r\n[[]]\n",
        b"\x16\x03\x01\0\xc8\r\n\r\n",
        b"GET /" + b"a" * 100_000 + b"\r\n\r\n",
    ],
    ids=lambda one: repr(one[:40]),
)
def test_messages_behind_what_begins_as_another_protocol_are_not_read(head, tmp_path, demo_library):
    with serving("tcp", tmp_path, demo_library) as (_, port):
        client = Tcp(port)
        read = b""
        with suppress(ConnectionResetError, BrokenPipeError):
            client.send_raw(head + framed(*MESSAGES, {"id": 2, "method": "shutdown"}, {"method": "exit"}))
            read = client.file.read()
        assert read == b""
        client.close()
        other = Tcp(port)
        other.send_raw(b"\r\ncontent-type: application/vscode-jsonrpc; charset=utf-8\r\n" + framed(*MESSAGES))
        assert other.receive()["id"] == 1
        other.close()


@pytest.mark.parametrize(
    ("host", "origin", "status"),
    [
        ("127.0.0.1:4711", None, 101),
        ("[::1]:4711", None, 101),
        ("localhost", "http://localhost", 101),
        ("LOCALHOST:4711", "http://localhost:3000", 101),
        ("127.0.0.1:4711", "https://127.0.0.1:8443", 101),
        ("127.0.0.1:4711", "http://[::1]:3000", 101),
        ("127.0.0.1:4711", "vscode-webview://0kb1c6hkp5n5jv0", 101),
        ("127.0.0.1:4711", "https://example.com", 403),
        ("127.0.0.1:4711", "http://localhost.example.com", 403),
        ("127.0.0.1:4711", "http://127.0.0.1:80.example.com", 403),
        ("127.0.0.1:4711", "http://example.com/http://localhost", 403),
        ("127.0.0.1:4711", "null", 403),
        ("127.0.0.1:4711", "", 403),
        ("example.com:4711", None, 403),
        ("example.com:4711", "http://localhost", 403),
        ("localhost.example.com", None, 403),
    ],
)
def test_pages_of_web_sites_get_no_web_socket(web_sockets, host, origin, status):
    asked = {"Host": host, "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": 13}
    asked |= {"Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="} | ({} if origin is None else {"Origin": origin})
    client = Tcp(web_sockets)
    lines = ["GET / HTTP/1.1", *(f"{name}: {value}" for name, value in asked.items()), "", ""]
    client.send_raw("\r\n".join(lines).encode())
    assert int(client.file.readline().split()[1]) == status
    client.close()


@pytest.fixture(scope="module")
def web_sockets(tmp_path_factory, demo_library) -> Iterator[int]:
    with serving("ws", tmp_path_factory.mktemp("ws"), demo_library) as (_, port):
        yield port


# --- clients that do not read ---


def ask_at_length(client, numbers: range) -> None:
    """Ask what is refused by answers of a million signs, as they name what is refused."""
    for number in numbers:
        client.send({"id": f"{number}{'x' * 1_000_000}", "method": "no/such", "params": {}})


def next_number(client) -> int:
    return int(str(client.receive()["id"]).rstrip("x"))


@contextmanager
def client_of(way: str, folder, library, number_of_process: int | None = None):
    """Give a server's process, and a client of it that has begun."""
    with ExitStack() as stack:
        if way == "stdio":
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "bufsize": 0}
            process = stack.enter_context(subprocess.Popen(program(library), cwd=folder, **pipes))
            stack.callback(process.kill)
            client = Stream(
                stack.enter_context(open(process.stdout.fileno(), "rb", closefd=False)), process.stdin.write
            )
        else:
            process, port = stack.enter_context(serving(way, folder, library))
            client = {"tcp": Tcp, "ws": Ws}[way](port)
            stack.callback(client.close)
        begin, begun = MESSAGES
        client.send({**begin, "params": {**begin["params"], "processId": number_of_process}})
        client.send(begun)
        assert client.receive()["id"] == 1
        yield process, client


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize("way", ["stdio", "tcp", "ws"])
def test_a_signal_ends_it_though_a_client_does_not_read(way, tmp_path, demo_library):
    with client_of(way, tmp_path, demo_library) as (process, client):
        ask_at_length(client, range(40))
        assert next_number(client) == 0
        process.terminate()
        assert process.wait(60) == 143


@pytest.mark.skipif(sys.platform == "win32", reason="it cannot be asked there whether a process has gone")
def test_it_ends_when_the_process_of_a_client_that_does_not_read_has_gone(tmp_path, demo_library):
    editor = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    with editor, client_of("stdio", tmp_path, demo_library, editor.pid) as (process, client):
        ask_at_length(client, range(2))
        assert next_number(client) == 0
        editor.communicate(b"\n")
        assert process.wait(60) == 1


@pytest.mark.parametrize("way", ["stdio", "tcp", "ws"])
def test_a_client_that_never_reads_and_asks_on_is_let_go(way, tmp_path, demo_library):
    from websockets.exceptions import ConnectionClosed

    with client_of(way, tmp_path, demo_library) as (process, client):
        if way == "stdio":
            with suppress(BrokenPipeError):
                ask_at_length(client, range(200))
            assert process.wait(60) == 1
        else:
            with pytest.raises((ConnectionError, ConnectionClosed)):
                ask_at_length(client, range(200))
            assert process.poll() is None


@pytest.mark.parametrize("way", ["stdio", "tcp", "ws"])
def test_all_that_was_asked_before_the_end_is_answered_in_order(way, tmp_path, demo_library):
    with client_of(way, tmp_path, demo_library) as (process, client):
        for number in range(0, 8, 2):
            ask_at_length(client, range(number, number + 1))
            client.send({"id": number + 1, "method": "no/such", "params": {}})
        client.send({"id": 8, "method": "shutdown"})
        client.send({"method": "exit"})
        assert [next_number(client) for _ in range(9)] == list(range(9))
        client.expect_end(*((1000,) if way == "ws" else ()))
        if way == "stdio":
            assert process.wait(60) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such sockets")
def test_one_socket_may_be_both_standard_input_and_output(tmp_path, demo_library):
    ours, its = socket.socketpair()
    ours.settimeout(60)
    with ExitStack() as stack:
        process = stack.enter_context(subprocess.Popen(program(demo_library), cwd=tmp_path, stdin=its, stdout=its))
        stack.callback(process.kill)
        its.close()
        stack.enter_context(ours)
        client = Stream(stack.enter_context(ours.makefile("rb")), ours.sendall)
        for message in MESSAGES:
            client.send(message)
        assert client.receive()["id"] == 1
        for number in range(2, 200):
            client.send({"id": f"{number}{'x' * (number % 100 * 1_000)}", "method": "no/such", "params": {}})
        assert [next_number(client) for _ in range(2, 200)] == list(range(2, 200))
        ours.shutdown(socket.SHUT_RDWR)
        assert process.wait(60) == 1
