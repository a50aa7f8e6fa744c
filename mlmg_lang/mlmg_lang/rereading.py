"""Two texts of a script -> the lines that have to be read again, where an edit is and behind it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, islice, pairwise, takewhile

from mlmg_lang.analysis import InPieces
from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.common_ends import common_ends
from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.layout import Close
from mlmg_lang.parsing.lookalikes import narrowed
from mlmg_lang.parsing.nesting import Around, after
from mlmg_lang.parsing.parse import MAX_MISTAKES
from mlmg_lang.parsing.quotes import requoted
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece, read_in
from mlmg_lang.source import Edit, Source, Span


def edit_between(before: str, after: str) -> Edit:
    """Return the smallest edit that makes one text of another."""
    head, tail = common_ends(before, after)
    return Edit(Span(head, len(before) - tail), after[head : len(after) - tail])


@dataclass(frozen=True, slots=True)
class Spot:
    """The stretch of a script that has to be read again, as a text of its own.

    Attributes
    ----------
    around : the braces around it. n_before : how many mistakes in texts are told before it.
    first, end : the pieces that it was before: the first, and the one behind the last.
    """

    source: Source
    tokens: tuple[Token, ...]
    around: Around
    n_before: int
    first: int
    end: int


def reread(before: InPieces, source: Source, edit: Edit) -> Spot:
    """Return the stretch that an edit touches, with the line before it: what follows could go on with that."""
    lines, starts = before.lines, before.places.logical_line_starts
    last_whole = before.places.line_at(edit.span.start) - 1
    first = next((at for at in range(last_whole, -1, -1) if lines[at].solid), 0)
    end = min(starts.last_to(edit.span.end) + 1, len(lines))
    while True:
        spot = Source(source.text[starts[first] : starts[end] + edit.further], source.name)
        tokens, around = tokenize(spot), braces_before(lines, first)
        cuts = cut(narrowed(requoted(tokens)), len(around))
        wider = _wider(lines, range(first, end), balance(tokens, len(around)))
        if wider is None and end < len(lines) and cuts.next != len(spot.text):
            wider = range(first, end + 1)
        if wider is None:
            break
        first, end = wider.start, wider.stop
    return Spot(spot, tokens, around, lines.sums("n_mistakes")[first], first, end)


def _wider(lines: Chunks[Piece], spot: range, new: Balance) -> range | None:
    """Return a spot with the pieces where its parentheses have their partners now; None if it need not be wider."""
    first, end = spot.start, spot.stop
    if new.n_closing:
        first = next(_open_before(lines, first), first)
    if new.n_open or (not new.parts and any(line.balance.parts for line in lines[first:end])):
        closing = next(_closing_from(lines, end), None)
        opening = first if new.n_open else next(_open_before(lines, first), None)
        if closing is not None and opening is not None:
            first, end = opening, closing + 1
    return None if range(first, end) == spot else range(first, end)


def _open_before(lines: Chunks[Piece], end: int) -> Iterator[int]:
    """Yield the line with the last parenthesis that is still open before a line, if there is one."""
    return (at for at in islice(lines.where_back("balance.ends_before", end), 1) if lines[at].balance.n_open)


def _closing_from(lines: Chunks[Piece], first: int) -> Iterator[int]:
    """Yield the first line from one on with a parenthesis that would close one before it, if there is one."""
    return (at for at in islice(lines.where("balance.ends_after", first), 1) if lines[at].balance.n_closing)


def without_same(before: InPieces, spot: Spot, new: Sequence[Piece]) -> tuple[int, Sequence[Piece], int]:
    """Return new lines without those at both ends that are as they were, and from which to before which they stand.

    Those have been read only to see that nothing is joined to them.
    """
    starts, first, end = before.places.logical_line_starts, spot.first, spot.end
    old = _with_texts(before.lines[first:end], before.source.text[starts[first] : starts[end]])
    now = _with_texts(new, spot.source.text)
    n_first = _n_same(old, now)
    n_last = _n_same(reversed(old[n_first:]), reversed(now[n_first:]))
    return first + n_first, new[n_first : len(new) - n_last], end - n_last


def _with_texts(lines: Sequence[Piece], text: str) -> list[tuple[Piece, str]]:
    ends = accumulate((line.size for line in lines), initial=0)
    return [(line, text[start:end]) for line, (start, end) in zip(lines, pairwise(ends), strict=True)]


def _n_same(old: Iterable[tuple[Piece, str]], new: Iterable[tuple[Piece, str]]) -> int:
    """Return how many lines say what others do, up to the first that may not."""
    pairs = takewhile(lambda pair: _says_the_same(*pair), zip(old, new, strict=False))
    return sum(1 for _ in pairs)


def _says_the_same(old: tuple[Piece, str], new: tuple[Piece, str]) -> bool:
    same_braces = old[0].around == new[0].around or not old[0].depends
    return old[1] == new[1] and same_braces and old[0].is_read_behind(new[0].counted.start)


def braces_before(lines: Chunks[Piece], number: int) -> Around:
    """Return the braces around what comes before a line."""
    around: Around = ()
    for n_closed, opened in lines.each_before(number, _turn, "marks"):
        around = (*around[: max(len(around) - n_closed, 0)], *opened)
    return around


def _turn(lines: Iterable[Piece], name: str) -> tuple[int, Around]:
    """Return how many braces around the first of some lines are closed in them, and which are opened and stay so."""
    n_closed = 0
    opened: Around = ()
    for mark in all_of(lines, name):
        n_closed += isinstance(mark, Close) and not opened
        opened = after(opened, (mark,))
    return n_closed, opened


class CutElsewhere(Exception):
    """A line behind an edit is no line by itself any longer, so that all is to be read afresh.

    In the braces that are around it now, a sign in it may be a stray one, which is left out before a script is cut
    into lines: its text would be several lines, or its parentheses would have other partners. Or it would stand in
    more braces than are read.
    """


@dataclass(frozen=True, slots=True)
class Behind:
    """What a line needs to know of those before it: the braces around it, and how many mistakes have been told."""

    around: Around
    n_mistakes: int


def behind(lines: Chunks[Piece], number: int) -> Behind:
    """Return what a line needs to know of those before it."""
    return Behind(braces_before(lines, number), lines.sums("n_mistakes")[number])


def read_behind(
    lines: Chunks[Piece], first: int, was: Behind, now: Behind, text_of: Callable[[int], str]
) -> Iterator[tuple[int, Piece]]:
    """Yield the lines from one on that may say something else behind what stands before them now, read again.

    Parameters
    ----------
    was, now : what the first was behind, and is. text_of : gives the text of a line.

    Raises
    ------
    CutElsewhere
        If they are no pieces any longer.
    """
    around, n_now, further = now.around, now.n_mistakes, now.n_mistakes - was.n_mistakes
    at = first
    while True:
        if n_now < MAX_MISTAKES:  # others say the same wherever something is read
            at = next(lines.where("depends", at), len(lines))
        if at == len(lines):
            return
        line = again = lines[at]
        if line.depends and not further and line.around == around:
            return
        if not line.is_read_behind(n_now) or (line.depends and line.around != around):
            read = read_in(line, text_of(at), around, n_now)
            if read is None:
                raise CutElsewhere
            again = read
            yield at, again
            further += again.n_mistakes - line.n_mistakes
        n_now += again.n_mistakes
        around = after(around, again.marks)
        at += 1
