"""Lines of a script that have been read again -> what else may mean or play something else, and the blocks anew."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

from mlmg_lang.analysis import InPieces
from mlmg_lang.blocks import Statement, WholeBlock, block_of, blocks
from mlmg_lang.chunks import Chunks
from mlmg_lang.definitions.expand import names_in
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.pieces import Piece


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
