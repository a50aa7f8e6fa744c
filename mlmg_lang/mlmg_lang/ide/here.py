"""A script and a place in it -> the tokens around, and what may be playing where the statement there begins."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from itertools import chain, compress
from operator import attrgetter
from typing import Final

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.ide.cursor import cursor_at
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece, all_of
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source, Span

_STANDS_FOR_ANY: Final = "wait 1 sec"


def tokens_around(analysis: Analysis, offset: int) -> tuple[Token, ...]:
    """Return the tokens of the lines around an offset, with the statement before, and those with braces of a block.

    Those of a whole script are put together when somebody asks for them, which takes longer than all else here.
    """
    made = analysis.made
    starts, lines = made.places.line_starts, made.lines
    at = max(bisect_right(starts, offset) - 1, 0)
    first = next((number for number in range(at - 1, -1, -1) if lines[number].solid), 0)
    before, behind = (lines[part] for part in _around(made, offset, first, at + 2))
    parts = (_braces(before), lines[first : at + 2], _braces(behind))
    return made.now(tuple(all_of(chain.from_iterable(parts), "tokens")))


def _around(made: InPieces, offset: int, first: int, end: int) -> tuple[slice, slice]:
    """Return the lines of the block at an offset that stand before and behind some."""
    starts = made.places.starts
    at = max(bisect_right(starts, offset) - 1, 0)
    whole = (bisect_left(made.places.line_starts, one) for one in starts[at : at + 2])
    return slice(min(next(whole), first), first), slice(end, next(whole, end))


def _braces(lines: Sequence[Piece]) -> Iterator[Piece]:
    """Return those of some lines that have braces with partners in others."""
    return compress(lines, map(attrgetter("marks"), lines))


def state_before(analysis: Analysis, offset: int, names: Names) -> flow.State:
    """Return what may be playing before the statement at an offset, whatever is written of it, and after it.

    It is what would be playing before any other statement there, if the script ended with it.
    """
    from mlmg_lang.front_end import analyse_again

    start = statement_start(tokens_around(analysis, offset), offset)
    before = analysis.source.text[:start]
    text = before + _STANDS_FOR_ANY
    span = Span(start, len(text))
    cut_off = analyse_again(analysis, Source(text + _closing(analysis, start), analysis.source.name)).ready
    at = bisect_right(cut_off.places.starts, start) - 1
    if not 0 <= at < len(cut_off.played):
        return flow.unknown(names)
    states = cut_off.played[at].states
    known = (state for place, state in states.items() if cut_off.now(place) == span)
    return next(known, None) or flow.unknown(names)


def statement_start(tokens: tuple[Token, ...], offset: int) -> int:
    """Return where the statement at an offset begins."""
    cursor = cursor_at(tokens, offset)
    if cursor is None:
        return offset
    return cursor.before[0].span.start if cursor.before else cursor.span.start


def _closing(analysis: Analysis, offset: int) -> str:
    """Return the braces that close the blocks around an offset."""
    depth = 0
    for token in tokens_around(analysis, offset):
        if token.span.start < offset:
            depth = max(0, depth + (token.type == "OPEN") - (token.type == "CLOSE"))
    return "\n}" * depth
