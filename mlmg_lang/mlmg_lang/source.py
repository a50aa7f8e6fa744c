"""A script's text, and where in it things are."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A stretch of text: offsets in code points, `end` exclusive."""

    start: int
    end: int

    def shifted(self, distance: int) -> Span:
        """Return a stretch as long as this, further on by so much."""
        return Span(self.start + distance, self.end + distance)


@dataclass(frozen=True, slots=True)
class Edit:
    """A stretch of a text, and what takes its place."""

    span: Span
    replacement: str

    @property
    def further(self) -> int:
        """Return how much longer that makes the text."""
        return len(self.replacement) - (self.span.end - self.span.start)


@dataclass(frozen=True)
class Source:
    """A text with the name that messages call it by.

    Attributes
    ----------
    used : the files whose definitions it uses. Offsets go on in them, one after the other: where a text ends, its end
        is an offset too; the first of the next is the one after that.
    """

    text: str
    name: str = "<script>"
    used: tuple[Source, ...] = ()

    @cached_property
    def line_starts(self) -> tuple[int, ...]:
        """Return the offset at which each line begins; lines end in LF, CRLF or CR and in nothing else."""
        lines = self.text.replace("\r\n", " \n").replace("\r", "\n").split("\n")
        return tuple(accumulate(map((1).__add__, map(len, lines[:-1])), initial=0))

    @property
    def lines(self) -> list[str]:
        """Return the lines with their ends; the last has none, and may be empty."""
        return [self.text[start:end] for start, end in pairwise((*self.line_starts, len(self.text)))]

    @property
    def end(self) -> int:
        """Return the offset after the last of all files: where that of another would begin."""
        return len(self.text) + 1 + sum(len(other.text) + 1 for other in self.used)

    def file(self, offset: int) -> tuple[Source, int]:
        """Return the file that an offset lies in, and the offset of its beginning."""
        base = 0
        for file in (self, *self.used):
            if offset <= base + len(file.text):
                return file, base
            base += len(file.text) + 1
        raise ValueError(f"offset {offset} is in none of the files, which end at {self.end}")

    def base(self, file: Source) -> int:
        """Return the offset of the beginning of one of the files that are used."""
        before = (len(other.text) + 1 for other in (self, *self.used[: self.used.index(file)]))
        return sum(before)

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column of an offset in its file, both from 1, in code points."""
        if offset > len(self.text):
            file, base = self.file(offset)
            return file.position(offset - base)
        line = bisect_right(self.line_starts, offset)
        return line, offset - self.line_starts[line - 1] + 1

    def location(self, span: Span) -> tuple[int, int, int, int]:
        """Return (line, column, end line, end column) of a span in its file, from 1, end exclusive."""
        return (*self.position(span.start), *self.position(span.end))

    def slice(self, span: Span) -> str:
        """Return the text of a span."""
        file, base = (self, 0) if span.end <= len(self.text) else self.file(span.start)
        return file.text[span.start - base : span.end - base]
