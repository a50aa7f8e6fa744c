"""Whether the language server can stay open for weeks: does its memory grow?

    python benchmarks/soak_lsp.py [edits]

A real process over standard input and output, a library of 10,000 names and a script of about 1,000 lines. Between
random edits requests of all kinds are made, other texts are opened and closed, and the library is built anew under the
server; every 50 edits the script is what it was at first, as otherwise there would be nothing but mistakes. After the
first tenth of the edits, which is for warming up, memory is what the operating system says (VmRSS), each time all has
been answered; the median of the last tenth may not be 10 % above that of the second. Ends with code 1 if it is, or if
a request fails.
"""

from __future__ import annotations

import random
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from runpy import run_path

from bench_lsp import URI, Client, write_large

MADE = run_path(str(Path(__file__).parents[1] / "tests" / "lsp" / "random_edits.py"))
N_EDITS, N_LINES, ALLOWED = 100_000, 1_000, 1.1
N_LIBRARIES, BETWEEN_TEXTS, BETWEEN_SAVED, N_SAMPLES = 20, 50, 50, 400
REFUSED = (-32600, -32801, -32803)
"""What a request may be answered beside a result: it makes no sense here, or the text has changed."""
LINES = (
    *("TAG_{} for 3 sec\n", "TAG_{} with Upper-Body TAG_{} for 2 sec\n", "(TAG_{} or TAG_{}) for 40 frames\n", "\n"),
    *("end Upper-Body\n", "wait 2 sec\n", "# 走路 😀 {}\n", "let x = TAG_{}\n", "x for 2 sec\n", "Motion_{:04}\n"),
    *("repeat 2 {{ TAG_{}; Upper-Body TAG_{} }}\n", "choose {{\n| TAG_{}\n}}\n"),
)
MISTAKES = ("TGA_17 for 3 sec\n", "WALK with\n", "repeat 2 {\n", "let y = y\n", "TAG_5 four 3 sec\n")
METHODS = (
    *(
        "hover",
        "completion",
        "definition",
        "references",
        "documentHighlight",
        "signatureHelp",
        "codeAction",
        "codeLens",
    ),
    *("inlayHint", "selectionRange", "semanticTokens/range", "semanticTokens/full", "rangeFormatting", "rename"),
    *(
        "documentSymbol",
        "foldingRange",
        "documentLink",
        "formatting",
        "onTypeFormatting",
        "diagnostic",
        "prepareRename",
    ),
)
CONTEXTS: Mapping[str, object] = {"codeAction": {"diagnostics": []}, "references": {"includeDeclaration": True}}


def written() -> tuple[str, ...]:
    """Return lines with names of the library."""
    draw = random.Random(6)
    sound = (line.format(*(draw.randrange(2_000) for _ in range(2))) for line in LINES for _ in range(20))
    return (*sound, *MISTAKES)


def script() -> str:
    """Return a script with few mistakes."""
    draw, sound = random.Random(5), [line for line in written() if line.startswith(("TAG_", "(TAG_", "#"))]
    return "".join(draw.choice(sound) for _ in range(N_LINES))


class Editor:
    """A client whose author edits one text."""

    def __init__(self, library: Path) -> None:
        self.library = library
        self.client = Client(library)
        self.client.initialize()
        self.draw = random.Random(7)
        self.saved, n_lines = script(), (N_LINES * 9 // 10, N_LINES * 11 // 10)
        self.author = MADE["Author"](8, self.saved, written(), n_lines)
        self.client.open(self.author.text)
        self.n_edits = self.n_requests = 0

    def edit(self) -> None:
        """Make one edit, without waiting for what is said of it."""
        before, is_restored = self.author.text, self.n_edits % BETWEEN_SAVED == BETWEEN_SAVED - 1
        edit = self.author.take_back(self.saved) if is_restored else self.author.edit()
        self.client.version += 1
        document = {"uri": URI, "version": self.client.version}
        changes = MADE["as_sent"](before, edit, "utf-16")
        self.client.send(method="textDocument/didChange", params={"textDocument": document, "contentChanges": changes})
        self.n_edits += 1

    def ask(self) -> None:
        """Ask something of a random place."""
        offset = self.draw.randint(0, len(self.author.text))
        at = MADE["position"](self.author.text, offset, "utf-16")
        ends = {"start": at, "end": {"line": at["line"] + 3, "character": 0}}
        params = {"textDocument": {"uri": URI}, "position": at, "range": ends, "positions": [at], "ch": "\n"}
        params |= {"newName": "anew"}
        params |= {"options": {"tabSize": 4, "insertSpaces": True}}
        method = self.draw.choice(METHODS)
        params |= {"context": CONTEXTS[method]} if method in CONTEXTS else {}
        self.client.number += 1
        number = self.client.number
        self.client.send(id=number, method=f"textDocument/{method}", params=params)
        answer = self.client.until(lambda one: one.get("id") == number)
        if answer.get("error", {"code": REFUSED[0]})["code"] not in REFUSED:
            around = self.author.text[max(offset - 80, 0) : offset + 80]
            raise SystemExit(f"{method} at {at} in the middle of {around!r}: {answer}")
        self.n_requests += 1

    def other_text(self) -> None:
        """Open another text, and close it again."""
        document = {"uri": f"untitled:{self.draw.randrange(1000)}", "languageId": "motion-script", "version": 1}
        text = self.saved[: self.draw.randrange(8_000)]
        self.client.send(method="textDocument/didOpen", params={"textDocument": document | {"text": text}})
        if self.draw.random() < 0.7:
            self.client.ask("textDocument/documentSymbol", {"textDocument": document})
        self.client.send(method="textDocument/didClose", params={"textDocument": document})

    def build_library(self) -> None:
        """Put another file in the place of the library."""
        built = Path(shutil.copy(self.library, self.library.with_suffix(".new")))
        built.replace(self.library)
        changes = [{"uri": self.library.as_uri(), "type": 2}]
        self.client.send(method="workspace/didChangeWatchedFiles", params={"changes": changes})

    def resident_bytes(self) -> int:
        """Return how much memory the server has, once all has been answered."""
        self.client.ask("textDocument/foldingRange", {"textDocument": {"uri": URI}})
        status = Path(f"/proc/{self.client.process.pid}/status").read_text(encoding="ascii")
        return 1024 * int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")))


def samples(editor: Editor, n_edits: int) -> Iterator[tuple[int, int]]:
    """Yield, ever again, how many edits there have been and how much memory there is."""
    sampled, between = 0, max(n_edits // N_SAMPLES, 1)
    while editor.n_edits < n_edits:
        for _ in range(editor.draw.choice((1, 2, 4, 8, 16))):
            editor.edit()
            if editor.n_edits % BETWEEN_TEXTS == 0:
                editor.other_text()
            if editor.n_edits % max(n_edits // N_LIBRARIES, 1) == 0:
                editor.build_library()
        editor.client.diagnostics()
        editor.ask()
        if editor.n_edits // between > sampled:
            sampled = editor.n_edits // between
            yield editor.n_edits, editor.resident_bytes()


def growth(found: Mapping[int, int], n_edits: int) -> float:
    """Return how many times as much memory there is in the last tenth of the edits as in the second."""
    tenth = n_edits // 10
    early = [size for at, size in found.items() if tenth <= at < 2 * tenth]
    late = [size for at, size in found.items() if at >= 9 * tenth]
    return statistics.median(late) / statistics.median(early)


def main() -> int:
    n_edits = int(sys.argv[1]) if len(sys.argv) > 1 else N_EDITS
    begin = time.perf_counter()
    found: dict[int, int] = {}
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder, "large.mlmg")
        write_large(library)
        editor = Editor(library)
        for at, size in samples(editor, n_edits):
            found[at] = size
            if len(found) % (N_SAMPLES // 20) == 1:
                n_lines = editor.author.text.count("\n")
                print(f"{at:>7} edits  {size / 2**20:7.1f} MiB  {n_lines} lines", flush=True)
        editor.client.end()
    times = growth(found, n_edits)
    print(f"{editor.n_edits} edits and {editor.n_requests} requests in {time.perf_counter() - begin:.0f} s")
    print(f"memory after them: {times:.3f} times that after warming up; limit {ALLOWED:g}")
    return int(times > ALLOWED)


if __name__ == "__main__":
    sys.exit(main())
