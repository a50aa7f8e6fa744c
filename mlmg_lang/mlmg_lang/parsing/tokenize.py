"""Text -> tokens."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from mlmg_grammar import scan
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

MAX_TOKENS = 1_000_000
"""The most tokens of a text that are read: those of some 100,000 lines, more than may be played."""


def tokenize(source: Source, base: int = 0) -> tuple[Token, ...]:
    """Return the first `MAX_TOKENS` of a text in order, comments and line ends too. This never fails.

    Parameters
    ----------
    base : where the file begins whose tokens are wanted: the script itself, or one that it uses.
    """
    return tuple(islice(scanned(source.file(base)[0].text, base), MAX_TOKENS))


def scanned(text: str, start: int) -> Iterator[Token]:
    """Return the tokens of a text, all but white space; `start`: where it begins."""
    return (
        Token(piece.type, str(piece), Span(start + piece.start_pos, start + piece.start_pos + len(piece)))
        for piece in scan(motion_script(), text)
        if piece.type != "SPACE" and piece.start_pos is not None
    )
