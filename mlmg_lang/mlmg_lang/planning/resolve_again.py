"""What pieces play, after some of them have changed: from what is known of the others, only what may differ.

Before a change all stays as it is up to the last place that no later step has ever gone back over; after it,
commands are resolved again until what may be playing is what could be playing there before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, chain, pairwise
from operator import attrgetter

from mlmg_lang.blocks import WholeBlock
from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.nesting import Opened
from mlmg_lang.parsing.syntax import RepeatHead
from mlmg_lang.pieces import Piece
from mlmg_lang.planning import flow, resolved
from mlmg_lang.planning.chart import chart
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.passing import left_at_once
from mlmg_lang.planning.recalling import Moves, Recall
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.resolve import GAP, ReachesBack, resolve_part
from mlmg_lang.planning.unusual import unusual
from mlmg_lang.source import Source, Span

_SERIALS = 1 << 24
"""So many times pieces may change until keys are given out afresh."""
_STEP = 1 << 120
"""How far apart, in `_SERIALS`, the keys of changed steps are if there is room: many more go before and after."""


@dataclass(frozen=True, slots=True)
class Played:
    """What a piece plays.

    Attributes
    ----------
    line : on which it began when that was found out.
    before : what could be playing before its first step when that was first taken; None if no step comes any more.
    sound : whether with that alone, all from there comes out the same.
    states : what may be playing before each of its statements that holds no others; others may be with them.
    moves : what its commands have done; those of others may be with them.
    told : what is wrong with that. hints : what could be better.
    """

    statements: tuple[resolved.Statement, ...]
    line: int
    before: flow.State | None
    sound: bool
    states: Mapping[Span, flow.State]
    moves: Moves
    told: tuple[Diagnostic, ...]
    hints: tuple[Diagnostic, ...]


NOT_PLAYED = Played((), 1, None, False, {}, {}, (), ())
"""In place of what is not known yet."""


def keyed(lines: Sequence[Piece]) -> list[range]:
    """Return keys for the steps of all lines."""
    ends = list(accumulate((GAP * _n_steps(line) for line in lines), initial=GAP))
    return [range(first, end, GAP) for first, end in pairwise(ends)]


def keyed_between(
    lines: Sequence[Piece], known: Sequence[range], runs: Iterable[range], serial: int
) -> list[range] | None:
    """Return the keys of all lines, where some get such as none has had, between those around; None without room.

    Parameters
    ----------
    known : the keys so far. runs : the lines that get others.
    serial : how many times pieces have changed.
    """
    keys = list(known)
    for run in runs:
        n_steps = [_n_steps(lines[at]) for at in run]
        low = next((keys[at][-1] for at in reversed(range(run.start)) if keys[at]), 0) // _SERIALS
        after = (keys[at][0] // _SERIALS for at in range(run.stop, len(keys)) if keys[at])
        step = min((next(after, low + GAP) - low) // (sum(n_steps) + 1), _STEP)
        if step == 0 or serial >= _SERIALS:
            return None
        ends = [(low + step * n) * _SERIALS + serial for n in accumulate(n_steps, initial=1)]
        keys[run.start : run.stop] = [range(first, end, step * _SERIALS) for first, end in pairwise(ends)]
    return keys


def by_piece(keys: Sequence[range], pieces: Sequence[Piece | WholeBlock]) -> Sequence[Sequence[int]]:
    """Return the keys of the steps of pieces, from those of the lines."""
    if len(keys) == len(pieces):
        return keys
    ends = list(accumulate(map(attrgetter("n_lines"), pieces), initial=0))
    return [
        keys[first] if end == first + 1 else tuple(chain.from_iterable(keys[first:end]))
        for first, end in pairwise(ends)
    ]


def _n_steps(line: Piece) -> int:
    """Return how many steps a line has."""
    heads = sum(isinstance(mark, Opened) and isinstance(mark.head, RepeatHead) for mark in line.marks)
    return heads + len(chart(line.statements))


def played_of(
    pieces: Sequence[Piece | WholeBlock], lines: Iterable[int], keys: Sequence[Sequence[int]], resolution: Resolution
) -> list[Played]:
    """Return what pieces play that have been resolved together, without hints.

    Parameters
    ----------
    lines : on which the pieces begin.
    """
    sound, reached = frozenset(resolution.sound), resolution.reached
    by_span = {statement.span: statement for statement in resolution.plan.statements}
    played = []
    number = 0
    for piece, line, own in zip(pieces, lines, keys, strict=True):
        statements = tuple(by_span[one.span] for one in piece.statements if one.span in by_span)
        before = reached[number] if number < len(reached) else None
        steps = range(number, number + len(own))
        told = tuple(resolution.told[step] for step in steps if step in resolution.told)
        played.append(Played(statements, line, before, number in sound, resolution.states, resolution.moves, told, ()))
        number = steps.stop
    return played


@dataclass(frozen=True, slots=True)
class Player:
    """Resolves pieces of a script again.

    Attributes
    ----------
    line_of : the line on which a piece begins. keys : of the steps of each.
    start : the motion that the script starts in.
    earlier : what commands have done in pieces that are no more.
    """

    pieces: Sequence[Piece | WholeBlock]
    line_of: Callable[[int], int]
    keys: Sequence[Sequence[int]]
    library: tuple[Names, Catalog]
    source: Source
    start: str
    earlier: Sequence[Moves] = ()

    def replay(self, known: Sequence[Played], changed: Iterable[range]) -> list[Played]:
        """Return what all pieces play.

        Parameters
        ----------
        known : what they played before; of those that have changed, only what could be playing before the first.
        changed : the pieces that have, in order.
        """
        played, parts, done = list(known), list[range](), 0
        for run in changed:
            if run.stop > done:
                part = self._play(played, max(run.start, done), run.stop)
                parts.append(part)
                done = part.stop
        return self.hinted(played, parts)

    def _play(self, played: list[Played], first: int, end: int) -> range:
        """Resolve pieces that have changed, and others as far as they may play something else; return all these."""
        low, width = _sound_before(first, played), 4
        while True:
            high = min(end + width, len(self.pieces))
            try:
                resolution, high = self._resolved(range(low, high), end, played)
            except ReachesBack as back:
                low = _sound_before(_holder(back.key, self.keys, low), played)
                continue
            if resolution.joins is not None or high == len(self.pieces):
                lines = map(self.line_of, range(low, high))
                played[low:high] = played_of(self.pieces[low:high], lines, self.keys[low:high], resolution)
                return range(low, high)
            width *= 4

    def _resolved(self, part: range, end: int, known: Sequence[Played]) -> tuple[Resolution, int]:
        """Return what some pieces play, and at which piece all from there is known."""
        pieces = self.pieces[part.start : part.stop]
        own = self.keys[part.start : part.stop]
        first_steps = list(accumulate(map(len, own), initial=0))
        states: dict[int, flow.State] = {}
        joined_at: dict[int, int] = {}
        for at in range(end, part.stop):
            once, number = known[at], first_steps[at - part.start]
            if once.sound and once.before is not None:
                states[number] = once.before
                joined_at.setdefault(number, at)
        before = known[part.start].before if part.start else None
        state = flow.begin(self.library[0], self.start) if before is None else before
        statements = [one for piece in pieces for one in piece.statements]
        steps = [key for keys in own for key in keys]
        moves = {id(one.moves): one.moves for one in known[part.start : part.stop]}
        recall = Recall((*self.earlier, *moves.values()))
        resolution = resolve_part(statements, self.library, self.source, (self.start, state), steps, states, recall)
        return resolution, part.stop if resolution.joins is None else joined_at[resolution.joins]

    def hinted(self, played: Sequence[Played], parts: Iterable[range]) -> list[Played]:
        """Return what pieces play, with what could be better in some of them, and in the last statement before each."""
        found = list(played)
        for part in parts:
            before = next((at for at in reversed(range(part.start)) if played[at].statements), None)
            for at in (*([] if before is None else [before]), *part):
                if played[at].statements:
                    found[at] = replace(played[at], hints=self._hints(played, at))
        return found

    def _hints(self, played: Sequence[Played], at: int) -> tuple[Diagnostic, ...]:
        own, states = played[at].statements, played[at].states
        later = (played[number].statements for number in range(at + 1, len(played)))
        following = next((statements[0] for statements in later if statements), None)
        beside = (*own, following) if isinstance(following, resolved.Command) else own
        alone, around = (
            Resolution(resolved.ResolvedPlan(self.source, self.start, part), (), {}, states, (), (), {})
            for part in (own, beside)
        )
        names, catalog = self.library
        return (*left_at_once(around, names), *unusual(alone, names, catalog))


def _sound_before(at: int, known: Sequence[Played]) -> int:
    """Return the last piece up to one from which one can begin again."""
    return next((n for n in range(min(at, len(known) - 1), 0, -1) if known[n].sound), 0)


def _holder(key: int, keys: Sequence[Sequence[int]], before: int) -> int:
    """Return the piece that has a step."""
    return next(at for at in range(before - 1, -1, -1) if key in keys[at])
