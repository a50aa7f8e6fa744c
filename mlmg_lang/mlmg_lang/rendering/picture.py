"""Places in a file -> the lines they are in, with what is meant underlined and words beside it.

    2 | WALK with Full-Body TALK
      | ----      ^^^^^^^^^
      | |
      | said here first

A stretch over several lines is underlined in each; of more than four, the first two and the last are drawn.
Of a long line only what is around the first place is drawn. Lines with letters that run from right to left get
invisible marks (U+200E) around what is underlined, so that it stays above its carets whether or not a terminal
turns the letters about.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from mlmg_lang.rendering.cells import Cell, cells, runs_right_to_left
from mlmg_lang.rendering.colour import BLUE, Painter
from mlmg_lang.rendering.wording import safe
from mlmg_lang.source import Source, Span

_LONGEST: Final = 120
"""The longest stretch of a line that is drawn, in columns."""
_AROUND: Final = 400
"""How much of a long line is looked at on either side of a place, in code points."""
_MOST_LINES: Final = 4
_LEFT_TO_RIGHT: Final = "\u200e"


@dataclass(frozen=True, slots=True)
class Mark:
    """A place to underline.

    Attributes
    ----------
    span : within its own file.
    sign : what it is underlined with.
    styles : of the sign and the words.
    """

    span: Span
    sign: str
    styles: tuple[str, ...]
    words: str = ""


@dataclass(frozen=True, slots=True)
class _Stroke:
    """The part of a mark that is in one line; offsets are those of the file."""

    start: int
    end: int
    mark: Mark
    words: str


@dataclass(frozen=True, slots=True)
class _Underline:
    """The same in columns of the drawn line."""

    start: int
    end: int
    mark: Mark
    words: str


def last_line(file: Source, marks: Iterable[Mark]) -> int:
    """Return the number of the last line that a picture shows, to make its edge wide enough."""
    return max(_rows(file, mark.span)[-1] for mark in marks)


def picture(file: Source, marks: Sequence[Mark], edge: str, paint: Painter) -> Iterator[str]:
    """Yield the rows that show some places of one file; `edge` is as wide as a number and the spaces beside it."""
    by_row: dict[int, list[_Stroke]] = {}
    for mark in marks:
        for row, stroke in _strokes(file, mark):
            by_row.setdefault(row, []).append(stroke)
    before = None
    for row in sorted(by_row):
        if before is not None and row == before + 2:
            yield from _line(file, before + 1, [], edge, paint)
        elif before is not None and row > before + 2:
            yield f" {paint('...', BLUE)}"
        yield from _line(file, row, by_row[row], edge, paint)
        before = row


# --- from places to lines ---


def _rows(file: Source, span: Span) -> list[int]:
    """Return the numbers of the lines in which a span is drawn."""
    first, _ = file.position(span.start)
    last, _ = file.position(max(span.start, span.end - 1))
    if last - first < _MOST_LINES:
        return list(range(first, last + 1))
    return [first, first + 1, last]


def _strokes(file: Source, mark: Mark) -> Iterator[tuple[int, _Stroke]]:
    rows = _rows(file, mark.span)
    for row in rows:
        begin, end = _line_span(file, row)
        if row != rows[0]:
            begin += len(file.text[begin:end]) - len(file.text[begin:end].lstrip())
        start, stop = max(begin, mark.span.start), min(end, mark.span.end)
        words = mark.words if row == rows[-1] else ""
        if start < stop or row == rows[0] or words:
            yield row, _Stroke(start, max(start, stop), mark, words)


def _line_span(file: Source, row: int) -> tuple[int, int]:
    """Return where a line begins and ends, without its line end."""
    starts = file.line_starts
    begin = starts[row - 1]
    end = starts[row] if row < len(starts) else len(file.text)
    while end > begin and file.text[end - 1] in "\r\n":
        end -= 1
    return begin, end


# --- one line ---


def _line(file: Source, row: int, strokes: Sequence[_Stroke], edge: str, paint: Painter) -> Iterator[str]:
    """Yield a line of the file and what is drawn below it."""
    begin, end = _line_span(file, row)
    view = _view(file.text, begin, end, strokes[0].start if strokes else begin)
    underlines = [_Underline(*view.columns(stroke.start, stroke.end), stroke.mark, stroke.words) for stroke in strokes]
    number = str(row).rjust(len(edge) - 2)
    yield f" {paint(f'{number} |', BLUE)} {view.text(underlines)}".rstrip()
    for drawn in _below(underlines):
        yield f"{edge}{paint('|', BLUE)} {_painted(drawn, paint)}"


@dataclass(frozen=True, slots=True)
class _View:
    """The part of a line that is drawn.

    Attributes
    ----------
    base : the offset in the file that the cells count from.
    lead, tail : signs that something is left out.
    """

    base: int
    cells: tuple[Cell, ...]
    lead: str
    tail: str

    def columns(self, start: int, end: int) -> tuple[int, int]:
        """Return the columns of a stretch of the file, at least one; what is not in view is drawn at the edge."""
        before = [cell.width for cell in self.cells if self.base + cell.end <= start]
        under = [cell.width for cell in self.cells if start < self.base + cell.end and self.base + cell.start < end]
        first = len(self.lead) + sum(before)
        if not before and self.lead and not under:
            first = 0
        return first, first + max(1, sum(under))

    def text(self, underlines: Iterable[_Underline]) -> str:
        """Return the line as it is drawn."""
        plain = "".join(cell.text for cell in self.cells)
        if not runs_right_to_left(plain):
            return self.lead + plain + self.tail
        borders = {border for one in underlines for border in (one.start, one.end)} | {len(self.lead)}
        pieces, column = [], len(self.lead)
        for cell in self.cells:
            pieces.append(_LEFT_TO_RIGHT + cell.text if column in borders else cell.text)
            column += cell.width
        return f"{self.lead}{''.join(pieces)}{_LEFT_TO_RIGHT}{self.tail}"


def _view(text: str, begin: int, end: int, focus: int) -> _View:
    """Return what is drawn of a line: all, or what is around a place in it."""
    low, high = max(begin, focus - _AROUND), min(end, focus + _AROUND)
    seen = list(cells(text[low:high]))
    if sum(cell.width for cell in seen) > _LONGEST:
        first = next((at for at, cell in enumerate(seen) if low + cell.end > focus), len(seen))
        first = _back(seen, first, _LONGEST // 4)
        seen = seen[first : _forth(seen, first, _LONGEST)]
    lead = "…" if seen and low + seen[0].start > begin else ""
    tail = "…" if seen and low + seen[-1].end < end else ""
    return _View(low, tuple(seen), lead, tail)


def _back(seen: Sequence[Cell], at: int, columns: int) -> int:
    """Return the index of the cell that is some columns before another, or as far as there are."""
    while at > 0 and columns >= seen[at - 1].width:
        at -= 1
        columns -= seen[at].width
    return at


def _forth(seen: Sequence[Cell], at: int, columns: int) -> int:
    """Return the index of the cell that is some columns behind another, or as far as there are."""
    while at < len(seen) and columns >= seen[at].width:
        columns -= seen[at].width
        at += 1
    return at


# --- below a line ---

_Row = list[tuple[str, tuple[str, ...]]]
"""What is drawn in each column, and its styles; words at the end are one piece."""


def _below(underlines: Sequence[_Underline]) -> Iterator[_Row]:
    """Yield the rows below a line: the underlining, then the words, from right to left."""
    if not underlines:
        return
    row = _blank(max(one.end for one in underlines))
    for one in reversed(underlines):  # the first stands above the others
        row[one.start : one.end] = [(one.mark.sign, one.mark.styles)] * (one.end - one.start)
    with_words = sorted((one for one in underlines if one.words), key=lambda one: one.start)
    if with_words and _is_last(with_words[-1], underlines):
        last = with_words.pop()
        row.append((f" {safe(last.words)}", last.mark.styles))
    yield row
    if with_words:
        yield _hanging(with_words)
    while with_words:
        last = with_words.pop()
        row = _hanging(with_words)
        row += _blank(last.start - len(row)) if last.start >= len(row) else []
        yield [*row[: last.start], (safe(last.words), last.mark.styles)]


def _is_last(one: _Underline, underlines: Iterable[_Underline]) -> bool:
    """Return whether nothing is drawn where words right behind an underlining would stand."""
    return all(other.end <= one.end for other in underlines)


def _hanging(underlines: Iterable[_Underline]) -> _Row:
    """Return a row with a line down from each underlining."""
    row: _Row = []
    for one in underlines:
        row += _blank(one.start - len(row))
        if len(row) == one.start:
            row.append(("|", one.mark.styles))
    return row


def _blank(width: int) -> _Row:
    return [(" ", ())] * max(0, width)


def _painted(row: _Row, paint: Painter) -> str:
    """Return a row as text; signs of the same styles beside each other are painted as one."""
    pieces = []
    for styles, part in groupby(row, key=lambda cell: cell[1]):
        pieces.append(paint("".join(text for text, _ in part), *styles))
    return "".join(pieces).rstrip()
