"""The words of a statement, and the comments among them -> the lines that it takes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from mlmg_lang.parsing.tokens import CONTINUES, Token
from mlmg_lang.rendering.cells import cells

WIDTH = 100
"""As many columns a line may take, but for comments and what cannot be broken."""
INDENT = 4


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


@dataclass(slots=True)
class _Word:
    """A word of a statement that takes several lines.

    Attributes
    ----------
    text : with the space before it, if it has one.
    depth : how many parentheses are open around it; a parenthesis itself stands outside.
    comments : what stands before it; the first one behind the word before, if `trails`.
    """

    type: str
    text: str
    depth: int
    after_comma: bool
    comments: list[str] = field(default_factory=list)
    trails: bool = False


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
    return _Wrapper(indent, lead).rows(_words(tokens, texts))


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
            yield _Word(token.type, next(remaining), depth, before == "COMMA", comments, trails)
            depth += token.type == "LEFT"
            before, comments, own_line, trails = token.type, [], False, False


class _Wrapper:
    """Puts words into lines."""

    def __init__(self, indent: int, lead: int) -> None:
        self._indent = indent
        self._rows = [Row(indent, "")]
        self._taken = indent + lead
        self._layer = 0

    def rows(self, words: Iterable[_Word]) -> list[Row]:
        """Return the lines."""
        for chunk in _chunks(words):
            self._put(chunk)
        return self._rows

    def _put(self, chunk: list[_Word]) -> None:
        """Put words that stay together where they belong: behind the others, or in a new line."""
        first = chunk[0]
        begins_layer = first.type == "WITH" and first.depth == 0
        text = "".join(word.text for word in chunk)
        width = columns(text)
        if begins_layer:
            self._layer = INDENT
        outermost = first.depth == 0 and first.type in ("WITH", "FOR", "ONCE")
        indent = self._indent + (INDENT if outermost else self._layer + INDENT)
        self._comment(first, indent)
        if first.comments or (self._rows[-1].code and (begins_layer or self._taken + width > WIDTH)):
            text = text.lstrip(" ")
            self._rows.append(Row(indent, text))
            self._taken = indent + columns(text)
        else:
            self._rows[-1].code += text
            self._taken += width

    def _comment(self, word: _Word, indent: int) -> None:
        comments = word.comments
        if word.trails:
            self._rows[-1].comment, *comments = comments
        self._rows += [Row(indent, "", comment) for comment in comments]


def _chunks(words: Iterable[_Word]) -> Iterator[list[_Word]]:
    """Yield the words between the places where a line may end."""
    chunk: list[_Word] = []
    for word in words:
        if chunk and (word.comments or word.after_comma or word.type in CONTINUES):
            yield chunk
            chunk = []
        chunk.append(word)
    yield chunk
