"""Text for a terminal -> the same, broken at words where a line is too wide, and indented as what it goes on with."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from mlmg_lang.explaining.tree import n_columns

_COLOUR: Final = re.compile(r"\x1b\[[\d;]*m")
_DRAWN: Final = re.compile(r"\s*(\d+ )?\||\s*-->")
"""A line of a drawing, where columns mean something."""
_LEAD: Final = re.compile(r"[ │├└─]*")
_HEAD: Final = re.compile(r"(?:\S+ )*\S+ {2,}|= \w+: ")
"""What stands before the text of a line: the first column of a table, or what it is about."""
_BRANCHES: Final = str.maketrans("├└─", "│  ")


def wrapped(text: str, width: int) -> str:
    """Return a text whose lines, if words allow it, are not wider than a terminal.

    Parameters
    ----------
    text : lines, each with its end; with colours, which take no room.
    width : in columns.
    """
    return "".join(f"{piece}\n" for line in text.splitlines() for piece in _pieces(line, width))


def _pieces(line: str, width: int) -> Iterator[str]:
    if _columns(line) <= width or _DRAWN.match(line):
        yield line
        return
    lead = _match(_LEAD, line)
    head = _match(_HEAD, line[len(lead) :])
    begun, others = lead + head, lead.translate(_BRANCHES) + " " * _columns(head)
    if not head or _columns(begun) > width // 2:
        others = lead.translate(_BRANCHES) + "    "
        if head:
            yield begun.rstrip()
        begun = others if head else lead
    piece, empty = begun, True
    for space, word in re.findall(r"( *)(\S+)", line[len(lead) + len(head) :]):
        longer = piece + word if empty else piece + space + word
        if not empty and _columns(longer) > width:
            yield piece
            longer = others + word
        piece, empty = longer, False
    yield piece


def _match(pattern: re.Pattern[str], text: str) -> str:
    found = pattern.match(text)
    return found[0] if found else ""


def _columns(text: str) -> int:
    """Return how wide a text is on a terminal."""
    return n_columns(_COLOUR.sub("", text))
