"""A script's text, and where in it things are."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A stretch of text: offsets in code points, `end` exclusive."""

    start: int
    end: int


@dataclass(frozen=True)
class Source:
    """A text with the name that messages call it by."""

    text: str
    name: str = "<script>"

    @cached_property
    def line_starts(self) -> tuple[int, ...]:
        """Return the offset at which each line begins; lines end in LF, CRLF or CR and in nothing else."""
        starts = [0]
        text = self.text
        for at, character in enumerate(text):
            if character == "\n" or (character == "\r" and text[at + 1 : at + 2] != "\n"):
                starts.append(at + 1)
        return tuple(starts)

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column of an offset, both from 1, in code points."""
        line = bisect_right(self.line_starts, offset)
        return line, offset - self.line_starts[line - 1] + 1

    def location(self, span: Span) -> tuple[int, int, int, int]:
        """Return (line, column, end line, end column) of a span, from 1, end exclusive."""
        return (*self.position(span.start), *self.position(span.end))

    def slice(self, span: Span) -> str:
        """Return the text of a span."""
        return self.text[span.start : span.end]
