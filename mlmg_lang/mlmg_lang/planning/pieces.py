"""A script in pieces: what each says, and what it plays; values that are kept while other pieces change.

The places in a piece's values are those of the text that it was read in, where it began at its `origin`: a piece is
the same value wherever it comes to stand. The whole script is put together again when somebody asks for it.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import Final, TypeVar

from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.cutting import cut
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning import resolved, typed
from mlmg_lang.planning.chart import chart
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.resolve import GAP, Resolution
from mlmg_lang.source import Source, Span

Placed = TypeVar("Placed", Token, syntax.Item, typed.Statement, resolved.Statement)
_LATER: Final = re.compile(r"(?<=^what line )\d+")
"""In the words of what a later command has ruled out, the number of its line."""


@dataclass(frozen=True, slots=True)
class Piece:
    """What a piece says.

    Attributes
    ----------
    size : in code points.
    statements : none without a library.
    keys : of its steps.
    solid : whether there is more in it than comments and line ends.
    """

    size: int
    origin: int
    tokens: tuple[Token, ...]
    items: tuple[syntax.Item, ...]
    statements: tuple[typed.Statement, ...]
    keys: range
    solid: bool


@dataclass(frozen=True, slots=True)
class Played:
    """What a piece plays.

    Attributes
    ----------
    origin, line : where it began, and on which line, when that was found out.
    before : what could be playing before its first step when that was first taken; None if no step comes any more.
    sound : whether with that alone, all from there comes out the same.
    states : what may be playing before each of its statements that holds no others; others may be with them.
    """

    origin: int
    line: int
    statements: tuple[resolved.Statement, ...]
    before: State | None
    sound: bool
    states: Mapping[Span, State]


def starts_of(pieces: Sequence[Piece]) -> list[int]:
    """Return where pieces begin, and where the last ends."""
    return list(accumulate([piece.size for piece in pieces], initial=0))


def pieces_of(
    size: int, tokens: Sequence[Token], items: Sequence[syntax.Item], statements: Sequence[typed.Statement]
) -> list[Piece]:
    """Return the pieces of a text.

    Parameters
    ----------
    size : of the text, in code points.
    """
    bounds = [0, *cut(tokens).starts, size]
    parts = zip(split(tokens, bounds), split(items, bounds), split(statements, bounds), strict=True)
    pieces = []
    key = GAP
    for (start, end), (own, said, typed_) in zip(pairwise(bounds), parts, strict=True):
        keys = range(key, key + GAP * len(chart(typed_)), GAP)
        key = keys.stop
        pieces.append(Piece(end - start, start, own, said, typed_, keys, _is_solid(own)))
    return pieces


def played_of(pieces: Sequence[Piece], starts: Sequence[int], resolution: Resolution, source: Source) -> list[Played]:
    """Return what pieces play that have been resolved together.

    Parameters
    ----------
    starts : where they begin in the source, and where the last ends.
    """
    sound, reached = frozenset(resolution.sound), resolution.reached
    statements = split(resolution.plan.statements, starts)
    played = []
    number = 0
    for piece, start, own in zip(pieces, starts, statements, strict=False):
        before = reached[number] if number < len(reached) else None
        line = source.position(start)[0]
        played.append(Played(start, line, own, before, number in sound, resolution.states))
        number += len(piece.keys)
    return played


def split(values: Sequence[Placed], bounds: Sequence[int]) -> list[tuple[Placed, ...]]:
    """Return values, in the order of the text, by the stretches between bounds that they begin in."""
    places = [value.span.start for value in values]
    at = [bisect_left(places, bound) for bound in bounds]
    return [tuple(values[first:last]) for first, last in pairwise(at)]


def played_at(played: Played, start: int, line: int) -> tuple[resolved.Statement, ...]:
    """Return what a piece plays, with its places, where it begins at an offset on a line."""
    if played.origin == start and played.line == line:
        return played.statements
    statements = moved(played.statements, by(start - played.origin))
    return statements if played.line == line else tuple(_on_lines(one, line - played.line) for one in statements)


def _on_lines(statement: resolved.Statement, further: int) -> resolved.Statement:
    """Return a statement as it is when all lines that it tells of stand further down."""
    match statement:
        case resolved.Command(layers):
            return replace(statement, layers=tuple(_layer_on_lines(layer, further) for layer in layers))
        case resolved.Repeat(body=body):
            return replace(statement, body=tuple(_on_lines(one, further) for one in body))
        case resolved.Choose(branches):
            bodies = [tuple(_on_lines(one, further) for one in branch.body) for branch in branches]
            kept = [replace(branch, body=body) for branch, body in zip(branches, bodies, strict=True)]
            return replace(statement, branches=tuple(kept))
    return statement


def _layer_on_lines(layer: resolved.Layer, further: int) -> resolved.Layer:
    left_out = (
        replace(one, because=_LATER.sub(lambda found: str(int(found[0]) + further), one.because))
        for one in layer.left_out
    )
    return replace(layer, left_out=tuple(left_out))


def _is_solid(tokens: Sequence[Token]) -> bool:
    return any(token.type not in ("NEWLINE", "COMMENT") for token in tokens)
