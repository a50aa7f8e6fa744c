"""A client of the language server: real processes, JSON-RPC over their standard input and output."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from multiprocessing.reduction import send_handle
from pathlib import Path
from queue import Queue
from threading import Thread
from typing import Any, BinaryIO, TypeAlias

import pytest

from mlmg_runtime.library import Library

WAIT_S = 60.0
"""After so long without a message that is waited for, a test fails."""


class Client:
    """An editor, as far as the server can tell."""

    def __init__(self, process: Process) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self.process = process
        self._stdin = process.stdin
        self._messages: Queue[Any] = Queue()
        self._passed_over: list[Any] = []
        self._number = 0
        self._answers: dict[str, Mapping[str, Any] | None] = {}
        Thread(target=self._read, args=(process.stdout,), daemon=True).start()

    # --- messages ---

    def send_raw(self, data: bytes) -> None:
        self._stdin.write(data)
        self._stdin.flush()

    def send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode("utf-8")
        self.send_raw(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))

    def notify(self, method: str, params: Any = None) -> None:
        self.send(method=method, params=params)

    def begin(self, method: str, params: Any = None) -> int:
        """Send a request; return its number."""
        self._number += 1
        self.send(id=self._number, method=method, params=params)
        return self._number

    def outcome(self, number: int) -> Any:
        """Return the whole answer to a request."""
        return self.wait(lambda one: one.get("id") == number and "method" not in one)

    def ask(self, method: str, params: Any = None) -> Any:
        """Return what is answered to a request."""
        return self.result(self.begin(method, params))

    def result(self, number: int) -> Any:
        """Return what is answered to a request that has been sent."""
        answer = self.outcome(number)
        assert "error" not in answer, answer
        return answer["result"]

    def answer_with(self, method: str, result: Any) -> None:
        """Answer requests of the server by this."""
        self.answer_by(method, {"result": result})

    def answer_by(self, method: str, answer: Mapping[str, Any] | None) -> None:
        """Answer requests of the server by a message with this, or not at all."""
        self._answers[method] = answer

    def wait(self, wanted: Callable[[Any], bool]) -> Any:
        """Return the first message that is wanted, from those passed over so far on."""
        for at, message in enumerate(self._passed_over):
            if wanted(message):
                return self._passed_over.pop(at)
        while True:
            message = self._messages.get(timeout=WAIT_S)
            assert message is not None, f"the server has ended: {self.process.wait()}"
            if wanted(message):
                return message
            self._passed_over.append(message)

    def wait_for(self, method: str) -> Any:
        """Return the parameters of the next message of a method."""
        return self.wait(lambda one: one.get("method") == method).get("params")

    def forget(self) -> None:
        """Let go of the messages that nothing has waited for so far."""
        self._passed_over.clear()

    def rest(self) -> list[Any]:
        """Return all messages that nothing has waited for, up to the end of the server."""
        found = list(self._passed_over)
        while (message := self._messages.get(timeout=WAIT_S)) is not None:
            found.append(message)
        return found

    def close(self) -> None:
        """Go without a word."""
        self._stdin.close()

    def _read(self, stdout: BinaryIO) -> None:
        while head := stdout.readline():
            length = int(head.split(b":")[1])
            while stdout.readline().strip():
                pass
            message = json.loads(stdout.read(length))
            if "method" in message and "id" in message:
                answer = self._answers.get(message["method"], {"result": None})
                if answer is not None:
                    self.send(id=message["id"], **answer)
            self._messages.put(message)
        self._messages.put(None)

    # --- what editors do ---

    def initialize(self, capabilities: Mapping[str, Any] | None = None, **params: Any) -> Any:
        given = {"processId": os.getpid(), "rootUri": None, "capabilities": capabilities or {}, **params}
        result = self.ask("initialize", given)
        self.notify("initialized", {})
        return result

    def open(self, uri: str, text: str, version: int = 1) -> None:
        document = {"uri": uri, "languageId": "motion-script", "version": version, "text": text}
        self.notify("textDocument/didOpen", {"textDocument": document})

    def close_text(self, uri: str) -> None:
        """Close a text, and forget all that has been said so far."""
        self.notify("textDocument/didClose", {"textDocument": {"uri": uri}})
        self.outcome(self.begin("textDocument/hover"))  # a refusal, behind all that is said of the text
        self.forget()

    def edit(self, uri: str, version: int, *changes: Any) -> None:
        document = {"uri": uri, "version": version}
        self.notify("textDocument/didChange", {"textDocument": document, "contentChanges": list(changes)})

    def diagnostics(self, uri: str, version: int | None = None) -> list[Any]:
        """Return what is next told of a text, or of one of its versions."""
        told = self.wait(
            lambda one: (
                one.get("method") == "textDocument/publishDiagnostics"
                and one["params"]["uri"] == uri
                and version in (None, one["params"].get("version"))
            )
        )
        return list(told["params"]["diagnostics"])

    def ask_at(self, method: str, uri: str, line: int, character: int, **more: Any) -> Any:
        place = {"textDocument": {"uri": uri}, "position": {"line": line, "character": character}}
        return self.ask(f"textDocument/{method}", place | more)

    def leave(self) -> int:
        """End the server in order; return its exit code."""
        self.ask("shutdown")
        self.notify("exit")
        return self.process.wait(WAIT_S)


class Forked:
    """A process of a server that has been forked, in place of `subprocess.Popen`."""

    def __init__(self, forker: Connection, pid: int, stdin: BinaryIO, stdout: BinaryIO) -> None:
        self.pid, self.stdin, self.stdout = pid, stdin, stdout
        self._forker = forker
        self._code: int | None = None

    def wait(self, timeout: float = WAIT_S) -> int:
        """Return the exit code when it has ended."""
        if self._code is None:
            self._forker.send(("wait", self.pid, timeout))
            self._code = self._forker.recv()
        if self._code is None:
            raise subprocess.TimeoutExpired("mlmg lsp", timeout)
        return self._code

    def kill(self) -> None:
        """End it at once."""
        if self._code is None:
            os.kill(self.pid, signal.SIGKILL)


Process: TypeAlias = "subprocess.Popen[bytes] | Forked"
Begin: TypeAlias = Callable[[list[str], Path, dict[str, str]], Process]
"""Begins a process: with which words, where, and in which environment."""


def run_program(words: list[str], folder: Path, environment: dict[str, str]) -> Process:
    """Start the program itself."""
    program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", *words]
    return subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder, env=environment)


@pytest.fixture(scope="session")
def fork() -> Iterator[Begin]:
    """Return what begins a server without its imports, where processes can be forked."""
    if not hasattr(os, "fork"):
        yield run_program
        return
    own, other = Pipe()
    program = [sys.executable, str(Path(__file__).with_name("forking.py")), str(other.fileno())]
    with subprocess.Popen(program, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, pass_fds=[other.fileno()]):
        other.close()

        def begin(words: list[str], folder: Path, environment: dict[str, str]) -> Process:
            own.send(("begin", str(folder), words, environment))
            incoming, outgoing = os.pipe(), os.pipe()
            for pipe in (incoming[0], outgoing[1]):
                send_handle(own, pipe, None)
                os.close(pipe)
            pid = own.recv()
            return Forked(own, pid, os.fdopen(incoming[1], "wb"), os.fdopen(outgoing[0], "rb"))

        yield begin
        own.close()


@contextmanager
def starting(begin: Begin, folder: Path, library: Path) -> Iterator[Callable[..., Client]]:
    """Give a function: options of `mlmg lsp` -> a client of a new process. Without any, a library is used."""
    started: list[Process] = []

    def start(*options: str) -> Client:
        environment = {name: value for name, value in os.environ.items() if name != "MLMG_LIBRARY"}
        started.append(begin(["lsp", *(options or ("--library", str(library)))], folder, environment))
        return Client(started[-1])

    yield start
    for process in started:
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None and not stream.closed:
                with suppress(BrokenPipeError):
                    stream.close()


@pytest.fixture
def start(fork: Begin, tmp_path: Path, demo_library: Library) -> Iterator[Callable[..., Client]]:
    """Return a function: options of `mlmg lsp` -> a client of a new process. Without any, the demo library is used."""
    with starting(fork, tmp_path, demo_library.path) as begin:
        yield begin


@pytest.fixture
def start_program(tmp_path: Path, demo_library: Library) -> Iterator[Callable[..., Client]]:
    """Return the same where the start is the point: the program as editors start it."""
    with starting(run_program, tmp_path, demo_library.path) as begin:
        yield begin


@pytest.fixture(scope="module")
def start_for_all(
    fork: Begin, tmp_path_factory: pytest.TempPathFactory, demo_library: Library
) -> Iterator[Callable[..., Client]]:
    """Return a function as `start` for clients that all tests of a module share."""
    with starting(fork, tmp_path_factory.mktemp("all"), demo_library.path) as begin:
        yield begin
