"""What pieces play, after some of them have changed: from what is known of the others, only what may differ.

Before a change all stays as it is up to the last place that no later step has ever gone back over; after it,
commands are resolved again until what may be playing is what could be playing there before.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, chain, pairwise

from mlmg_lang.blocks import Statement
from mlmg_lang.catalog import Catalog
from mlmg_lang.chunks import Chunks
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.nesting import Opened
from mlmg_lang.parsing.syntax import RepeatHead
from mlmg_lang.pieces import Piece
from mlmg_lang.places import Places
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
    row : how many line ends there were before it when that was found out.
    before : what could be playing before its first step when that was first taken; None if no step comes any more.
    sound : whether with that alone, all from there comes out the same.
    states : what may be playing before each of its statements that holds no others; others may be with them.
    moves : what its commands have done; those of others may be with them.
    told : what is wrong with that. hints : what could be better.
    """

    statements: tuple[resolved.Statement, ...]
    row: int
    before: flow.State | None
    sound: bool
    states: Mapping[Span, flow.State]
    moves: Moves
    told: tuple[Diagnostic, ...]
    hints: tuple[Diagnostic, ...]


NOT_PLAYED = Played((), 0, None, False, {}, {}, (), ())
"""In place of what is not known yet."""


def keyed(lines: Iterable[Piece]) -> Chunks[range]:
    """Return keys for the steps of all lines."""
    ends = list(accumulate((GAP * _n_steps(line) for line in lines), initial=GAP))
    return Chunks(range(first, end, GAP) for first, end in pairwise(ends))


def keyed_between(
    lines: Sequence[Piece], known: Chunks[range], runs: Iterable[range], serial: int
) -> Chunks[range] | None:
    """Return the keys of all lines, where some get such as none has had, between those around; None without room.

    Parameters
    ----------
    known : the keys so far. runs : the lines that get others.
    serial : how many times pieces have changed.
    """
    keys = known
    for run in runs:
        n_steps = [_n_steps(lines[at]) for at in run]
        low = next((keys[at][-1] for at in reversed(range(run.start)) if keys[at]), 0) // _SERIALS
        after = (keys[at][0] // _SERIALS for at in range(run.stop, len(keys)) if keys[at])
        step = min((next(after, low + GAP) - low) // (sum(n_steps) + 1), _STEP)
        if step == 0 or serial >= _SERIALS:
            return None
        ends = [(low + step * n) * _SERIALS + serial for n in accumulate(n_steps, initial=1)]
        own = [range(first, end, step * _SERIALS) for first, end in pairwise(ends)]
        keys = keys.spliced(run.start, run.stop, own)
    return keys


def _n_steps(line: Piece) -> int:
    """Return how many steps a line has."""
    heads = sum(isinstance(mark, Opened) and isinstance(mark.head, RepeatHead) for mark in line.marks)
    return heads + len(chart(line.statements))


def with_unknown(known: Chunks[Played], first: int, n_new: int, end: int) -> tuple[Chunks[Played], Sequence[Moves]]:
    """Return what pieces play where those from `first` to before `end` have become others, of which that is not known.

    Only what could be playing before the first of these is; the rest is what commands have done in those before them.
    """
    gone, fresh = known[first:end], [NOT_PLAYED] * n_new
    if fresh and first < len(known):
        fresh[0] = replace(NOT_PLAYED, before=known[first].before, sound=known[first].sound)
    moves = {id(one.moves): one.moves for one in gone}
    return known.spliced(first, end, fresh), tuple(moves.values())


@dataclass(frozen=True, slots=True)
class Player:
    """Resolves pieces of a script again.

    Attributes
    ----------
    keys : of the steps of each line.
    start : the motion that the script starts in.
    earlier : what commands have done in pieces that are no more.
    """

    places: Places
    keys: Chunks[range]
    library: tuple[Names, Catalog]
    source: Source
    start: str
    earlier: Sequence[Moves] = ()

    def played(self, resolution: Resolution) -> Chunks[Played]:
        """Return what all pieces play, which have been resolved together."""
        everything = range(len(self.places.pieces))
        return self._hinted(Chunks(self._of(resolution, everything)), [everything])

    def replay(self, known: Chunks[Played], changed: Iterable[range]) -> Chunks[Played]:
        """Return what all pieces play.

        Parameters
        ----------
        known : what they played before; of those that have changed, only what could be playing before the first.
        changed : the pieces that have, in order.
        """
        played, parts, done = known, list[range](), 0
        for run in changed:
            if run.stop > done:
                part, resolution = self._play(played, max(run.start, done), run.stop)
                played = played.spliced(part.start, part.stop, tuple(self._of(resolution, part)))
                parts.append(part)
                done = part.stop
        return self._hinted(played, parts)

    def _play(self, known: Chunks[Played], first: int, end: int) -> tuple[range, Resolution]:
        """Resolve pieces that have changed, and others as far as they may play something else; return which."""
        low, width, n_pieces = _sound(known, first), 4, len(self.places.pieces)
        while True:
            high = min(end + width, n_pieces)
            try:
                resolution, high = self._resolved(range(low, high), end, known)
            except ReachesBack as back:
                low = _sound(known, self._holder(back.key, low))
                continue
            if resolution.joins is not None or high == n_pieces:
                return range(low, high), resolution
            width *= 4

    def _resolved(self, part: range, end: int, known: Sequence[Played]) -> tuple[Resolution, int]:
        """Return what some pieces play, and at which piece all from there is known."""
        pieces, own = self._pieces(part), self._keys(part)
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

    def _of(self, resolution: Resolution, part: range) -> Iterator[Played]:
        """Yield what some pieces play that have been resolved together, without hints."""
        sound, reached = frozenset(resolution.sound), resolution.reached
        by_span = {statement.span: statement for statement in resolution.plan.statements}
        number = 0
        for at, piece, own in zip(part, self._pieces(part), self._keys(part), strict=True):
            statements = tuple(by_span[one.span] for one in piece.statements if one.span in by_span)
            before = reached[number] if number < len(reached) else None
            steps = range(number, number + len(own))
            told = tuple(resolution.told[step] for step in steps if step in resolution.told)
            row, states, moves = self.places.row(at), resolution.states, resolution.moves
            yield Played(statements, row, before, number in sound, states, moves, told, ())
            number = steps.stop

    def _pieces(self, part: range) -> Sequence[Statement]:
        return self.places.pieces[part.start : part.stop]

    def _keys(self, part: range) -> list[Sequence[int]]:
        """Return the keys of the steps of some pieces."""
        bounds = self.places.first_lines[part.start : part.stop + 1]
        keys = self.keys[bounds[0] : bounds[-1]]
        stretches = (keys[first - bounds[0] : end - bounds[0]] for first, end in pairwise(bounds))
        return [own[0] if len(own) == 1 else tuple(chain.from_iterable(own)) for own in stretches]

    def _holder(self, key: int, before: int) -> int:
        """Return the piece that has a step, one that is before some piece."""
        lines = reversed(range(self.places.first_lines[before]))
        return self.places.first_lines.last_to(next(at for at in lines if key in self.keys[at]))

    def _hinted(self, played: Chunks[Played], parts: Iterable[range]) -> Chunks[Played]:
        """Return what pieces play, with what could be better in some of them, and in the last statement before each."""
        found: dict[int, Played] = {}
        for part in parts:
            before = next(played.where_back("statements", part.start), None)
            for at in (*([] if before is None else [before]), *part):
                if played[at].statements:
                    found[at] = replace(played[at], hints=self._hints(played, at))
        return played.replaced(found)

    def _hints(self, played: Chunks[Played], at: int) -> tuple[Diagnostic, ...]:
        own, states = played[at].statements, played[at].states
        following = next((played[number].statements[0] for number in played.where("statements", at + 1)), None)
        beside = (*own, following) if isinstance(following, resolved.Command) else own
        alone, around = (
            Resolution(resolved.ResolvedPlan(self.source, self.start, part), (), {}, states, (), (), {})
            for part in (own, beside)
        )
        names, catalog = self.library
        return (*left_at_once(around, names), *unusual(alone, names, catalog))


def _sound(known: Chunks[Played], at: int) -> int:
    """Return the last piece up to one from which one can begin again."""
    return next(known.where_back("sound", at + 1), 0)
