"""Two texts of a script -> the pieces that have to be read again, and the others with them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from mlmg_lang.analysis import InPieces
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.moving import moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.cutting import cut
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning import typed
from mlmg_lang.planning.pieces import pieces_of, starts_of
from mlmg_lang.planning.resolve_again import Change, keyed
from mlmg_lang.source import Source


@dataclass(frozen=True, slots=True)
class Edit:
    """What was at `start` to `end` has become longer by `further`; all else is the same text."""

    start: int
    end: int
    further: int

    def place(self, offset: int) -> int:
        """Return where an offset that the edit does not touch has come to."""
        return offset + self.further if offset >= self.end and offset > self.start else offset


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
    start : where it begins in the script.
    first, end : the pieces that it was before: the first, and the one behind the last.
    kept : whether the first is still the same, and there only to see that nothing is joined to it.
    """

    source: Source
    tokens: tuple[Token, ...]
    start: int
    first: int
    end: int
    kept: bool


def reread(before: InPieces, source: Source, edit: Edit) -> Spot:
    """Return the stretch that an edit touches, with the piece before it: what follows could go on with that."""
    pieces, starts = before.pieces, before.starts
    last_whole = min(bisect_right(starts, edit.start), len(pieces)) - 2
    first = next((at for at in range(last_whole, -1, -1) if pieces[at].solid), 0)
    end = min(bisect_right(starts, edit.end), len(pieces))
    while True:
        spot = Source(source.text[starts[first] : starts[end] + edit.further], source.name)
        tokens = tokenize(spot)
        cuts = cut(tokens)
        if end == len(pieces) or cuts.closed:
            break
        end = min(end + 2 * (end - first), len(pieces))
    new = cuts.starts[0] if cuts.starts else len(spot.text)
    kept = first <= last_whole and new == pieces[first].size
    return Spot(spot, tokens, starts[first], first, end, kept)


def change_of(
    before: InPieces, spot: Spot, items: Sequence[syntax.Item], statements: Sequence[typed.Statement]
) -> Change | None:
    """Return the pieces of a script of which a stretch has been read again; None if there is no room for their keys."""
    new = pieces_of(len(spot.source.text), spot.tokens, items, statements)[int(spot.kept) :]
    earlier, later = before.pieces[: spot.first + spot.kept], before.pieces[spot.end :]
    own = keyed(new, earlier, later, before.serial + 1)
    if own is None:
        return None
    pieces = [*earlier, *own, *later]
    end = len(earlier) + len(own)
    return Change(pieces, starts_of(pieces), len(earlier), end, len(pieces) - len(before.pieces))


def spliced(
    old: Iterable[Diagnostic], new: Iterable[Diagnostic], start: int, end: int | None, edit: Edit
) -> tuple[Diagnostic, ...]:
    """Return diagnostics with those of a stretch replaced, and those behind an edit where they have come to.

    Parameters
    ----------
    start, end : of the stretch, in the text before the edit; None if it goes to the end.
    """
    before, behind = [], []
    for one in old:
        if one.span is not None and one.span.start < start:
            before.append(one)
        elif one.span is not None and end is not None and one.span.start >= end:
            behind.append(moved(one, edit.place))
    return (*before, *new, *behind)
