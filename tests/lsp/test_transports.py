"""Several clients at one address; each has a server of its own."""

from __future__ import annotations

import json
import re
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress

import pytest

MESSAGES = (
    {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
    {"method": "initialized", "params": {}},
)
URI = "untitled:x"


@contextmanager
def serving(way: str, folder, library) -> Iterator[tuple[subprocess.Popen[bytes], int]]:
    words = ["lsp", f"--{way}", "127.0.0.1:0", "--library", str(library.path)]
    program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", *words]
    with subprocess.Popen(program, stderr=subprocess.PIPE, cwd=folder) as process:
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


class Tcp:
    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.file = self.socket.makefile("rb")

    def send(self, message: object) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.socket.sendall(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))

    def receive(self) -> object:
        length = 0
        while (line := self.file.readline().strip()) or not length:
            assert line, "the server has gone"
            length = int(line.split(b":")[1]) if line.startswith(b"Content-Length") else length
        return json.loads(self.file.read(length))

    def is_closed_in_order(self) -> bool:
        """Return whether nothing comes any more, once all that is still to come has; a reset would raise."""
        self.file.read()
        return True

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

    def is_closed_in_order(self) -> bool:
        from websockets.exceptions import ConnectionClosedOK

        with suppress(ConnectionClosedOK):
            while True:
                self.connection.recv(timeout=60)
        return self.connection.close_code == 1001  # it goes away

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
    program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "lsp", "--library", str(demo_library.path)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(program, cwd=tmp_path, **pipes) as process:
        item = {"uri": URI, "languageId": "motion-script", "version": 1, "text": "WALK for 2 sec\nIDLE\n" * 500}
        for message in (*MESSAGES, {"method": "textDocument/didOpen", "params": {"textDocument": item}}):
            body = json.dumps({"jsonrpc": "2.0", **message}).encode()
            process.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
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
            assert client.is_closed_in_order()
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
