"""An analysis -> what of its text can be folded away: blocks, parentheses, comments and long commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from mlmg_lang.analysis import Analysis
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, Token
from mlmg_lang.source import Span


class Kind(StrEnum):
    """What is folded away."""

    BLOCK = "block"
    BRANCH = "branch"
    PARENTHESES = "parentheses"
    COMMENT = "comment"
    COMMAND = "command"


@dataclass(frozen=True, slots=True)
class Fold:
    """What can be folded away: the rest of the first line of a span, and the lines up to its end."""

    span: Span
    kind: Kind


def folds(analysis: Analysis) -> tuple[Fold, ...]:
    """Return what of a script can be folded, by where it begins, the longest first; each is on several lines.

    Of two that begin on the same line and end on the same line, the longer is given alone.
    """
    made = analysis.made
    found: dict[tuple[int, int], Fold] = {}
    for piece, start in zip(made.pieces, made.places.starts, strict=False):
        if sum(token.type == "NEWLINE" for token in piece.tokens) < 2 and start + piece.size < len(made.source.text):
            continue  # Every piece but the last ends with the end of its line.
        for fold in sorted(_folds(piece.tokens), key=lambda fold: (fold.span.start, -fold.span.end)):
            span = Span(*(offset + start - piece.address for offset in (fold.span.start, fold.span.end)))
            first, _, last, _ = made.source.location(span)
            if first < last:
                found.setdefault((first, last), Fold(span, fold.kind))
    return tuple(found.values())


def _folds(tokens: Sequence[Token]) -> Iterator[Fold]:
    yield from _comments(tokens)
    yield from _parentheses(tokens)
    yield from _laid_out(lay_out(tokens).items)


def _laid_out(items: Sequence[Line | Block]) -> Iterator[Fold]:
    """Yield blocks, their branches if there are several, and the statements that go on over lines."""
    for item in items:
        if isinstance(item, Line):
            yield Fold(_across(item), Kind.COMMAND)
            continue
        yield Fold(item.span, Kind.BLOCK)
        for branch in item.branches:
            if branch and len(item.branches) > 1:
                yield Fold(Span(_across(branch[0]).start, _across(branch[-1]).end), Kind.BRANCH)
            yield from _laid_out(branch)


def _across(item: Line | Block) -> Span:
    if isinstance(item, Block):
        return item.span
    return Span(item.tokens[0].span.start, item.tokens[-1].span.end)


def _parentheses(tokens: Sequence[Token]) -> Iterator[Fold]:
    opened: list[int] = []
    for token in tokens:
        if token.type in ENDS_PARENTHESES:
            opened.clear()
        elif token.type == "LEFT":
            opened.append(token.span.start)
        elif token.type == "RIGHT" and opened:
            yield Fold(Span(opened.pop(), token.span.end), Kind.PARENTHESES)


def _comments(tokens: Sequence[Token]) -> Iterator[Fold]:
    """Yield runs of lines with nothing but a comment."""
    run: list[Token] = []
    alone = True
    n_ends = 0
    for token in tokens:
        if token.type == "NEWLINE":
            n_ends += 1
            alone = True
            continue
        if token.type != "COMMENT" or not alone or n_ends > 1:
            yield from _run(run)
            run = []
        if token.type == "COMMENT" and alone:
            run.append(token)
        alone, n_ends = False, 0
    yield from _run(run)


def _run(comments: Sequence[Token]) -> Iterator[Fold]:
    if len(comments) > 1:
        yield Fold(Span(comments[0].span.start, comments[-1].span.end), Kind.COMMENT)
