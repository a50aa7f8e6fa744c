"""A script and a place in it -> the tokens around, and what may be playing where the statement there begins."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain, takewhile
from typing import Final

from mlmg_lang.analysis import Analysis, InPieces, Question
from mlmg_lang.chunks import Chunks
from mlmg_lang.ide.cursor import cursor_at
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing.tokens import Token, n_open_braces
from mlmg_lang.pieces import Piece
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source, Span

_STANDS_FOR_ANY: Final = "wait 1 sec"
_MOST_OPEN: Final = 50
"""So many lines before the cursor are looked through for a parenthesis that is still open."""


def tokens_around(analysis: Analysis, offset: int) -> tuple[Token, ...]:
    """Return the tokens of the lines around an offset, with the statement before, and those with braces of a block.

    Those of a whole script are put together when somebody asks for them, which takes longer than all else here.
    """
    made = analysis.made
    starts, lines = made.places.logical_line_starts, made.lines
    at = made.places.line_at(offset)
    first = next((number for number in range(at - 1, -1, -1) if lines[number].solid), 0)
    first = min((first, *_open_before(lines, first)))
    before, behind = _around(made, offset, first, at + 2)
    numbers = (*_braces(lines, before), *range(first, min(at + 2, len(lines))), *_braces(lines, behind))
    return tuple(chain.from_iterable(_tokens(lines[one], starts[one]) for one in numbers))


def _open_before(lines: Chunks[Piece], end: int) -> Iterator[int]:
    """Yield the lines before one with parentheses that are still open there."""
    for at in range(end - 1, max(end - _MOST_OPEN, 0) - 1, -1):
        balance = lines[at].balance
        if balance.n_open:
            yield at
        if balance.parts:
            return


def _around(made: InPieces, offset: int, first: int, end: int) -> tuple[range, range]:
    """Return the lines of the block at an offset that stand before and behind some."""
    starts = made.places.starts
    at = made.places.piece_at(offset)
    whole = (bisect_left(made.places.logical_line_starts, one) for one in starts[at : at + 2])
    return range(min(next(whole), first), first), range(end, next(whole, end))


def _braces(lines: Chunks[Piece], among: range) -> Iterator[int]:
    """Yield those of some lines that have braces with partners in others."""
    return takewhile(among.__contains__, lines.where("marks", among.start))


def _tokens(line: Piece, start: int) -> tuple[Token, ...]:
    """Return the tokens of a line where it stands now."""
    return moved(line.tokens, by(start - line.address)) if start != line.address else line.tokens


@dataclass(frozen=True, slots=True)
class Before:
    """What may be playing before a statement.

    Attributes
    ----------
    script : that ends with the statement, and the files that it uses. question : what that was analysed against.
    """

    script: Source
    question: Question
    state: flow.State


def state_before(analysis: Analysis, offset: int, names: Names, known: Before | None = None) -> Before:
    """Return what may be playing before the statement at an offset, whatever is written of it, and after it.

    It is what would be playing before any other statement there, if the script ended with it.

    Parameters
    ----------
    known : what was found last: it is the same as long as nothing but the statement is edited.
    """
    start = statement_start(tokens_around(analysis, offset), offset)
    text = analysis.source.text[:start] + _STANDS_FOR_ANY
    script = replace(analysis.source, text=text + _closing(tokens_around(analysis, start), start))
    if known is not None and known.question is analysis.question and known.script == script:
        return known
    state = _played_before(analysis, Source(script.text, script.name), Span(start, len(text)))
    return Before(script, analysis.question, state or flow.unknown(names))


def _played_before(analysis: Analysis, script: Source, statement: Span) -> flow.State | None:
    """Return what may be playing before the last statement of a script that is much the same as one analysed."""
    from mlmg_lang.front_end import analyse_again

    cut_off = analyse_again(analysis, script).ready
    at = cut_off.places.starts.last_to(statement.start)
    if not 0 <= at < len(cut_off.played):
        return None
    states = cut_off.played[at].states
    return next((state for place, state in states.items() if cut_off.now(place) == statement), None)


def statement_start(tokens: tuple[Token, ...], offset: int) -> int:
    """Return where the statement at an offset begins."""
    cursor = cursor_at(tokens, offset)
    if cursor is None:
        return offset
    return cursor.before[0].span.start if cursor.before else cursor.span.start


def _closing(tokens: tuple[Token, ...], offset: int) -> str:
    """Return the braces that close the blocks around an offset; `tokens`: those around it."""
    return "\n}" * n_open_braces(token for token in tokens if token.span.start < offset)
