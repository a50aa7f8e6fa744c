"""The lines and blocks that layout makes, as the formatter asks about them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TypeAlias

from mlmg_lang.parsing.layout import Block, Line
from mlmg_lang.parsing.tokens import CONTINUES, Token
from mlmg_lang.source import Span

Piece: TypeAlias = Line | Block


def statements(pieces: Iterable[Piece]) -> Iterator[Sequence[Token]]:
    """Yield the tokens of all lines, those in blocks too."""
    for piece in pieces:
        if isinstance(piece, Line):
            yield piece.tokens
        else:
            for branch in piece.branches:
                yield from statements(branch)


def beginning(piece: Piece) -> Sequence[Token]:
    """Return the tokens of a line, or those before the brace of a block."""
    return piece.tokens if isinstance(piece, Line) else piece.head


def span(piece: Piece) -> Span:
    """Return the place of a piece."""
    return Span(piece.tokens[0].span.start, piece.tokens[-1].span.end) if isinstance(piece, Line) else piece.span


def is_weight(piece: Piece) -> bool:
    """Return whether a piece is the weight of a branch, `3:`, or would be one if it stood there."""
    return isinstance(piece, Line) and [token.type for token in piece.tokens] == ["INTEGER", "COLON"]


def would_go_on(piece: Piece) -> bool:
    """Return whether a piece would belong to the line above it, were that not ended by a `;`.

    Behind a quote without a partner, which may open nothing, any word may be the first.
    """
    tokens = beginning(piece)
    return not tokens or tokens[0].type in CONTINUES or tokens[0].type == "UNCLOSED"
