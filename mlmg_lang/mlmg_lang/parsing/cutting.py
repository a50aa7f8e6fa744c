"""Tokens -> where a script may be cut so that each piece means by itself what it means in the whole.

A piece is one or more whole lines: the comments and empty lines before a statement, the statement, and whatever layout
could join to it: lines that go on, a whole block, and all after a parenthesis that has no partner yet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.parsing.lookalikes import as_meant
from mlmg_lang.parsing.tokens import CONTINUES, OPENS_STATEMENT, Token


@dataclass(frozen=True, slots=True)
class Cuts:
    """Where pieces begin.

    Attributes
    ----------
    starts : offsets, that of the first piece left out.
    closed : whether a line that does not go on with another could begin a piece after the last token.
    """

    starts: tuple[int, ...]
    closed: bool


def cut(tokens: Sequence[Token]) -> Cuts:
    """Return where a text may be cut. Every piece but the last has a token that is neither comment nor line end."""
    starts: list[int] = []
    end: int | None = None
    depth = n_open = 0
    first, empty = True, True
    for token in as_meant(tokens):
        kind = token.type
        if kind == "NEWLINE":
            if depth == n_open == 0 and not empty and end is None:
                end = token.span.end
            first = True
            continue
        if kind == "COMMENT":
            continue
        if end is not None and kind not in CONTINUES and kind != "OPEN":
            starts.append(end)
        end, empty = None, False
        if kind in _ENDS_PARENTHESES or (first and kind in OPENS_STATEMENT):
            n_open = 0
            depth = max(0, depth + (kind == "OPEN") - (kind == "CLOSE"))
        elif kind == "LEFT":
            n_open += 1
        elif kind == "RIGHT":
            n_open = max(0, n_open - 1)
        first = False
    closed = depth == n_open == 0 and bool(tokens) and tokens[-1].type == "NEWLINE"
    return Cuts(tuple(starts), closed)


_ENDS_PARENTHESES = frozenset({"SEMICOLON", "OPEN", "CLOSE", "BAR"})
