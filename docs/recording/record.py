"""Records a session of `mlmg repl` as an animated SVG: keys typed into a real terminal, and what it shows.

    python docs/recording/record.py docs/session.svg

What is shown is what the terminal showed; only the pauses are even, so that it can be read.
"""

from __future__ import annotations

import os
import pty
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from html import escape
from itertools import groupby
from pathlib import Path

import pyte

COLUMNS, ROWS = 88, 26
KEY_S, READ_S, LAST_S = 0.06, 2.2, 5.0
QUIET_S, PATIENCE_S = 0.35, 30.0
COLOURS = {
    "default": "#d4d7dd",
    "red": "#ef6b73",
    "green": "#8fcf8b",
    "brown": "#e5c07b",
    "blue": "#6cb0f2",
    "magenta": "#c88ce0",
    "cyan": "#5cc3cf",
    "brightblack": "#7d8590",
}
BACKGROUND, MENU = "#16181d", "#2a2e37"
WIDTH_PX, HEIGHT_PX, PAD_PX = 8.4, 18.0, 12.0


@dataclass(frozen=True)
class Moment:
    """What the terminal shows, for how long."""

    lines: tuple[str, ...]
    seconds: float


@dataclass
class Recorder:
    """A terminal with a program in it, and the moments that have been recorded."""

    master: int
    screen: pyte.Screen
    stream: pyte.ByteStream
    moments: list[Moment] = field(default_factory=list)

    def key(self, keys: bytes, seconds: float) -> None:
        """Press keys, wait until the terminal is quiet, and record what it shows."""
        os.write(self.master, keys)
        self.settle()
        self.moments.append(Moment(tuple(_drawn(self.screen)), seconds))

    def settle(self) -> None:
        """Take in what the program writes until it writes no more."""
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline and select.select([self.master], [], [], QUIET_S)[0]:
            self.stream.feed(os.read(self.master, 1 << 16))


def main(output: str) -> None:
    """Record the session of session.txt and write it."""
    lines = (Path(__file__).parent / "session.txt").read_text(encoding="utf-8").splitlines()
    with tempfile.TemporaryDirectory() as folder:
        recorder = _started(Path(folder))
        for line in (one for one in lines if not one.startswith("#")):
            _type(recorder, line)
    moments = [*recorder.moments[:-1], Moment(recorder.moments[-1].lines, LAST_S)]
    Path(output).write_text(svg(moments), encoding="utf-8")


def _started(folder: Path) -> Recorder:
    """Start the program in a terminal of its own, with no history."""
    master, slave = pty.openpty()
    screen = pyte.Screen(COLUMNS, ROWS)
    # The prompt asks where the cursor is, which a terminal answers.
    screen.write_process_input = lambda answer: os.write(master, answer.encode())
    environment = {**os.environ, "MLMG_HISTORY": str(folder / "history"), "TERM": "xterm-256color"}
    environment |= {"COLUMNS": str(COLUMNS), "LINES": str(ROWS)}
    environment.pop("NO_COLOR", None)
    program = Path(sys.executable).with_name("mlmg")
    subprocess.run(["stty", "cols", str(COLUMNS), "rows", str(ROWS)], stdin=slave, check=True)
    subprocess.Popen(
        [program, "repl"], stdin=slave, stdout=slave, stderr=subprocess.DEVNULL, cwd=folder, env=environment
    )
    recorder = Recorder(master, screen, pyte.ByteStream(screen))
    deadline = time.monotonic() + PATIENCE_S
    while not any("Motion Script>>>" in line for line in screen.display) and time.monotonic() < deadline:
        recorder.settle()
    recorder.moments.append(Moment(tuple(_drawn(screen)), READ_S))
    return recorder


def _type(recorder: Recorder, line: str) -> None:
    for n, part in enumerate(line.split("<Tab>")):
        if n:
            recorder.key(b"\t", READ_S / 2)
        for letter in part:
            recorder.key(letter.encode(), KEY_S)
    recorder.key(b"\r", READ_S)


def _drawn(screen: pyte.Screen) -> Iterator[str]:
    """Yield each line of a screen as the inside of an SVG text."""
    for row in range(screen.lines):
        cells = [screen.buffer[row][column] for column in range(screen.columns)]
        runs = []
        at = 0
        for style, run in groupby(cells, key=lambda cell: (cell.fg, cell.bg, cell.bold, cell.underscore, cell.reverse)):
            text = "".join(cell.data for cell in run)
            runs.append(_run(text, at, *style))
            at += len(text)
        yield "".join(runs)


def _run(text: str, column: int, fg: str, bg: str, bold: bool, underline: bool, reverse: bool) -> str:
    if not text.strip() and bg == "default" and not reverse:
        return ""
    x = PAD_PX + column * WIDTH_PX
    width = len(text) * WIDTH_PX
    menu = f'<rect x="{x:.1f}" y="-13" width="{width:.1f}" height="18" fill="{MENU}"/>' if bg != "default" else ""
    colour = COLOURS.get(fg, COLOURS["default"] if bg == "default" else "#d4d7dd")
    style = (' font-weight="bold"' if bold else "") + (' text-decoration="underline"' if underline else "")
    kept = text.rstrip()
    length = len(kept) * WIDTH_PX
    told = f'<text x="{x:.1f}" textLength="{length:.1f}" fill="{colour}"{style}>{escape(kept)}</text>' if kept else ""
    return menu + told


def svg(moments: list[Moment]) -> str:
    """Return moments as an SVG that shows one after the other, again and again; each line is drawn once."""
    total = sum(one.seconds for one in moments)
    width, height = 2 * PAD_PX + COLUMNS * WIDTH_PX, 2 * PAD_PX + ROWS * HEIGHT_PX
    lines = [one for row in range(ROWS) for one in _spans(moments, row)]
    body, rules = [], []
    for number, (row, drawn, begin, end) in enumerate(lines):
        y = PAD_PX + row * HEIGHT_PX + 13
        moving = begin > 0 or end < total
        mark = f' class="l{number}"' if moving else ""
        body.append(f'<g transform="translate(0 {y:.0f})"{mark}>{drawn}</g>')
        if moving:
            rules.append(_rule(number, begin / total, end / total, total))
    style = "text{font:14px ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;white-space:pre}" + "".join(rules)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}">\n'
        f"<title>A session of mlmg repl</title>\n<style>{style}</style>\n"
        f'<rect width="100%" height="100%" rx="8" fill="{BACKGROUND}"/>\n' + "\n".join(body) + "\n</svg>\n"
    )


def _spans(moments: list[Moment], row: int) -> Iterator[tuple[int, str, float, float]]:
    """Yield what a row shows, from when until when; nothing where it is empty."""
    at = 0.0
    for drawn, run in groupby(moments, key=lambda one: one.lines[row]):
        begin, at = at, at + sum(one.seconds for one in run)
        if drawn:
            yield row, drawn, begin, at


def _rule(number: int, begin: float, end: float, total: float) -> str:
    """Return the style that shows a line for a part of the time only."""
    first, last = f"{100 * begin:.3f}%", f"{100 * end:.3f}%"
    before = "" if begin == 0 else f"0%{{visibility:hidden}}{first}{{visibility:visible}}"
    after = "" if end >= 1 else f"{last}{{visibility:hidden}}100%{{visibility:hidden}}"
    start = "0%{visibility:visible}" if begin == 0 else ""
    return (
        f"@keyframes k{number}{{{start}{before}{after}}}"
        f".l{number}{{animation:k{number} {total:.2f}s steps(1,end) infinite}}"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
