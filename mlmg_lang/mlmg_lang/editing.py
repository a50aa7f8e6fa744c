"""Two texts of a script -> the pieces that have to be read or understood again, and the others with them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from mlmg_lang.analysis import InPieces
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.definitions.parameters import references
from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece
from mlmg_lang.planning.resolve_again import NOT_PLAYED, Played
from mlmg_lang.source import Source
from mlmg_lang.spelling import normal


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
    first, end : the pieces that it was before: the first, and the one behind the last.
    kept : whether the first is still the same, and there only to see that nothing is joined to it.
    """

    source: Source
    tokens: tuple[Token, ...]
    first: int
    end: int
    kept: bool


def reread(before: InPieces, source: Source, edit: Edit) -> Spot:
    """Return the stretch that an edit touches, with the piece before it: what follows could go on with that."""
    pieces, starts = before.pieces, before.places.starts
    last_whole = min(bisect_right(starts, edit.start), len(pieces)) - 2
    first = next((at for at in range(last_whole, -1, -1) if pieces[at].solid), 0)
    end = min(bisect_right(starts, edit.end), len(pieces))
    while True:
        spot = Source(source.text[starts[first] : starts[end] + edit.further], source.name)
        tokens = tokenize(spot)
        cuts = cut(tokens)
        wider = _wider(pieces, range(first, end), balance(tokens))
        if wider is None and end < len(pieces) and not cuts.closed:
            wider = range(first, min(end + 2 * (end - first), len(pieces)))
        if wider is None:
            break
        first, end = wider.start, wider.stop
    new = cuts.starts[0] if cuts.starts else len(spot.text)
    kept = first <= last_whole and new == pieces[first].size
    return Spot(spot, tokens, first, end, kept)


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
    users: dict[str, set[str]] = {}
    for name, let in after.lets.items():
        for used in references(let):
            users.setdefault(normal(used.text), set()).add(name)
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
    first, n_new, end : the pieces from `first` to `end` before it have become `n_new` others.
    names : those that mean something else.
    numbers : the pieces that may mean something else.
    """

    made: InPieces
    first: int
    n_new: int
    end: int
    names: frozenset[str]
    numbers: Sequence[int]

    @property
    def replayed(self) -> Sequence[int]:
        """Return the pieces that may play something else; where some are gone, the one before them."""
        return self.numbers if self.n_new else (*self.numbers, max(self.first - 1, 0))

    def uses_the_same(self, before: InPieces) -> bool:
        """Return whether the new pieces use the names that those before them did."""
        new = self.made.pieces[self.first : self.first + self.n_new]
        uses = ({(piece.used, piece.broken) for piece in part} for part in (new, before.pieces[self.first : self.end]))
        return next(uses) == next(uses)


def touched(before: InPieces, change: Change) -> list[int]:
    """Return the pieces that may mean something else: new ones, users of what has changed, and mistakes.

    A name that means nothing may be a slip of one that is defined now, or be no longer.
    """
    pieces = change.made.pieces
    new = range(change.first, change.first + change.n_new)
    if change.made.gathered is before.gathered:
        return list(new)
    known = (list(one.gathered.definitions.lets) for one in (before, change.made))
    same = next(known) == next(known)
    others = (at for at in range(len(pieces)) if at not in new)
    names = change.names
    return sorted(
        (*new, *(at for at in others if (pieces[at].said and not same) or not names.isdisjoint(pieces[at].used)))
    )


def known_of(before: InPieces, change: Change) -> list[Played]:
    """Return what the pieces after a change have played; of new ones, what could be playing before the first."""
    played = before.played
    new = [NOT_PLAYED] * change.n_new
    if new and change.first < len(played):
        once = played[change.first]
        new[0] = replace(NOT_PLAYED, before=once.before, sound=once.sound)
    return [*played[: change.first], *new, *played[change.end :]]


def keys_of(before: InPieces, change: Change) -> list[range]:
    """Return the keys of the pieces after a change; new ones have none yet."""
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
