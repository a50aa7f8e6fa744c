"""How long an editor waits for the language server: real processes, over standard input and output.

    python benchmarks/bench_lsp.py

On a library of 10,000 names, made of random numbers as in bench_repl.py, and scripts of 1,000 and 10,000 lines. Starts
are cold processes, up to the answer to `initialize`. Ends with code 1 where a limit is missed.
"""

from __future__ import annotations

import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from bench_commands import median_s
from bench_repl import large_library

from mlmg_runtime.built_library import BuiltLibrary, GraphReport
from mlmg_runtime.database import write_database
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.library import open_library

N_STARTS, N_EDITS, N_ASKED = 7, 60, 40
URI = "untitled:bench.ms"
TYPED = "TAG_17 with Upper-Body TAG_4021 for 10 sec"


class Client:
    """A client that waits for each answer."""

    def __init__(self, library: Path) -> None:
        program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "lsp", "--library", str(library)]
        self.process = subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.number = self.version = 0
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.stdin, self.stdout = self.process.stdin, self.process.stdout

    def send(self, **message: Any) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode("utf-8")
        self.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        self.stdin.flush()

    def until(self, wanted: Callable[[Any], bool]) -> Any:
        while True:
            length = 0
            while (line := self.stdout.readline().strip()) or not length:
                length = int(line.split(b":")[1]) if line.startswith(b"Content-Length") else length
            body = self.stdout.read(length)
            if wanted(message := json.loads(body)):
                return message

    def ask(self, method: str, params: Any) -> Any:
        self.number += 1
        self.send(id=self.number, method=method, params=params)
        answer = self.until(lambda one: one.get("id") == self.number)
        assert "error" not in answer, answer
        return answer["result"]

    def initialize(self) -> None:
        self.ask("initialize", {"processId": os.getpid(), "rootUri": None, "capabilities": {}})
        self.send(method="initialized", params={})

    def open(self, text: str) -> list[Any]:
        self.version += 1
        document = {"uri": URI, "languageId": "motion-script", "version": self.version, "text": text}
        self.send(method="textDocument/didOpen", params={"textDocument": document})
        return self.diagnostics()

    def edit(self, line: int, character: int, n_gone: int, new: str) -> list[Any]:
        self.version += 1
        ends = [{"line": line, "character": at} for at in (character, character + n_gone)]
        change = {"range": {"start": ends[0], "end": ends[1]}, "text": new}
        document = {"uri": URI, "version": self.version}
        self.send(method="textDocument/didChange", params={"textDocument": document, "contentChanges": [change]})
        return self.diagnostics()

    def diagnostics(self) -> list[Any]:
        told = self.until(
            lambda one: (
                one.get("method") == "textDocument/publishDiagnostics" and one["params"].get("version") == self.version
            )
        )
        return list(told["params"]["diagnostics"])

    def at(self, line: int, character: int) -> dict[str, Any]:
        return {"textDocument": {"uri": URI}, "position": {"line": line, "character": character}}

    def end(self) -> None:
        self.ask("shutdown", None)
        self.send(method="exit")
        self.process.wait()


def write_large(path: Path) -> None:
    """Write the library of bench_repl.py into a file; clips, which nobody plays here, have two frames."""
    demo = open_library(demo_library())
    large = large_library(demo)
    names = large.by_name["Full-Body"].motions
    poses = demo.poses(demo.start)[:2]
    report = GraphReport(0, 0, 1.0, (), {}, ())
    graphs = tuple(large.by_name.values())
    write_database(
        BuiltLibrary(
            large.skeleton, large.frame_rate, large.up, large.start, dict.fromkeys(names, poses), graphs,
            tuple(report for _ in graphs), dict.fromkeys(names, "random.bvh"), (),
        ),
        path,
    )  # fmt: skip


def script(n_lines: int) -> str:
    """Return a script of random commands without a mistake."""
    draw = random.Random(4)
    lines = ("{} for {} sec", "{} with Upper-Body {} for {} sec", "({} or {}) for {} sec")
    made = []
    for at in range(n_lines):
        words = [f"TAG_{draw.randrange(8_000)}" for _ in range(lines[at % 3].count("{}") - 1)]
        made.append(lines[at % 3].format(*words, draw.randint(1, 9)))
    return "\n".join(made) + "\n"


def starts(library: Path) -> Iterator[float]:
    """Yield how long cold processes take from their start until `initialize` is answered."""
    for _ in range(N_STARTS + 1):
        begin = time.perf_counter()
        client = Client(library)
        client.initialize()
        yield time.perf_counter() - begin
        client.end()


def measured(client: Client, n_lines: int) -> Mapping[str, list[float]]:
    """Return how long things take in a script."""
    client.open(script(n_lines))
    draw = random.Random(5)
    client.edit(0, 0, 0, " ")
    found = {
        "diagnostics after an edit": [
            timed(lambda: client.edit(line_in(draw, n_lines), 0, 0, " ")) for _ in range(N_EDITS)
        ]
    }
    keys: list[float] = []
    line = n_lines // 2
    client.edit(line, 0, 0, "\n")
    for end, sign in enumerate(TYPED, 1):
        client.edit(line, end - 1, 0, sign)
        keys.append(timed(lambda end=end: client.ask("textDocument/completion", client.at(line, end))))
    found["completion at each key"] = keys
    asked = [client.at(line_in(draw, n_lines), 5) for _ in range(N_ASKED)]
    found["hover"] = [timed(lambda one=one: client.ask("textDocument/hover", one)) for one in asked]
    document = {"textDocument": {"uri": URI}}
    for method in ("documentSymbol", "foldingRange", "semanticTokens/full", "codeAction", "formatting"):
        more: dict[str, Any] = {"options": {"tabSize": 4, "insertSpaces": True}} if method == "formatting" else {}
        if method == "codeAction":
            place = client.at(line, 3)["position"]
            more = {"range": {"start": place, "end": place}, "context": {"diagnostics": []}}
        request = document | more
        found[method] = [timed(lambda m=method, r=request: client.ask(f"textDocument/{m}", r)) for _ in range(7)]
    client.send(method="textDocument/didClose", params=document)
    return found


def line_in(draw: random.Random, n_lines: int) -> int:
    return draw.randrange(n_lines)


def timed(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def p95(times: list[float]) -> float:
    return statistics.quantiles(times, n=20)[-1]


LIMITS = {
    1_000: {"diagnostics after an edit": 0.05, "completion at each key": 0.016, "hover": 0.01, "formatting": 0.1},
    10_000: dict.fromkeys(("diagnostics after an edit", "completion at each key", "hover", "codeAction"), 0.2)
    | dict.fromkeys(("documentSymbol", "foldingRange", "semanticTokens/full"), 0.2),
}


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder, "large.mlmg")
        write_large(library)
        bare = [sys.executable, "-c", "import pygls.lsp.server"]
        rows: list[tuple[str, float, float | None]] = [
            ("a cold Python that imports pygls, for comparison", median_s(bare), None)
        ]
        rows += [("initialize, cold", statistics.median(list(starts(library))[1:]), 0.6)]
        client = Client(library)
        client.initialize()
        for n_lines, limits in LIMITS.items():
            for label, times in measured(client, n_lines).items():
                rows.append((f"{label}, {n_lines:,} lines, p95", p95(times), limits.get(label)))
        client.end()
    for label, seconds, limit in rows:
        print(f"{label:<52} {seconds:8.4f} s {'' if limit is None else f'limit {limit:g} s'}")
    return int(any(limit is not None and seconds > limit for _, seconds, limit in rows))


if __name__ == "__main__":
    sys.exit(main())
