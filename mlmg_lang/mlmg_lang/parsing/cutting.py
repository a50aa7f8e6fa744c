"""Tokens -> where a script may be cut so that each piece means by itself what it means in the whole.

A piece is one or more whole lines: the comments and empty lines before a statement, the statement, and whatever layout
joins to it: lines that go on, and all between a parenthesis and its partner. A block that stands on several lines is
several pieces, which say what they say wherever they stand, but for the braces around them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.parsing.layout import inside_parentheses
from mlmg_lang.parsing.lookalikes import narrowed, without_comments
from mlmg_lang.parsing.quotes import requoted, without_lone
from mlmg_lang.parsing.strays import without_strays
from mlmg_lang.parsing.swapped import in_order
from mlmg_lang.parsing.tokens import CONTINUES, ENDS_PARENTHESES, OPENS_STATEMENT, Token


@dataclass(frozen=True, slots=True)
class Cuts:
    """Where pieces begin.

    Attributes
    ----------
    starts : offsets, that of the first piece left out.
    next : that of a piece which came after the last statement; None if that does not end with its line.
    """

    starts: tuple[int, ...]
    next: int | None


def cut(narrow: Sequence[Token], depth: int = 0) -> Cuts:
    """Return where a text may be cut. Every piece but the last has a token that is neither comment nor line end.

    Parameters
    ----------
    narrow : its tokens, quotes and signs of other keyboards as they were meant; see `narrowed`.
    depth : how many blocks the text stands in.
    """
    starts: list[int] = []
    end: int | None = None
    empty = True
    meant = _meant(narrow, depth)
    for token, inside in zip(meant, inside_parentheses(meant), strict=True):
        kind = token.type
        if kind == "NEWLINE":
            if not inside and not empty and end is None:
                end = token.span.end
        elif kind != "COMMENT":
            if end is not None and kind not in CONTINUES and kind != "OPEN":
                starts.append(end)
            end, empty = None, False
    return Cuts(tuple(starts), end)


@dataclass(frozen=True, slots=True)
class Balance:
    """The parentheses of some whole lines that may have their partners in others.

    Attributes
    ----------
    n_closing : those that could close one before these lines. n_open : those that could be closed after them.
    parts : whether no parenthesis before these lines can have its partner after them.
    """

    n_closing: int
    n_open: int
    parts: bool

    @property
    def ends_before(self) -> bool:
        """Return whether the last open parenthesis before what comes next is one of these, or none before these."""
        return self.n_open > 0 or self.parts

    @property
    def ends_after(self) -> bool:
        """Return whether the first that closes one before these lines is one of these, or none after these."""
        return self.n_closing > 0 or self.parts


def balance(tokens: Sequence[Token], depth: int = 0) -> Balance:
    """Return what parentheses are left without a partner in some whole lines; `depth`: see `cut`."""
    n_closing = n_open = 0
    parts, first = False, True
    for token in _meant(narrowed(requoted(tokens)), depth):
        kind = token.type
        if kind in ENDS_PARENTHESES or (first and kind in OPENS_STATEMENT):
            n_open, parts = 0, True
        elif kind == "LEFT":
            n_open += 1
        elif kind == "RIGHT":
            n_closing += n_open == 0 and not parts
            n_open = max(0, n_open - 1)
        first = kind == "NEWLINE" or (first and kind == "COMMENT")
    return Balance(n_closing, n_open, parts)


def _meant(narrow: Sequence[Token], depth: int) -> Sequence[Token]:
    """Return the tokens that layout goes by."""
    return without_strays(in_order(without_lone(without_comments(narrow))), depth)
