"""Two texts of a script -> the pieces that have to be read or understood again, and the others with them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, chain, islice, pairwise, takewhile

from mlmg_lang.analysis import InPieces
from mlmg_lang.blocks import Statement, WholeBlock, block_of, blocks
from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.common_ends import common_ends
from mlmg_lang.definitions.expand import names_in
from mlmg_lang.definitions.gather import Definitions
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


def changed_names(before: Definitions, after: Definitions) -> frozenset[str]:
    """Return the names that mean something else than before, if they are used."""
    names = {*before.lets, *after.lets}
    changed = {name for name in names if _meaning(before, name) != _meaning(after, name)}
    changed |= before.unread ^ after.unread
    users: dict[str, set[str]] = {}
    for name, let in after.lets.items():
        for used in names_in(let):
            users.setdefault(used, set()).add(name)
    pending = list(changed)
    while pending:
        fresh = users.get(pending.pop(), set()) - changed
        changed |= fresh
        pending += fresh
    return frozenset(changed)


def _meaning(definitions: Definitions, name: str) -> tuple[object, object]:
    return id(definitions.lets.get(name)), definitions.signatures.get(name)


@dataclass(frozen=True, slots=True)
class Regrouping:
    """What an edit has changed of the pieces that stand in no block.

    Attributes
    ----------
    first, n_new, end : the pieces from `first` to `end` before it have become `n_new` others.
    others : pieces after it of which some line has changed besides.
    """

    first: int
    n_new: int
    end: int
    others: Sequence[int]

    @property
    def numbers(self) -> list[int]:
        """Return the pieces that may play something else; where some are gone, the one before them."""
        new = range(self.first, self.first + self.n_new) or [max(self.first - 1, 0)]
        return sorted({*new, *self.others})


@dataclass(frozen=True, slots=True)
class Change:
    """What an edit has changed.

    Attributes
    ----------
    made : the script after it.
    first, n_new, end : the lines from `first` to `end` before it have become `n_new` others.
    again : other lines that have been read again.
    names : those that mean something else.
    numbers : the lines that may mean something else.
    regrouping : what that makes of its pieces.
    """

    made: InPieces
    first: int
    n_new: int
    end: int
    again: Sequence[int] = ()
    names: frozenset[str] = frozenset()
    numbers: Sequence[int] = ()
    regrouping: Regrouping = Regrouping(0, 0, 0, ())

    def touching(self, before: InPieces) -> Iterator[Piece]:
        """Yield the lines that have been read again, and those before the edit that they are in place of."""
        yield from before.lines[self.first : self.end]
        yield from self.made.lines[self.first : self.first + self.n_new]
        further = self.first + self.n_new - self.end
        for at in self.again:
            yield before.lines[at - further]
            yield self.made.lines[at]

    def moves_braces(self, before: InPieces) -> bool:
        """Return whether there may be other braces around the lines behind the edit."""
        return any(line.marks for line in self.touching(before))

    def uses_the_same(self, before: InPieces) -> bool:
        """Return whether the new lines use the names that those before them did."""
        new = self.made.lines[self.first : self.first + self.n_new]
        uses = ({(line.used, line.broken) for line in part} for part in (new, before.lines[self.first : self.end]))
        return next(uses) == next(uses)


def touched(before: InPieces, change: Change) -> list[int]:
    """Return the lines that may mean something else: new ones, users of what has changed, and mistakes.

    A name that means nothing may be a slip of one that is defined now, or be no longer; and where not all definitions
    are known, it may be that of one.
    """
    lines = change.made.lines
    new = {*range(change.first, change.first + change.n_new), *change.again}
    if change.made.gathered is before.gathered:
        return sorted(new)
    old, now = before.gathered.definitions, change.made.gathered.definitions
    if (list(old.lets), old.unread) != (list(now.lets), now.unread):
        new.update(lines.where("said"), lines.where("n_named"))
    if old.complete != now.complete:
        new.update(lines.where("told"), lines.where("is_faulty"), lines.where("miscalls"))
    return sorted(new.union(lines.where_among("names", change.names)))


def regrouped(before: InPieces, change: Change) -> Change:
    """Return a change of which the lines are known, with the blocks that lie across these."""
    made = change.made
    if before.pieces is before.lines and not change.moves_braces(before):
        new = range(change.first, change.first + change.n_new)
        others = [number for number in change.numbers if number not in new]
        return replace(change, regrouping=Regrouping(change.first, change.n_new, change.end, others))
    first, new_pieces, end, room = _grouped_again(before, change)
    pieces: Chunks[Statement] = before.pieces.spliced(first, end, new_pieces)
    first_lines = pieces.sums("n_logical_lines")
    changed: dict[int, Statement] = {}
    for number in change.numbers:
        at = first_lines.last_to(number)
        if not first <= at < first + len(new_pieces) and at not in changed:
            own = made.lines[first_lines[at] : first_lines[at + 1]]
            changed[at], room = block_of(own, room) if isinstance(pieces[at], WholeBlock) else (own[0], room)
    made = replace(made.with_pieces(pieces.replaced(changed), made.lines), room=room)
    return replace(change, made=made, regrouping=Regrouping(first, len(new_pieces), end, sorted(changed)))


def _grouped_again(before: InPieces, change: Change) -> tuple[int, list[Statement], int, int]:
    """Return which pieces have become others, from one to before another; these; and the first address unused then."""
    lines, starts = change.made.lines, before.places.first_lines
    behind = change.first + change.n_new
    further = behind - change.end
    first = min(starts.last_to(change.first), len(before.pieces) - 1)
    done, room = starts[first], change.made.room
    found: list[Statement] = []
    for begin, end in chain(blocks(lines, done), [(len(lines), len(lines))]):
        # From where a piece began already, be it after the block before this one or sooner, all stays as it was.
        same = bisect_left(starts, max(done, behind) - further)
        if starts[same] + further <= begin:
            found += lines[done : starts[same] + further]
            return first, found, same, room
        block, room = block_of(lines[begin:end], room)
        found += (*lines[done:begin], block)
        done = end
    raise ValueError("a script ends where its last piece does")


def runs(numbers: Iterable[int]) -> list[range]:
    """Return numbers in their order as ranges, those that stand together in one."""
    found: list[range] = []
    for number in sorted(set(numbers)):
        if found and found[-1].stop == number:
            found[-1] = range(found[-1].start, number + 1)
        else:
            found.append(range(number, number + 1))
    return found
