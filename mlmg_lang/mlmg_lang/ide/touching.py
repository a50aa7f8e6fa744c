"""An analysis and a place in its text -> the pieces and tokens that are there, and how far these have moved."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import WholeBlock
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Source, Span


def pieces_touching(analysis: Analysis, within: Span) -> Iterator[tuple[Piece | WholeBlock, int]]:
    """Yield the pieces that a stretch touches, each with how far from its address it stands."""
    made = analysis.made
    starts = made.places.starts
    first = made.places.piece_at(within.start)
    end = starts.last_to(within.end) + 1
    for piece, start in zip(made.pieces[first:end], starts[first:end], strict=False):
        yield piece, start - piece.address


def tokens_at(analysis: Analysis, offset: int) -> tuple[Sequence[Token], int]:
    """Return the tokens of the line at an offset, or of the whole file if that is one that the script uses.

    With them comes what makes offsets of their places.
    """
    source, made = analysis.source, analysis.made
    if offset > len(source.text):
        file, base = source.file(offset)
        return tokenize(Source(file.text)), base
    number = made.places.line_at(offset)
    line = made.lines[number]
    return line.tokens, made.places.logical_line_starts[number] - line.address
