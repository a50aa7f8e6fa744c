"""The words of a statement, and the comments among them -> the lines that it takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType
from typing import Final

from mlmg_lang.parsing.tokens import Token
from mlmg_lang.rendering.cells import cells

WIDTH = 100
"""As many columns a line may take, but for comments and what cannot be broken."""
INDENT = 4
_BREAKS: Final[Mapping[str, int]] = MappingProxyType({"COMMA": 0, "FOR": 0, "ONCE": 0, "WITH": 1, "OR": 2, "AND": 3})
"""Before which words, or after which, a line may end: first where they bind loosest."""


@dataclass(slots=True)
class Row:
    """One line of a formatted script.

    Attributes
    ----------
    indent : in columns.
    comment : what stands behind the code, or alone in the line.
    """

    indent: int
    code: str
    comment: str = ""


@dataclass(frozen=True, slots=True)
class _Word:
    """A word of a statement that takes several lines.

    Attributes
    ----------
    text : with the space before it, if it has one.
    depth : how many parentheses are open around it; a parenthesis itself stands outside.
    comments : what stands before it; the first one behind the word before, if `trails`.
    rank : how little the line before it hangs together with it; None where a line must not end.
    """

    type: str
    text: str
    depth: int
    comments: tuple[str, ...]
    trails: bool
    rank: tuple[int, int] | None


def columns(text: str) -> int:
    """Return how many columns of a terminal a text takes; wide letters take two."""
    return len(text) if text.isascii() else sum(cell.width for cell in cells(text))


def wrap(tokens: Sequence[Token], texts: Sequence[str], indent: int, lead: int = 0) -> list[Row]:
    """Return the lines of a statement: one if it fits, else one more for each `with` that is not in parentheses.

    Parameters
    ----------
    tokens : of the statement, with the comments and line ends among them.
    texts : of its words, as `Words.written` returns them.
    indent : of the statement, in columns.
    lead : how many columns of the first line are taken by something before it, beyond the indentation.
    """
    flat = "".join(texts)
    commented = len(tokens) > len(texts) and any(token.type == "COMMENT" for token in tokens)
    if not commented and indent + lead + columns(flat) <= WIDTH:
        return [Row(indent, flat)]
    return _Wrapper(indent, lead).rows(tuple(_words(tokens, texts)))


def _words(tokens: Iterable[Token], texts: Iterable[str]) -> Iterator[_Word]:
    """Yield the words of a statement with the comments that stand before each."""
    remaining = iter(texts)
    depth = 0
    before = ""
    comments: list[str] = []
    own_line = trails = False
    for token in tokens:
        if token.type == "NEWLINE":
            own_line = True
        elif token.type == "COMMENT":
            trails = trails or not (comments or own_line)
            comments.append(token.text.rstrip())
        else:
            depth -= token.type == "RIGHT"
            order = _BREAKS.get("COMMA" if before == "COMMA" else token.type, 4 if comments else None)
            rank = None if order is None else (depth, order)
            yield _Word(token.type, next(remaining), depth, tuple(comments), trails, rank)
            depth += token.type == "LEFT"
            before, comments, own_line, trails = token.type, [], False, False


class _Wrapper:
    """Puts words into lines: as many as fit, and what belongs together in one line if that can be."""

    def __init__(self, indent: int, lead: int) -> None:
        self._indent = indent
        self._rows = [Row(indent, "")]
        self._taken = indent + lead
        self._layer = 0

    def rows(self, words: Sequence[_Word]) -> list[Row]:
        """Return the lines; each `with` outside of parentheses begins one."""
        for layer in _parts(words, _begins_layer):
            self._place(layer)
            self._layer = INDENT
        return self._rows

    def _place(self, words: Sequence[_Word]) -> None:
        """Put words behind the others, in a new line, or, if they are too many for one, in several."""
        first, *others = words
        indent = self._indent_of(first)
        width = sum(columns(word.text) for word in words)
        rank = min((word.rank for word in others if word.rank is not None), default=None)
        whole = not any(word.comments for word in others)
        new_line = bool(first.comments) or _begins_layer(first)
        if whole and not new_line and self._taken + width <= WIDTH:
            self._append(words, width)
        elif rank is None or (whole and indent + width - first.text.startswith(" ") <= WIDTH):
            if new_line or self._rows[-1].code:
                self._begin_row(first, indent)
            self._append(words, width)
        else:
            for part in _parts(words, lambda word: word.rank == rank):
                self._place(part)

    def _indent_of(self, word: _Word) -> int:
        """Return how far a line is indented that begins with a word."""
        of_command = word.depth == 0 and word.type in ("WITH", "FOR", "ONCE")
        return self._indent + (INDENT if of_command else self._layer + INDENT)

    def _append(self, words: Sequence[_Word], width: int) -> None:
        text = "".join(word.text for word in words)
        row = self._rows[-1]
        if not row.code:
            text, width = text.lstrip(" "), width - text.startswith(" ")
        row.code += text
        self._taken += width

    def _begin_row(self, word: _Word, indent: int) -> None:
        """Begin a line with a word, below the comments that stand before it."""
        if word.trails:
            self._rows[-1].comment = word.comments[0]
        own = word.comments[1:] if word.trails else word.comments
        self._rows += [*(Row(indent, "", comment) for comment in own), Row(indent, "")]
        self._taken = indent


def _begins_layer(word: _Word) -> bool:
    return word.depth == 0 and word.type == "WITH"


def _parts(words: Sequence[_Word], begins: Callable[[_Word], bool]) -> Iterator[Sequence[_Word]]:
    """Yield the parts of a stretch, each but the first of which begins with such a word."""
    starts = [0, *(at for at, word in enumerate(words) if at and begins(word)), len(words)]
    return (words[start:end] for start, end in pairwise(starts))
