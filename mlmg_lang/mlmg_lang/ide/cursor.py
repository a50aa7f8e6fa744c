"""A text and a place in it -> the statement that is being written there, up to the word under the cursor."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, Token, n_open_braces
from mlmg_lang.source import Span

_WORDS: Final = frozenset({"NAME", "UNIT", "STRING", "UNCLOSED"})
_BEFORE_NUMBER: Final = frozenset({"FOR", "WAIT", "REPEAT"})
"""What a number stands behind, and no motion."""
_BEFORE_VALUE: Final = frozenset({"LEFT", "COMMA", "EQUALS"})
"""What a motion may stand behind, or a duration."""


_MOST_IN_NAME: Final = 5
"""So many words before the cursor may be of the name that is being written."""


@dataclass(frozen=True, slots=True)
class Cursor:
    """Where a text is being written.

    Attributes
    ----------
    word : what stands of a word before the cursor, without quotes; empty between words.
    span : what takes the place of that word: all of it, also what stands behind the cursor; but of a name without its
        second quote, whose end nobody knows, what stands before the cursor.
    quoted : whether that word begins with a quote.
    before : the tokens of the statement before that word.
    last : those of the statement before this one, if only a line end stands between the two: a line may go on with it.
    nested : whether the statement stands in braces.
    behind : the tokens of the statement behind that word, on further lines too.
    """

    word: str
    span: Span
    quoted: bool
    before: tuple[Token, ...]
    last: tuple[Token, ...]
    nested: bool
    behind: tuple[Token, ...]


def cursor_at(tokens: Sequence[Token], offset: int) -> Cursor | None:
    """Return what is being written at an offset of a text; None in a comment, or behind a finished quoted name.

    Parameters
    ----------
    tokens : all of the text. offset : in code points.
    """
    before = [token for token in tokens if token.span.start < offset]
    under = before[-1] if before and before[-1].span.end >= offset else None
    if under is not None and under.type == "COMMENT":
        return None
    if under is not None and under.type == "STRING" and under.span.end == offset:
        return None
    word, span, quoted = "", Span(offset, offset), False
    n_words = 0 if under is None else _n_words(before)
    if under is not None and n_words:
        span = Span(before[-n_words].span.start, offset if under.type == "UNCLOSED" else under.span.end)
        quoted = under.type in ("STRING", "UNCLOSED")
        word = "".join(token.text for token in before[-n_words:])[: offset - span.start].lstrip('"')
        before = before[:-n_words]
    line, last, nested = _statement(before, offset)
    behind = _behind(before, [token for token in tokens if token.span.start >= span.end], span.end)
    return Cursor(word, span, quoted, line, last, nested, behind)


def in_a_row(tokens: Sequence[Token], cursor: Cursor) -> Iterator[Cursor]:
    """Yield what is being written if words right before it are of the same name, which lacks its quotes; most first."""
    end = bisect_left(tokens, cursor.span.start, key=lambda token: token.span.start)
    first = end
    while first > max(end - _MOST_IN_NAME, 0) and tokens[first - 1].type in ("NAME", "UNIT"):
        first -= 1
    if not cursor.word or cursor.quoted:
        return
    for at in range(first, end):
        span = Span(tokens[at].span.start, cursor.span.end)
        yield replace(cursor, span=span, before=cursor.before[: at - end])


def is_open(tokens: Sequence[Token]) -> bool:
    """Return whether a text ends inside braces or parentheses that something may still close."""
    return n_open_braces(tokens) > 0 or _n_open_parentheses(tokens) > 0


def _n_open_parentheses(tokens: Iterable[Token]) -> int:
    """Return how many parentheses are open behind some tokens: none is open beyond a brace, a `|` or a `;`."""
    n_open = 0
    for token in tokens:
        cleared = token.type in ENDS_PARENTHESES
        n_open = 0 if cleared else max(0, n_open + (token.type == "LEFT") - (token.type == "RIGHT"))
    return n_open


def _is_word(token: Token) -> bool:
    return token.type in _WORDS or token.text.isalpha() or token.text == "-"


def _n_words(tokens: Sequence[Token]) -> int:
    """Return how many of the last tokens are the name that is being written: one that lacks its quotes is several."""
    if _ends_in_hyphen(tokens):
        return 2
    if tokens[-1].type == "INTEGER":
        return 1 if _kind(tokens, -2) not in _BEFORE_NUMBER | _BEFORE_VALUE else 0
    if not _is_word(tokens[-1]):
        return 0
    is_behind_number = _kind(tokens, -2) == "INTEGER" and tokens[-2].span.end == tokens[-1].span.start
    return 2 if is_behind_number and _kind(tokens, -3) not in _BEFORE_NUMBER else 1


def _kind(tokens: Sequence[Token], at: int) -> str:
    return tokens[at].type if -at <= len(tokens) else ""


def _ends_in_hyphen(tokens: Sequence[Token]) -> bool:
    """Return whether a hyphen that nothing follows yet stands right behind a name."""
    if len(tokens) < 2 or tokens[-1].text != "-":
        return False
    return tokens[-2].type == "NAME" and tokens[-2].span.end == tokens[-1].span.start


def _behind(before: Sequence[Token], after: Sequence[Token], offset: int) -> tuple[Token, ...]:
    """Return the tokens of the statement of a word that stand behind it.

    Empty if the first would become part of the word, or a parenthesis is still open: it is not known what that says.
    """
    if not after or (_is_word(after[0]) and after[0].span.start == offset):
        return ()
    here = Token("NAME", "", Span(offset, offset))
    waiting = list(lay_out([*before, here, *after]).items)
    while waiting:
        item = waiting.pop()
        if isinstance(item, Block):
            waiting += [one for branch in item.branches for one in branch]
        elif here in item.tokens:
            behind = item.tokens[item.tokens.index(here) + 1 :]
            return behind if _n_open_parentheses(behind) == 0 else ()
    return ()


def _statement(before: Sequence[Token], offset: int) -> tuple[tuple[Token, ...], tuple[Token, ...], bool]:
    """Return the tokens of the statement that a word at an offset belongs to, and those of the one before it."""
    here = Token("NAME", "", Span(offset, offset))
    closing = [Token("RIGHT", ")", Span(offset, offset))] * _n_open_parentheses(before)
    items, nested = lay_out([*before, here, *closing]).items, False
    while items and isinstance(items[-1], Block):
        items, nested = items[-1].branches[-1], True
    lines = [item.tokens if isinstance(item, Line) else () for item in items]
    if not lines or here not in lines[-1]:
        return (), (), nested
    line = lines[-1][: lines[-1].index(here)]
    joined = not line and len(lines) > 1 and _last_solid(before) not in ("SEMICOLON", "CLOSE")
    return line, lines[-2] if joined else (), nested


def _last_solid(tokens: Sequence[Token]) -> str:
    return next((token.type for token in reversed(tokens) if token.type not in ("NEWLINE", "COMMENT")), "")
