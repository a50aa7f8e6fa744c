"""Two texts of a script -> the pieces that have to be read or understood again, and the others with them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, chain, compress
from operator import attrgetter, is_not

from mlmg_lang.analysis import InPieces
from mlmg_lang.blocks import Statement
from mlmg_lang.definitions.expand import names_in
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.nesting import Around, after
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece, read_in
from mlmg_lang.planning.recalling import Moves
from mlmg_lang.planning.resolve_again import NOT_PLAYED, Played
from mlmg_lang.source import Source


@dataclass(frozen=True, slots=True)
class Edit:
    """What was at `start` to `end` has become longer by `further`; all else is the same text."""

    start: int
    end: int
    further: int


def edit_between(before: str, after: str) -> Edit:
    """Return the smallest edit that makes one text of another."""
    limit = min(len(before), len(after))
    start = _longest(limit, lambda n: before[:n] == after[:n])
    ending = _longest(limit - start, lambda n: before[len(before) - n :] == after[len(after) - n :])
    return Edit(start, len(before) - ending, len(after) - len(before))


def _longest(limit: int, is_common: Callable[[int], bool]) -> int:
    """Return the greatest number up to a limit that something is true of, as of all smaller ones."""
    return bisect_left(range(1, limit + 1), True, key=lambda n: not is_common(n))


@dataclass(frozen=True, slots=True)
class Spot:
    """The stretch of a script that has to be read again, as a text of its own.

    Attributes
    ----------
    around : the braces around it.
    first, end : the pieces that it was before: the first, and the one behind the last.
    kept : whether the first is still the same, and there only to see that nothing is joined to it.
    """

    source: Source
    tokens: tuple[Token, ...]
    around: Around
    first: int
    end: int
    kept: bool


def reread(before: InPieces, source: Source, edit: Edit) -> Spot:
    """Return the stretch that an edit touches, with the line before it: what follows could go on with that."""
    lines, starts = before.lines, before.places.line_starts
    last_whole = min(bisect_right(starts, edit.start), len(lines)) - 2
    first = next((at for at in range(last_whole, -1, -1) if lines[at].solid), 0)
    end = min(bisect_right(starts, edit.end), len(lines))
    while True:
        spot = Source(source.text[starts[first] : starts[end] + edit.further], source.name)
        tokens, around = tokenize(spot), braces_after((), lines[:first])
        cuts = cut(tokens, len(around))
        wider = _wider(lines, range(first, end), balance(tokens, len(around)))
        if wider is None and end < len(lines) and cuts.next != len(spot.text):
            wider = range(first, end + 1)
        if wider is None:
            break
        first, end = wider.start, wider.stop
    new = cuts.starts[0] if cuts.starts else len(spot.text)
    kept = first <= last_whole and new == lines[first].size
    return Spot(spot, tokens, around, first, end, kept)


def braces_after(around: Around, lines: Sequence[Piece]) -> Around:
    """Return the braces around what comes after some lines; `around` are those around the first."""
    return after(around, chain.from_iterable(filter(None, map(attrgetter("marks"), lines))))


class CutElsewhere(Exception):
    """In other braces a script is cut into other pieces: one of them is no brace any longer, or there are too many."""


def in_other_braces(
    lines: Sequence[Piece], first: int, around: Around, text_of: Callable[[int], str]
) -> Iterator[tuple[int, Piece]]:
    """Yield the lines from one on that may say something else in the braces around them now, read again.

    Parameters
    ----------
    around : the braces around the first. text_of : gives the text of a line.

    Raises
    ------
    CutElsewhere
        If they are no pieces in these.
    """
    rest = lines[first:]
    for at in compress(range(first, len(lines)), map(attrgetter("depends"), rest)):
        if lines[at].around == around:
            return
        line = read_in(lines[at], text_of(at), around)
        if line is None:
            raise CutElsewhere
        yield at, line
        around = after(around, line.marks)


def _wider(pieces: Sequence[Piece], spot: range, new: Balance) -> range | None:
    """Return a spot with the pieces where its parentheses have their partners now; None if it need not be wider."""
    first, end = spot.start, spot.stop
    if new.n_closing:
        first = next(_open_before(pieces, first), first)
    if new.n_open or (not new.parts and any(piece.balance.parts for piece in pieces[first:end])):
        closing = next(_closing_from(pieces, end), None)
        opening = first if new.n_open else next(_open_before(pieces, first), None)
        if closing is not None and opening is not None:
            first, end = opening, closing + 1
    return None if range(first, end) == spot else range(first, end)


def _open_before(pieces: Sequence[Piece], end: int) -> Iterator[int]:
    """Yield the piece with the last parenthesis that is still open before a piece, if there is one."""
    for at in reversed(range(end)):
        if pieces[at].balance.n_open:
            yield at
        if pieces[at].balance.n_open or pieces[at].balance.parts:
            return


def _closing_from(pieces: Sequence[Piece], first: int) -> Iterator[int]:
    """Yield the first piece from one on with a parenthesis that would close one before it, if there is one."""
    for at in range(first, len(pieces)):
        if pieces[at].balance.n_closing:
            yield at
        if pieces[at].balance.n_closing or pieces[at].balance.parts:
            return


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
class Change:
    """What an edit has changed.

    Attributes
    ----------
    made : the script after it.
    first, n_new, end : the lines from `first` to `end` before it have become `n_new` others.
    again : other lines that have been read again.
    names : those that mean something else.
    numbers : the lines that may mean something else.
    """

    made: InPieces
    first: int
    n_new: int
    end: int
    again: Sequence[int]
    names: frozenset[str]
    numbers: Sequence[int]

    def touching(self, before: InPieces) -> Iterator[Piece]:
        """Yield the lines that have been read again, and those before the edit that they are in place of."""
        yield from before.lines[self.first : self.end]
        yield from self.made.lines[self.first : self.first + self.n_new]
        yield from (self.made.lines[at] for at in self.again)

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

    A name that means nothing may be a slip of one that is defined now, or be no longer.
    """
    lines = change.made.lines
    new = {*range(change.first, change.first + change.n_new), *change.again}
    if change.made.gathered is before.gathered:
        return sorted(new)
    known = ((list(of.lets), of.unread) for of in (one.gathered.definitions for one in (before, change.made)))
    same = next(known) == next(known)
    names = change.names
    others = (at for at in range(len(lines)) if at not in new)
    return sorted((*new, *(at for at in others if _may_mean_else(lines[at], names, same))))


def _may_mean_else(line: Piece, names: frozenset[str], same: bool) -> bool:
    """Return whether a line uses one of some names, or could be a slip of others; `same`: as many are defined."""
    return (not same and bool(line.said or line.n_named)) or not names.isdisjoint(line.names)


@dataclass(frozen=True, slots=True)
class PieceChange:
    """What an edit has changed of what is played.

    Attributes
    ----------
    known : what the pieces have played; of new ones, what could be playing before the first.
    numbers : the pieces that may play something else; where some are gone, the one before them.
    moves : what commands have done in pieces that are no more.
    """

    known: list[Played]
    numbers: list[int]
    moves: Sequence[Moves]


def pieces_changed(before: InPieces, change: Change) -> PieceChange:
    """Return which pieces an edit has changed."""
    old, new = before.pieces, change.made.pieces
    old_ends, new_ends = _ends(old, before.lines), _ends(new, change.made.lines)
    first = bisect_right(old_ends, change.first) - 1
    end, new_end = _same_end(old_ends, new_ends, change)
    fresh = [NOT_PLAYED] * (new_end - first)
    if fresh and first < len(before.played):
        once = before.played[first]
        fresh[0] = replace(NOT_PLAYED, before=once.before, sound=once.sound)
    numbers = [
        *(at for at in _others(old[:first], new[:first])),
        *(range(first, new_end) if fresh else [max(first - 1, 0)]),
        *(new_end + at for at in _others(old[end:], new[new_end:])),
    ]
    moves = {id(one.moves): one.moves for one in before.played[first:end]}
    return PieceChange([*before.played[:first], *fresh, *before.played[end:]], numbers, tuple(moves.values()))


def _ends(pieces: Sequence[Statement], lines: Sequence[Piece]) -> Sequence[int]:
    """Return how many lines come before each piece, and all of them."""
    if len(pieces) == len(lines):
        return range(len(lines) + 1)
    return list(accumulate(map(attrgetter("n_lines"), pieces), initial=0))


def _same_end(old: Sequence[int], new: Sequence[int], change: Change) -> tuple[int, int]:
    """Return behind which pieces, of those before and after an edit, the same come: at the latest behind all."""
    further = change.first + change.n_new - change.end
    for at in range(bisect_left(old, change.end), len(old)):
        number = bisect_left(new, old[at] + further)
        if number < len(new) and new[number] == old[at] + further:
            return at, number
    raise ValueError("a script ends where its last piece does")


def _others(old: Sequence[object], new: Sequence[object]) -> Iterator[int]:
    """Yield where there is something else than before."""
    return compress(range(len(new)), map(is_not, old, new))


def keys_of(before: InPieces, change: Change) -> list[range]:
    """Return the keys of the lines after a change; new ones have none yet."""
    return [*before.keys[: change.first], *([range(0)] * change.n_new), *before.keys[change.end :]]


def runs(numbers: Iterable[int]) -> list[range]:
    """Return numbers in their order as ranges, those that stand together in one."""
    found: list[range] = []
    for number in sorted(set(numbers)):
        if found and found[-1].stop == number:
            found[-1] = range(found[-1].start, number + 1)
        else:
            found.append(range(number, number + 1))
    return found
