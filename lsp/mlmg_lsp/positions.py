"""Positions as editors count them: lines from 0, and characters in the units that client and server agreed on.

The one place that converts. Inside, everything is an offset in code points; a line ends in LF, CRLF or CR and in
nothing else, whatever Unicode calls a line end.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias

from mlmg_lang.source import Source, Span

Encoding: TypeAlias = Literal["utf-8", "utf-16", "utf-32"]
_BYTES_A_UNIT = {"utf-8": 1, "utf-16": 2, "utf-32": 4}


class EditorPosition(NamedTuple):
    """A place in a text as the protocol writes it: both from 0, `character` in units of the encoding."""

    line: int
    character: int


def position_from_offset(source: Source, offset: int, encoding: Encoding) -> EditorPosition:
    """Return where an offset in code points is for an editor."""
    line, column = source.position(offset)
    start = source.line_starts[line - 1]
    return EditorPosition(line - 1, units_in(source.text[start : start + column - 1], encoding))


def offset_from_position(source: Source, position: EditorPosition, encoding: Encoding) -> int:
    """Return the offset in code points of an editor's position.

    As the protocol has it, a character past the end of its line means the line's end, and a line past the last one the
    end of the text. A position inside a character means its beginning.
    """
    if position.line >= len(source.line_starts):
        return len(source.text)
    line = _line(source, position.line)
    return source.line_starts[position.line] + index_in_line(line, position.character, encoding)


def index_in_line(line: str, character: int, encoding: Encoding) -> int:
    """Return which code point of a line without its end an editor means; its end, if it has not so many."""
    if encoding == "utf-32" or line.isascii():
        return min(character, len(line))
    units = 0
    for index, one in enumerate(line):
        units += units_in(one, encoding)
        if units > character:
            return index
    return len(line)


def range_from_span(source: Source, span: Span, encoding: Encoding) -> tuple[EditorPosition, EditorPosition]:
    """Return the two ends of a span for an editor."""
    return position_from_offset(source, span.start, encoding), position_from_offset(source, span.end, encoding)


def _line(source: Source, line: int) -> str:
    """Return the text of a line without its end."""
    after = line + 1
    end = source.line_starts[after] if after < len(source.line_starts) else len(source.text)
    return source.text[source.line_starts[line] : end].rstrip("\r\n")


def units_in(text: str, encoding: Encoding) -> int:
    """Return how long a text is, in units of the encoding."""
    return (
        len(text.encode(f"{encoding}-le" if encoding != "utf-8" else encoding, "surrogatepass"))
        // (_BYTES_A_UNIT[encoding])
    )
