"""What pieces play, after some of them have changed: from what is known of the others, only what may differ.

Before the change all stays as it is up to the last place that no later step has ever gone back over; after it,
commands are resolved again until what may be playing is what could be playing there before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.moving import by, moved
from mlmg_lang.planning import flow, resolved, typed
from mlmg_lang.planning.chart import chart
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.pieces import Piece, Played, played_of
from mlmg_lang.planning.resolve import GAP, ReachesBack, Resolution, resolve_part
from mlmg_lang.source import Source

_SERIALS = 1 << 24
"""So many times pieces may change until keys are given out afresh."""
_STEP = 1 << 120
"""How far apart, in `_SERIALS`, the keys of changed steps are if there is room: many more go before and after."""


@dataclass(frozen=True, slots=True)
class Change:
    """Pieces that have taken the place of others.

    Attributes
    ----------
    pieces, starts : all of the script, and where they begin; last, where it ends.
    first, end : which of them are new.
    further : how many pieces further down those after them have come.
    """

    pieces: Sequence[Piece]
    starts: Sequence[int]
    first: int
    end: int
    further: int


@dataclass(frozen=True, slots=True)
class Replay:
    """What has been resolved again.

    Attributes
    ----------
    low, high : the first piece of it, and the one behind the last.
    diagnostics : of these pieces.
    resolution : of these pieces, with the statement before them if that is a command.
    around : the same with the statement behind them too, if that is a command.
    since : where `resolution` begins.
    """

    played: list[Played]
    low: int
    high: int
    diagnostics: tuple[Diagnostic, ...]
    resolution: Resolution
    around: Resolution
    since: int


def keyed(new: Sequence[Piece], before: Sequence[Piece], after: Sequence[Piece], serial: int) -> list[Piece] | None:
    """Return new pieces with keys between those of the pieces around them that no piece has had; None without room.

    Parameters
    ----------
    serial : how many times pieces have changed.
    """
    n_steps = [len(chart(piece.statements)) for piece in new]
    low = next((piece.keys[-1] for piece in reversed(before) if piece.keys), 0) // _SERIALS
    high = next((piece.keys[0] // _SERIALS for piece in after if piece.keys), low + GAP)
    step = min((high - low) // (sum(n_steps) + 1), _STEP)
    if step == 0 or serial >= _SERIALS:
        return None
    firsts = accumulate(n_steps, initial=1)
    numbered = (
        range((low + step * at) * _SERIALS + serial, (low + step * (at + n)) * _SERIALS + serial, step * _SERIALS)
        for at, n in zip(firsts, n_steps, strict=False)
    )
    return [replace(piece, keys=keys) for piece, keys in zip(new, numbered, strict=True)]


def resolve_again(
    change: Change, known: Sequence[Played], library: tuple[Names, Catalog], source: Source, start: str
) -> Replay:
    """Return what a script plays after a change.

    Parameters
    ----------
    known : what the pieces before the change have played.
    start : the motion that the script starts in, then and now.
    """
    low, width = _sound_before(change.first, known), 4
    while True:
        high = min(change.end + width, len(change.pieces))
        try:
            resolution, high = _resolved(change, (low, high), known, library, source, start)
        except ReachesBack as back:
            low = _sound_before(_holder(back.key, change.pieces, low), known)
            continue
        if resolution.joins is not None or high == len(change.pieces):
            return _replay(change, (low, high), known, resolution, source, start)
        width *= 4


def _sound_before(at: int, known: Sequence[Played]) -> int:
    """Return the last piece up to one from which one can begin again."""
    return next((n for n in range(min(at, len(known) - 1), 0, -1) if known[n].sound), 0)


def _holder(key: int, pieces: Sequence[Piece], before: int) -> int:
    """Return the piece that has a step."""
    return next(at for at in range(before - 1, -1, -1) if key in pieces[at].keys)


def _resolved(
    change: Change,
    part: tuple[int, int],
    known: Sequence[Played],
    library: tuple[Names, Catalog],
    source: Source,
    start: str,
) -> tuple[Resolution, int]:
    """Return what some pieces play, and at which piece all from there is known."""
    low, high = part
    pieces = change.pieces[low:high]
    statements = [one for piece, at in zip(pieces, change.starts[low:], strict=False) for one in _typed(piece, at)]
    keys = [key for piece in pieces for key in piece.keys]
    first_steps = list(accumulate((len(piece.keys) for piece in pieces), initial=0))
    states: dict[int, flow.State] = {}
    joined_at: dict[int, int] = {}
    for at in range(change.end, high):
        once, number = known[at - change.further], first_steps[at - low]
        if once.sound and once.before is not None:
            states[number] = once.before
            joined_at.setdefault(number, at)
    before = known[low].before if low else None
    state = flow.begin(library[0], start) if before is None else before
    resolution = resolve_part(statements, library, source, (start, state), keys, states)
    return resolution, high if resolution.joins is None else joined_at[resolution.joins]


def _typed(piece: Piece, start: int) -> tuple[typed.Statement, ...]:
    return moved(piece.statements, by(start - piece.origin))


def _replay(
    change: Change, part: tuple[int, int], known: Sequence[Played], resolution: Resolution, source: Source, start: str
) -> Replay:
    low, high = part
    fresh = played_of(change.pieces[low:high], change.starts[low : high + 1], resolution, source)
    played = [*known[:low], *fresh, *known[high - change.further :]]
    around = [one for piece in fresh for one in piece.statements]
    states, since = dict(resolution.states), change.starts[low]
    before = next((at for at in reversed(range(low)) if played[at].statements), None)
    if before is not None and isinstance(written := played[before].statements[-1], resolved.Command):
        statement = _now(written, before, change, played)
        states[statement.span] = played[before].states[written.span]
        around.insert(0, statement)
        since = statement.span.start
    within = tuple(around)
    behind = next((at for at in range(high, len(played)) if played[at].statements), None)
    if behind is not None and isinstance(following := played[behind].statements[0], resolved.Command):
        around.append(_now(following, behind, change, played))
    whole = replace(resolution, plan=replace(resolution.plan, statements=within), states=states)
    beside = replace(whole, plan=replace(whole.plan, statements=tuple(around)))
    return Replay(played, low, high, resolution.diagnostics, whole, beside, since)


def _now(command: resolved.Command, at: int, change: Change, played: Sequence[Played]) -> resolved.Command:
    """Return a command of a piece with its places in the text as it is now."""
    return moved(command, by(change.starts[at] - played[at].origin))
