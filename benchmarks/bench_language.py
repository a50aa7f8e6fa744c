"""How fast scripts are checked, checked again after an edit, and formatted, beside lark's bare parse in the same run.

    python benchmarks/bench_language.py [--lines 100000]

Nothing is played; names are looked up in the demo library. Work inside this process is told in processor time, so that
other programs hardly matter; whole commands in the time that a person waits, of several cold processes the median.
Ends with code 1 where a limit is missed.
"""

from __future__ import annotations

import argparse
import gc
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import lark
from bench_commands import SHORT, median_s

from mlmg_grammar import SCRIPT, grammar_text
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.source import Source
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.library import Library, open_library

N_EDITED_LINES = 10_000
N_EDITS = 7
N_SAMPLED_LINES = 2_000

# Of each line of a script one with another number, from 1 to some hundred.
PATTERNS = (
    "WALK for {} sec",
    "Walk_01 with Upper-Body (TALK and IDLE) for {} sec",
    "SWING_HAND for {} min  # with a comment",
    "IDLE and not Music for {} sec",
    "wait {} frames",
    "WALK or IDLE with Sub WAVE_HAND for {} sec",
    "Upper-Body (TALK or Music) for {} min",
    "Talk_02 for {} sec",
    "WALK with Upper-Body TALK for {} sec",
    "not (WALK or TALK) for {} cycles",
)


@dataclass(frozen=True)
class Row:
    label: str
    seconds: float
    limit_s: float | None = None
    note: str = ""

    @property
    def misses(self) -> bool:
        return self.limit_s is not None and self.seconds > self.limit_s

    def __str__(self) -> str:
        limit = "" if self.limit_s is None else f"{self.limit_s:.3g}"
        return f"{self.label:<52} {self.seconds:9.3f} {limit:>7}  {self.note}".rstrip()


def script(n_lines: int) -> str:
    """Return a script without a mistake, no line of which is like another."""
    lines = (PATTERNS[at % len(PATTERNS)].format(f"{1 + at / 1000:.3f}") for at in range(n_lines))
    return "".join(f"{line}\n" for line in lines)


def cpu_s(work: Callable[[], object]) -> float:
    """Return the processor time of some work."""
    gc.collect()
    begin = time.process_time()
    work()
    return time.process_time() - begin


def bare_parser(text: str, positions: bool) -> lark.Lark:
    """Return lark's own parser of the grammar, with the lexer that is faster on a sample."""
    parsers = [
        lark.Lark(grammar_text(), parser="lalr", lexer=lexer, start=SCRIPT, propagate_positions=positions)
        for lexer in ("basic", "contextual")
    ]
    return min(parsers, key=lambda parser: min(cpu_s(lambda: parser.parse(text)) for _ in range(3)))


def checking(n_lines: int, library: Library) -> list[Row]:
    """Measure the check of a long script, and lark's bare parse of it."""
    text, sample = script(n_lines), script(N_SAMPLED_LINES)
    bare, positioned = (bare_parser(sample, positions) for positions in (False, True))
    bare_s, parse_s = cpu_s(lambda: bare.parse(text)), cpu_s(lambda: positioned.parse(text))
    analyse(Source(sample), library)
    told: list[Diagnostic] = []
    check_s = cpu_s(lambda: told.extend(analyse(Source(text), library).diagnostics))
    assert not told, told[:3]
    return [
        Row(f"lark's bare parse of {n_lines:,} lines, no positions", bare_s),
        Row("the same with positions, which every node has here", parse_s, None, f"{parse_s / bare_s:.2f} times that"),
        Row(f"check of {n_lines:,} lines", check_s, 3 * parse_s, f"{check_s / parse_s:.2f} times that; limit 3 times"),
        Row("the same without a library", cpu_s(lambda: analyse(Source(text)))),
    ]


DEFINED = "let move = WALK or IDLE\nlet talk(x, t = 2 sec) = x with Upper-Body TALK for t\nlet seldom = not WALK\n"


def defining(n_lines: int) -> str:
    """Return a script in which one line in ten uses a definition, and five use another."""
    lines = script(n_lines).splitlines(keepends=True)
    lines[::10] = [f"move for {1 + at / 1000:.3f} sec\n" for at in range(len(lines[::10]))]
    lines[7 :: n_lines // 5] = ["seldom for 1.5 sec\n"] * 5
    return DEFINED + "".join(lines)


def editing(library: Library) -> list[Row]:
    """Measure what an editor waits for after one character has been typed somewhere in a script."""
    text, with_lets, short = script(N_EDITED_LINES), defining(N_EDITED_LINES), script(1_000)
    block = f"repeat 2 {{\n{short}}}\n"
    cases = (
        ("again after an edit", text, None, 0.010),
        ("the same, with definitions", with_lets, None, 0.010),
        ("the same, behind an open parenthesis", text.replace("WALK for", "WALK and (IDLE for", 1), None, 0.010),
        ("the first motion", text, ("WALK for 1.0", "Walk_01 for 1.0"), 0.010),
        ("a definition that five lines use", with_lets, ("not WALK", "not TALK"), None),
        ("a definition that a thousand lines use", with_lets, ("WALK or IDLE", "WALK or TALK"), None),
        ("in a block of 1,000 lines", block, None, 0.050),
        ("in a block of 10,000 lines", f"repeat 2 {{\n{text}}}\n", None, None),
        ("behind a brace that is open above 1,000 lines", block.removesuffix("}\n"), None, 0.050),
        ("such a brace typed", short, (short, f"repeat 2 {{\n{short}"), 0.050),
    )
    return [Row(label, _again_s(text, edit, library), limit) for label, text, edit, limit in cases]


def _again_s(text: str, edit: tuple[str, str] | None, library: Library) -> float:
    """Return the median over places in a script, or over several times the same edit."""
    # What an edit needs to know of each piece is put together once; an editor can have that done while nobody types.
    previous = analyse(Source(text), library)
    _ = previous.ready
    times = []
    for number in range(N_EDITS):
        at = text.index(".", len(text) * number // N_EDITS) + 1
        edited = text[:at] + "7" + text[at:] if edit is None else text.replace(*edit, 1)
        times.append(cpu_s(partial(analyse_again, previous, Source(edited))))
    return statistics.median(times)


def odd_texts() -> dict[str, str]:
    """Return 10 MB of what nobody would write, and 10,000 nested parentheses."""
    size, draw = 10_000_000, random.Random(0)
    letters = [chr(code) for code in range(0x3000) if not 0xD800 <= code < 0xE000]
    return {
        "10 MB in one line": "WALK and " * (size // 9) + "WALK",
        "10 MB in one name": "W" * size,
        "10 MB of random Unicode": "".join(draw.choices(letters, k=size)),
        "10 MB of (": "(" * size,
        '10 MB of "': '"' * size,
        "10 MB of spaces behind a quote": '"W' + " " * size + "x",
        "10 MB of ( behind a quote": '"' + "(" * size,
        "10 million wide (": "\uff08" * size,
        "10 MB of :": ":" * size,
        "10 MB of WALK with": "WALK with " * (size // 10),
        "10,000 nested parentheses": "(" * 10_000 + "WALK" + ")" * 10_000,
    }


def bounds(library: Library) -> list[Row]:
    """Measure the check of texts that nobody would write; memory is the most of this process so far."""
    rows = []
    for label, text in odd_texts().items():
        seconds = cpu_s(partial(analyse, Source(text), library))
        rows.append(
            Row(label, seconds, 10.0, f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024} MB so far")
        )
    return rows


def formatting(n_lines: int) -> list[Row]:
    """Measure the formatter."""
    from mlmg_lang.formatting.format_script import format_source

    sources = {n: Source(script(n)) for n in (1_000, n_lines)}
    format_source(sources[1_000])
    return [Row(f"formatting {n:,} lines", cpu_s(partial(format_source, source))) for n, source in sources.items()]


def starting(library: Library) -> list[Row]:
    """Measure how long a person waits for the check of a small script."""
    check = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "check"]
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder, "small.ms")
        small.write_text(SHORT, encoding="utf-8")
        subprocess.run([*check, "--library", str(library.path), str(small)], check=True, capture_output=True)
        return [
            Row("a cold Python that does nothing, for comparison", median_s([sys.executable, "-c", "pass"])),
            Row("mlmg check, a small script, cold, no library", median_s([*check, str(small)]), 0.2),
            Row(
                "mlmg check, a small script, cold, with a library",
                median_s([*check, "--library", str(library.path), str(small)]),
                0.2,
            ),
        ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lines", type=int, default=100_000, help="of the long script")
    options = parser.parse_args()
    library = open_library(demo_library())
    missed = 0
    print(f"{'':<52} {'seconds':>9} {'limit':>7}")
    for rows in (
        starting(library),
        editing(library),
        bounds(library),
        formatting(options.lines),
        checking(options.lines, library),
    ):
        for row in rows:
            print(row, flush=True)
            missed += row.misses
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
