"""How long an editor waits for the language server: real processes, over standard input and output.

    python benchmarks/bench_lsp.py [PART OF A LABEL]

On a library of 10,000 names, made of random numbers as in bench_repl.py, and scripts of 1,000 and 10,000 lines. Starts
are cold processes, up to the answer to `initialize`. Before whatever is asked a line is edited, as answers are kept
while a text stays the same. Beside the time that a client waits stands what the server has computed for that time: on
a machine that does something else too, the first is much longer. Ends with code 1 where a limit is missed.
"""

from __future__ import annotations

import json
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from bench_commands import median_s
from bench_repl import large_library

from mlmg_runtime.built_library import BuiltLibrary, GraphReport
from mlmg_runtime.database import write_database
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.library import open_library

N_STARTS, N_EDITS, N_ASKED = 7, 60, 20
URI, DIAGNOSTICS = "untitled:bench.ms", "textDocument/publishDiagnostics"
TYPED = "TAG_17 with Upper-Body TAG_4021 for 10 sec"
HEAD = "let stroll = TAG_1 with Upper-Body TAG_2 for 4 sec\nlet wave(part = TAG_3) = TAG_4 with Upper-Body part\n"
CLIENT: Final[Mapping[str, Any]] = {
    "textDocument": {
        "codeAction": {"resolveSupport": {"properties": ["edit"]}, "dataSupport": True},
        "completion": {"completionItem": {"snippetSupport": True}},
        "publishDiagnostics": {"relatedInformation": True, "tagSupport": {"valueSet": [1, 2]}},
    },
    "workspace": {
        "workspaceEdit": {"documentChanges": True},
        **{name: {"refreshSupport": True} for name in ("inlayHint", "semanticTokens", "codeLens")},
    },
}
Times = tuple[float, float]
"""How long a client waits, and how long the server computes meanwhile; 0 where that cannot be told."""
Timed = tuple[str, list[Times]]


class Client:
    """A client that waits for each answer."""

    def __init__(self, library: Path) -> None:
        program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "lsp", "--library", str(library)]
        self.process = subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.number = self.version = 0
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.stdin, self.stdout = self.process.stdin, self.process.stdout
        self.told: Mapping[str, Any] = {}

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
            message = json.loads(body)
            if "method" in message and "id" in message:
                self.send(id=message["id"], result=None)
            if message.get("method") == DIAGNOSTICS and message["params"]["uri"] == URI:
                self.told = message["params"]
            if wanted(message):
                return message

    def ask(self, method: str, params: Any) -> Any:
        self.number += 1
        self.send(id=self.number, method=method, params=params)
        answer = self.until(lambda one: one.get("id") == self.number)
        assert "error" not in answer, answer
        return answer["result"]

    def initialize(self) -> None:
        self.ask("initialize", {"processId": os.getpid(), "rootUri": None, "capabilities": CLIENT})
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
        """Return what is said of the text as it is now, which may have come before the answer to something else."""
        while self.told.get("version") != self.version:
            self.until(lambda one: one.get("method") == DIAGNOSTICS)
        return list(self.told["diagnostics"])

    def computed_s(self) -> float:
        """Return how long the process has computed, on all processors together."""
        # The clock of another process, as clock_getcpuclockid(3) makes it.
        return time.clock_gettime((~self.process.pid << 3) | 2) if sys.platform == "linux" else 0.0

    def timed(self, work: Callable[[], object]) -> Times:
        begin, computed = time.perf_counter(), self.computed_s()
        work()
        return time.perf_counter() - begin, self.computed_s() - computed

    def close(self) -> None:
        self.send(method="textDocument/didClose", params={"textDocument": {"uri": URI}})

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


# --- scripts ---

COMMANDS = (
    "{} for {} sec", "{} with Upper-Body {} for {} sec", "({} or {}) for {} sec", "TAG_1 for {} sec", "stroll",
    "wave(part = {}) for {} sec",
)  # fmt: skip
COMMON, DEFINED, ANY = (re.compile(start) for start in ("TAG_1 for", "stroll$", "TAG_"))
BLOCK = ("repeat 2 {\n", "    ({} or\n        {}) for {} sec\n", "    # a comment\n    # on two lines\n", "}\n")


def script(n_lines: int) -> str:
    """Return a script of random commands without a mistake; one has the same tag, one the same definition in six."""
    draw = random.Random(4)
    made = [HEAD]
    at = HEAD.count("\n")
    while at < n_lines:
        form = "".join(BLOCK) if at % 50 == 0 and at + 6 <= n_lines else f"{COMMANDS[at % len(COMMANDS)]}\n"
        made.append(filled(form, draw))
        at += form.count("\n")
    return "".join(made)


def filled(form: str, draw: random.Random) -> str:
    """Return a form with random tags, and a number where its last one is."""
    n_holes = form.count("{}")
    words = [f"TAG_{draw.randrange(8_000)}" for _ in range(n_holes - 1)]
    for word in (*words, str(draw.randint(1, 9)))[:n_holes]:
        form = form.replace("{}", word, 1)
    return form


def mistaken(text: str, n_mistakes: int) -> str:
    """Return a script with so many names in it that nothing has."""
    lines = text.splitlines(keepends=True)
    for at in range(2, len(lines), len(lines) // n_mistakes):
        lines[at] = lines[at].replace("TAG_", "TAH_", 1)
    return "".join(lines)


# --- what is asked ---


@dataclass(frozen=True)
class Asking:
    """What is asked at a place, beside the text that is meant.

    Attributes
    ----------
    on : the lines in which it is asked.
    """

    label: str
    method: str
    more: Callable[[dict[str, int]], dict[str, Any]] = lambda place: {"position": place}
    on: re.Pattern[str] = ANY


def around(place: dict[str, int], n_lines: int = 0) -> dict[str, Any]:
    return {"range": {"start": place, "end": {"line": place["line"] + n_lines, "character": place["character"]}}}


def nothing(_place: dict[str, int]) -> dict[str, Any]:
    return {}


FORMAT: Final = {"options": {"tabSize": 4, "insertSpaces": True}}
DECLARED: Final = {"context": {"includeDeclaration": True}}
UNDIAGNOSED: Final[Mapping[str, Any]] = {"context": {"diagnostics": []}}
FIRST: Final = {"line": 0, "character": len("let s")}
EVERYWHERE: Final = {"line": 0, "character": 0}
N_ALL: Final = 1 << 20
ASKED: Final = (
    Asking("hover", "hover"),
    Asking("definition", "definition", on=DEFINED),
    Asking("references of a common tag", "references", lambda at: {"position": at, **DECLARED}, COMMON),
    Asking("highlights of a common tag", "documentHighlight", on=COMMON),
    Asking("prepare rename", "prepareRename", on=DEFINED),
    Asking("rename a definition", "rename", lambda at: {"position": at, "newName": "amble"}, DEFINED),
    Asking("document links", "documentLink", nothing),
    Asking("signature help", "signatureHelp"),
    Asking("outline", "documentSymbol", nothing),
    Asking("folding", "foldingRange", nothing),
    Asking("lenses", "codeLens", nothing),
    Asking("selection range", "selectionRange", lambda at: {"positions": [at]}),
    Asking("inlay hints of 60 lines", "inlayHint", lambda at: around(at, 60)),
    Asking("inlay hints of all", "inlayHint", lambda _: around(EVERYWHERE, N_ALL)),
    Asking("semantic tokens, full", "semanticTokens/full", nothing),
    Asking("semantic tokens of 60 lines", "semanticTokens/range", lambda at: around(at, 60)),
    Asking("code actions", "codeAction", lambda at: {**around(at), **UNDIAGNOSED}),
    Asking("code actions of a definition", "codeAction", lambda _: {**around(FIRST), **UNDIAGNOSED}),
    Asking("code actions of all", "codeAction", lambda _: {**around(EVERYWHERE, N_ALL), **UNDIAGNOSED}),
    Asking("formatting", "formatting", lambda _: FORMAT),
    Asking("formatting of 20 lines", "rangeFormatting", lambda at: {**around(at, 20), **FORMAT}),
    Asking("formatting as one types", "onTypeFormatting", lambda at: {"position": at, "ch": "\n", **FORMAT}),
    Asking("pulled diagnostics", "diagnostic", nothing),
)
OPENING: Final = (
    "opening, up to the first diagnostics",
    *(f"{what} while it is read" for what in ("hover", "semantic tokens", "lenses", "an edit")),
)
ALL_READ: Final = "opening, up to the outline"
OF_MISTAKES: Final = (*OPENING, ALL_READ, "diagnostics after an edit", "hover", "pulled diagnostics")
"""What is asked of a script with mistakes."""


def starts(library: Path) -> Iterator[Times]:
    """Yield how long cold processes take from their start until `initialize` is answered."""
    for _ in range(N_STARTS + 1):
        begin = time.perf_counter()
        client = Client(library)
        client.initialize()
        yield time.perf_counter() - begin, client.computed_s()
        client.end()


def measured(client: Client, text: str, asked: Collection[str]) -> Iterator[Timed]:
    """Yield how long things take in a script, by their labels."""
    draw, lines = random.Random(5), text.splitlines()
    edited = [at for at, line in enumerate(lines) if ANY.match(line) and not COMMON.match(line)]
    yield from opening(client, text, edited[:50])
    change(client, draw, edited)
    if "diagnostics after an edit" in asked:
        yield (
            "diagnostics after an edit",
            [client.timed(lambda: change(client, draw, edited)) for _ in range(N_EDITS)],
        )
    for asking in ASKED:
        if asking.label in asked:
            places = [at for at, line in enumerate(lines) if asking.on.match(line)]
            yield asking.label, list(answers(client, asking, draw, places, edited))
    if "completion at each key" in asked:
        yield "completion at each key", list(keys(client, len(lines) // 2))
    client.close()


def opening(client: Client, text: str, first: Sequence[int]) -> Iterator[Timed]:
    """Open a script, and yield how long that takes, and what is asked of some of its first lines meanwhile."""
    document = {"textDocument": {"uri": URI}}
    place = {**document, "position": {"line": first[0], "character": 2}}
    works = (
        lambda: client.open(text),
        lambda: client.ask("textDocument/hover", place),
        lambda: client.ask("textDocument/semanticTokens/full", document),
        lambda: client.ask("textDocument/codeLens", document),
        lambda: change(client, random.Random(3), first),
        lambda: client.ask("textDocument/documentSymbol", document),
    )
    times = [client.timed(work) for work in works]
    yield from ((label, [one]) for label, one in zip(OPENING, times, strict=False))
    yield ALL_READ, [(sum(waited for waited, _ in times), sum(computed for _, computed in times))]


def change(client: Client, draw: random.Random, lines: Sequence[int]) -> None:
    """Make another tag of the first in one of some lines; all stays in its place."""
    client.edit(draw.choice(lines), len("TAG_"), 1, str(draw.randint(1, 7)))


def answers(
    client: Client, asking: Asking, draw: random.Random, lines: Sequence[int], edited: Sequence[int]
) -> Iterator[Times]:
    """Yield how long answers take at some lines, each after an edit."""
    for _ in range(N_ASKED):
        change(client, draw, edited)
        params = {"textDocument": {"uri": URI}, **asking.more({"line": draw.choice(lines), "character": 2})}
        yield client.timed(lambda params=params: client.ask(f"textDocument/{asking.method}", params))


def keys(client: Client, line: int) -> Iterator[Times]:
    """Yield how long completion takes at each key of a command that is written above a line."""
    client.edit(line, 0, 0, "\n")
    for end, sign in enumerate(TYPED, 1):
        client.edit(line, end - 1, 0, sign)
        place = {"textDocument": {"uri": URI}, "position": {"line": line, "character": end}}
        yield client.timed(lambda place=place: client.ask("textDocument/completion", place))


def quantiles(times: Sequence[float]) -> tuple[float, float]:
    """Return the median and the 95th percentile."""
    return statistics.median(times), times[0] if len(times) == 1 else statistics.quantiles(times, n=20)[-1]


LIMITS: Final[Mapping[int, Mapping[str, float]]] = {
    1_000: {"diagnostics after an edit": 0.05, "completion at each key": 0.016, "hover": 0.01, "formatting": 0.1},
    10_000: {},
}
"""In seconds, for 95 of 100; all else may take `LONGEST_S`."""
LONGEST_S: Final = 0.2


def main() -> int:
    words = " ".join(sys.argv[1:])
    labels = [
        *OPENING,
        ALL_READ,
        *(asking.label for asking in ASKED),
        "diagnostics after an edit",
        "completion at each key",
    ]
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder, "large.mlmg")
        write_large(library)
        if not words:
            bare = [sys.executable, "-c", "import pygls.lsp.server"]
            print(f"{'a cold Python that imports pygls, for comparison':<60} p50 {median_s(bare):8.4f} s")
            missed += told("initialize, cold", list(starts(library))[1:], 0.6)
        client = Client(library)
        client.initialize()
        for n_lines, limits in LIMITS.items():
            texts = (
                (f"{n_lines:,} lines: ", script(n_lines), labels),
                (f"{n_lines:,} lines, 500 mistakes: ", mistaken(script(n_lines), 500), OF_MISTAKES),
            )
            for what, text, some in texts:
                asked = [label for label in some if words in f"{what}{label}"]
                for label, times in measured(client, text, asked) if asked else ():
                    missed += told(f"{what}{label}", times, limits.get(label, LONGEST_S))
        client.end()
    return int(missed > 0)


def told(label: str, times: Sequence[Times], limit: float) -> bool:
    """Tell how long something took; return whether that was too long."""
    (half, most), (_, computed) = (quantiles(column) for column in zip(*times, strict=True))
    verdict = "" if most <= limit else "  MISSED"
    row = f"{label:<60} p50 {half:8.4f} s  p95 {most:8.4f} s  computed {computed:8.4f} s  limit {limit:g} s{verdict}"
    print(row, flush=True)
    return most > limit


if __name__ == "__main__":
    sys.exit(main())
