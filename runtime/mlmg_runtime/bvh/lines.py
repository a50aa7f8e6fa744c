"""The lines of a BVH file, one after another, and the errors that point at them."""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass, field

from mlmg_runtime.errors import BvhError

BLANKS = " \t\v\f"
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_PART = re.compile(r"[{}]|[^{}]+")
_SHOWN = 40


@dataclass(slots=True)
class Lines:
    """A place in the text of a file. Lines end in a newline alone: other ends have been replaced.

    Attributes
    ----------
    data : the whole text.
    name : of the file, for errors.
    position : where in `data` the next line starts.
    line : number of the line that was taken last, from 1.
    warnings : what was odd so far.
    """

    data: bytes
    name: str
    position: int = 0
    line: int = 0
    warnings: list[str] = field(default_factory=list)
    _parts: deque[str] = field(default_factory=deque)

    def next_line(self) -> str | None:
        """Return the next line that is not blank, without the blanks around it, or None at the end."""
        while self.position < len(self.data):
            end = self.data.find(b"\n", self.position)
            end = len(self.data) if end < 0 else end
            text = self._decoded(self.data[self.position : end]).strip(BLANKS)
            self.position = end + 1
            self.line += 1
            if text:
                return text
        return None

    def next_part(self) -> str | None:
        """Return the next brace, or the next stretch of a line without braces, or None at the end."""
        while not self._parts:
            line = self.next_line()
            if line is None:
                return None
            self._parts.extend(part.strip(BLANKS) for part in _PART.findall(line) if part.strip(BLANKS))
        return self._parts.popleft()

    def error(self, expected: str, found: str, line: int | None = None) -> BvhError:
        """Return the error that the line taken last, or `line`, holds `found` where `expected` should be."""
        return BvhError(self.name, line or self.line or None, f"expected {expected}, found {found}")

    def number(self, word: str, what: str) -> float:
        """Return the finite decimal number that `word` spells; `what` says in an error what it is."""
        if _NUMBER.fullmatch(word):
            value = float(word)
            if abs(value) < float("inf"):
                return value
        raise self.error(what, shown(word))

    def _decoded(self, line: bytes) -> str:
        try:
            return line.decode("utf-8")
        except UnicodeDecodeError:
            self.warnings.append(f"line {self.line + 1} is not UTF-8: read as Latin-1")
            return line.decode("latin-1")


def shown(text: str | None) -> str:
    """Return `text` as errors quote it: short, without control characters; None is the end of the file."""
    if not text:
        return "the end of the file" if text is None else "nothing"
    short = text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
    return "`" + "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in short) + "`"
