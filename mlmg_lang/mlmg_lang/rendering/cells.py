"""A line of text -> what a reader sees as its characters, each with the columns of a terminal that it takes.

Grapheme clusters are told apart as far as columns depend on it: combining marks, emoji of several parts, flags,
keycaps, Hangul syllables. Terminals that know less draw some of these wider; there is no width that all agree on.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

TAB: Final = 4
"""Tabs go on to the next multiple of this."""
UNSEEN: Final = "\ufffd"
"""Drawn for what cannot be seen, or what a terminal would act upon."""
_JOINER: Final = "\u200d"
_JOINERS: Final = frozenset("\u200c\u200d")
_EMOJI_SIGN: Final = "\ufe0f"
_KEYCAP: Final = "\u20e3"
_BLACK_FLAG: Final = "\U0001f3f4"
_VISIBLE_FORMAT: Final = frozenset("\u0600\u0601\u0602\u0603\u0604\u0605\u06dd\u070f\u08e2\U000110bd\U000110cd")
"""The signs among Unicode's format characters that are drawn: they enclose numbers."""
_BLANK_LETTERS: Final = frozenset("\u115f\u1160\u3164\uffa0\u034f")
"""Letters and marks by category that show nothing."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One character as its reader sees it.

    Attributes
    ----------
    start, end : its stretch of the line, in code points.
    text : what is drawn for it.
    width : in columns.
    """

    start: int
    end: int
    text: str
    width: int


def cells(line: str) -> Iterator[Cell]:
    """Yield the cells of a line, which has no line end in it."""
    column, at = 0, 0
    while at < len(line):
        end = _cluster_end(line, at)
        text, width = _drawn(line[at:end], column)
        yield Cell(at, end, text, width)
        column += width
        at = end


def is_unsafe(character: str) -> bool:
    """Return whether a character shows nothing by itself, or a terminal could act upon it."""
    category = unicodedata.category(character)
    if category == "Cf":
        return character not in _VISIBLE_FORMAT
    return category in ("Cc", "Cs", "Zl", "Zp") or character in _BLANK_LETTERS


def runs_right_to_left(text: str) -> bool:
    """Return whether a text has letters that are written from right to left."""
    return any(unicodedata.bidirectional(character) in ("R", "AL", "AN") for character in text)


def _cluster_end(line: str, at: int) -> int:
    """Return where the cluster ends that begins at an offset."""
    end = at + 1
    if is_unsafe(line[at]):
        return end
    if _is_flag_letter(line[at]) and end < len(line) and _is_flag_letter(line[end]):
        end += 1
    while end < len(line) and _goes_on(line, at, end):
        end += 1
    return end


def _goes_on(line: str, start: int, at: int) -> bool:
    """Return whether the character at an offset belongs to the cluster begun at `start`."""
    base, character = line[start], line[at]
    if character in _JOINERS:
        return not base.isascii()
    if _is_skin(character) or _is_tag(character):
        return _is_picture(base) and (_is_skin(character) or base == _BLACK_FLAG)
    if line[at - 1] == _JOINER and _is_picture(character):
        return _is_picture(base)
    if unicodedata.category(character) in ("Mn", "Me", "Mc"):
        return not is_unsafe(character)
    return _is_hangul_end(character) and _is_hangul(base)


def _drawn(cluster: str, column: int) -> tuple[str, int]:
    """Return what is drawn for a cluster, and its width."""
    if cluster == "\t":
        width = TAB - column % TAB
        return " " * width, width
    if is_unsafe(cluster[0]):
        return UNSEEN, 1
    return cluster, _width(cluster)


def _width(cluster: str) -> int:
    base = cluster[0]
    if _is_flag_letter(base):
        return min(len(cluster), 2)
    if _EMOJI_SIGN in cluster and (_is_picture(base) or _KEYCAP in cluster):
        return 2
    if any(map(_is_skin, cluster)):
        return 2
    own = 0 if unicodedata.category(base) in ("Mn", "Me") else 1
    if unicodedata.east_asian_width(base) in "WF":
        own = 2
    return own + sum(unicodedata.category(mark) == "Mc" for mark in cluster[1:])


def _is_flag_letter(character: str) -> bool:
    return "\U0001f1e6" <= character <= "\U0001f1ff"


def _is_skin(character: str) -> bool:
    return "\U0001f3fb" <= character <= "\U0001f3ff"


def _is_tag(character: str) -> bool:
    return "\U000e0020" <= character <= "\U000e007f"


def _is_picture(character: str) -> bool:
    """Return whether a character is an emoji, or a symbol that a sign can make one."""
    return unicodedata.category(character) in ("So", "Sm") or character in "\u203c\u2049\u3030"


def _is_hangul(character: str) -> bool:
    return "\u1100" <= character <= "\u115e" or "\uac00" <= character <= "\ud7a3"


def _is_hangul_end(character: str) -> bool:
    """Return whether a character is a vowel or a final consonant that stands in one syllable with those before."""
    return "\u1161" <= character <= "\u11ff" or "\ud7b0" <= character <= "\ud7fb"
