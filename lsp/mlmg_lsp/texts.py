"""A text that is edited, kept in lines: an edit costs what it changes, not what there is."""

from __future__ import annotations

import re
from typing import Final

from mlmg_lsp.positions import EditorPosition, Encoding, index_in_line

_LINE: Final = re.compile(r"[^\r\n]*(?:\r\n|\r|\n|\Z)")


def lines_of(text: str) -> list[str]:
    """Return the lines of a text with their ends, LF, CRLF or CR and no other; the last has none, and may be empty."""
    lines = _LINE.findall(text)
    # Behind a last line that is not empty, there is an empty match.
    return lines[:-1] if len(lines) > 1 and lines[-2][-1:] not in ("\r", "\n") else lines


def edited(lines: list[str], start: EditorPosition, end: EditorPosition, new: str, encoding: Encoding) -> None:
    """Put something in place of a stretch of a text, as the protocol has it.

    The line before is split anew too: half of a CRLF may come to stand at its end.
    """
    first, last = (min(position.line, len(lines) - 1) for position in (start, end))
    head = lines[first][: _index(lines, start, encoding)]
    tail = lines[last][_index(lines, end, encoding) :]
    before = lines[first - 1] if first else ""
    stretch = before + head + new + tail
    fresh = lines_of(stretch)
    if last + 1 < len(lines):
        fresh.pop()  # behind a line end that was there before
    lines[max(first - 1, 0) : last + 1] = fresh


def _index(lines: list[str], position: EditorPosition, encoding: Encoding) -> int:
    """Return which code point of its line a position is at; of one behind the text, the last line's end."""
    if position.line >= len(lines):
        return len(lines[-1])
    return index_in_line(lines[position.line].rstrip("\r\n"), position.character, encoding)
