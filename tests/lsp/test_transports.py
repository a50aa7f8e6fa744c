"""Several clients at one address; each has a server of its own."""

from __future__ import annotations

import json
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

MESSAGES = (
    {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
    {"method": "initialized", "params": {}},
)
URI = "untitled:x"


@pytest.fixture(params=["tcp", "ws"])
def address(request, tmp_path, demo_library) -> Iterator[tuple[str, int]]:
    words = ["lsp", f"--{request.param}", "127.0.0.1:0", "--library", str(demo_library.path)]
    program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", *words]
    with subprocess.Popen(program, stderr=subprocess.PIPE, cwd=tmp_path) as process:
        assert process.stderr is not None
        said = process.stderr.readline().decode()
        found = re.search(r"://127\.0\.0\.1:(\d+)", said)
        assert found is not None, said
        yield request.param, int(found[1])
        process.kill()


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
