"""An analysis -> what of its text can be folded away: blocks, parentheses, comments and long commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, Token
from mlmg_lang.source import Source, Span


@dataclass(frozen=True, slots=True)
class Fold:
    """What can be folded away: the rest of the first line of a span, and the lines up to its end."""

    span: Span
    is_comment: bool = False


def folds(analysis: Analysis, whole_lines: bool = False) -> tuple[Fold, ...]:
    """Return what of a script can be folded, by where it begins, the longest first; each is on several lines.

    Of two that begin on the same line and end on the same line, the longer is given alone.

    Parameters
    ----------
    whole_lines : whether all of a last line is folded away: then one that only closes what is folded stays.
    """
    made = analysis.made
    found: dict[tuple[int, int], Fold] = {}
    every = sorted((*_comments(made), *_in_pieces(made)), key=lambda fold: (fold.span.start, -fold.span.end))
    for fold in (_without_closing(fold, made.source) for fold in every) if whole_lines else every:
        first, _, last, _ = made.source.location(fold.span)
        if first < last:
            found.setdefault((first, last), fold)
    return tuple(found.values())


def _without_closing(fold: Fold, source: Source) -> Fold:
    """Return a fold without its last line, if there is nothing on that, up to its end, but what closes."""
    start = source.line_starts[source.position(fold.span.end)[0] - 1]
    last = source.text[start : fold.span.end]
    is_closing = fold.span.start < start and last.strip() != "" and not last.strip(" \t})")
    return replace(fold, span=Span(fold.span.start, start - 1)) if is_closing else fold


def _in_pieces(made: InPieces) -> Iterator[Fold]:
    """Yield what is never in several pieces."""
    for piece, start in zip(made.pieces, made.places.starts, strict=False):
        if sum(token.type == "NEWLINE" for token in piece.tokens) < 2 and start + piece.size < len(made.source.text):
            continue  # Every piece but the last ends with the end of its line.
        for fold in (*_parentheses(piece.tokens), *_laid_out(lay_out(piece.tokens).items)):
            yield Fold(fold.span.shifted(start - piece.address), fold.is_comment)


def _laid_out(items: Sequence[Line | Block]) -> Iterator[Fold]:
    """Yield blocks, their branches if there are several, and the statements that go on over lines."""
    for item in items:
        if isinstance(item, Line):
            yield Fold(_across(item))
            continue
        yield Fold(item.span)
        for branch in item.branches:
            if branch and len(item.branches) > 1:
                yield Fold(Span(_across(branch[0]).start, _across(branch[-1]).end))
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
            yield Fold(Span(opened.pop(), token.span.end))


def _comments(made: InPieces) -> Iterator[Fold]:
    """Yield runs of lines with nothing but a comment, whichever pieces they are in."""
    run: list[Span] = []
    alone, n_ends = True, 0
    for token, moved in _placed(made):
        if token.type == "NEWLINE":
            n_ends, alone = n_ends + 1, True
            continue
        if token.type != "COMMENT" or not alone or n_ends > 1:
            yield from _run(run)
            run = []
        if token.type == "COMMENT" and alone:
            run.append(token.span.shifted(moved))
        alone, n_ends = False, 0
    yield from _run(run)


def _placed(made: InPieces) -> Iterator[tuple[Token, int]]:
    """Yield all tokens, each with how far its place is from where it is now."""
    for piece, start in zip(made.pieces, made.places.starts, strict=False):
        for token in piece.tokens:
            yield token, start - piece.address


def _run(comments: Sequence[Span]) -> Iterator[Fold]:
    if len(comments) > 1:
        yield Fold(Span(comments[0].start, comments[-1].end), is_comment=True)
