"""An analysis and a stretch of its text -> the pieces of the script that are there."""

from __future__ import annotations

from collections.abc import Iterator

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import WholeBlock
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Span


def pieces_touching(analysis: Analysis, within: Span) -> Iterator[tuple[Piece | WholeBlock, int]]:
    """Yield the pieces that a stretch touches, each with how far from its address it stands."""
    made = analysis.made
    starts = made.places.starts
    first = max(0, min(starts.last_to(within.start), len(made.pieces) - 1))
    end = starts.last_to(within.end) + 1
    for piece, start in zip(made.pieces[first:end], starts[first:end], strict=False):
        yield piece, start - piece.address
