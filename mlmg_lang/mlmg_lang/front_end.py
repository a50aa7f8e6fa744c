"""A script's text -> everything that is known of it. This module alone knows the order of the stages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from mlmg_lang.analysis import Analysis, Found, InPieces, Question
from mlmg_lang.blocks import Statement, grouped
from mlmg_lang.catalog import Catalog
from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.definitions.expand import MAX_ALL_NODES, unused
from mlmg_lang.definitions.gather import Files, NoFiles, gather, gather_with
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.lookalikes import opens_or_closes
from mlmg_lang.parsing.parse import read_marks
from mlmg_lang.parsing.syntax import Script, Use
from mlmg_lang.parsing.tokenize import MAX_TOKENS, tokenize
from mlmg_lang.pieces import Piece, lines_of
from mlmg_lang.places import Places
from mlmg_lang.reporting import reported, wrong_as_played, wrong_as_read
from mlmg_lang.source import Source, Span
from mlmg_lang.understanding import Reader

if TYPE_CHECKING:
    from mlmg_lang.editing import Change
    from mlmg_lang.planning.names import Names

__all__ = ["Analysis", "Question", "analyse", "analyse_again", "analyse_for"]


def analyse(
    source: Source, catalog: Catalog | None = None, start: str | None = None, files: Files | None = None
) -> Analysis:
    """Return what a script says and what is wrong with it. Whatever the text, this does not fail.

    Parameters
    ----------
    catalog : the library that the script is read against; without one, only syntax and structure are checked.
    start : the motion of the root graph to start in; without it, the script or the library says which.
    files : where the files are found that the script uses; without it, none is.
    """
    names = None if catalog is None else _names(catalog)
    return analyse_for(source, Question(catalog, names, start, files or NoFiles()))


def analyse_again(previous: Analysis, source: Source) -> Analysis:
    """Return what `analyse` does for another text against the same library and files, sooner if it is much the same.

    What lines say that have not changed is kept, and so are the files that are used; those are read again where the
    edit is in what uses them.
    """
    return _edited(previous, source) or analyse_for(source, previous.question)


# --- all afresh ---


def analyse_for(source: Source, question: Question) -> Analysis:
    """Return what `analyse` does, where a text may also go on with what is playing.

    Parameters
    ----------
    source : with the files, if there are any, whose definitions the text can use without saying so.
    """
    tokens = tokenize(source)
    read = Chunks(lines_of(len(source.text), tokens, read_marks(source, tokens)))
    gathered = gather(source, _defining(read, grouped(read)), question.files)
    reader = Reader(question, gathered, gathered.source)
    lines = read.replaced(reader.all_understood(read, range(len(read))))
    room = gathered.source.end + 1
    places = Places(grouped(lines), lines, range(len(source.text) + 1, room))
    made = InPieces(
        source=gathered.source,
        places=places,
        gathered=gathered,
        defined=reader.defined(),
        untold=_untold(lines),
        room=room,
    )
    made = replace(made, unused=tuple(_unused(made)))
    found = Found(wrong_as_read(made))
    if question.names is None or question.catalog is None:
        return reported(question, found, made)
    return _resolved(question.names, question.catalog, question, found, made)


def _resolved(names: Names, catalog: Catalog, question: Question, found: Found, made: InPieces) -> Analysis:
    """Return an analysis that goes on with what a library says."""
    # A fifth of what checking a small script without a library takes would be spent on importing these.
    from mlmg_lang.planning.passing import left_at_once
    from mlmg_lang.planning.resolve import resolve
    from mlmg_lang.planning.unusual import unusual

    resolution = resolve(made.plan, names, catalog, made.source, question.start, question.state)
    hints = (*left_at_once(resolution, names), *unusual(resolution, names, catalog))
    made = replace(made, resolution=resolution, start=resolution.plan.start)
    return reported(question, replace(found, played=wrong_as_played(resolution.diagnostics, made), hints=hints), made)


def _names(catalog: Catalog) -> Names:
    from mlmg_lang.planning.names import Names

    return Names(catalog)


def _defining(lines: Chunks[Piece], pieces: Chunks[Statement]) -> Script:
    """Return the definitions of a script: those in blocks too, as they have been reported, but not the files there."""
    lets = (item for item in lines.all("defining") if not isinstance(item, Use))
    used = (item for item in pieces.all("defining") if isinstance(item, Use))
    return Script((*lets, *used), Span(0, 0))


def _unused(made: InPieces) -> Iterator[Diagnostic]:
    """Yield the definitions that nothing uses; what could not be read may use all."""
    definitions, lines = made.gathered.definitions, made.lines
    if definitions.lets and not lines.has("broken"):
        yield from unused(made.pieces.all("defining"), lines.words("used"), definitions)


def _untold(lines: Chunks[Piece]) -> tuple[Diagnostic, ...]:
    """Return what says from where on mistakes in names are not told, if there are too many."""
    named = (lines[at] for at in lines.where("n_named"))
    first = next((line for line in named if line.n_named < 0), None)
    if first is None:
        return ()
    from mlmg_lang.planning.plan import too_many

    return (too_many(first.items[0].span),)


# --- what has changed ---


def _edited(previous: Analysis, source: Source) -> Analysis | None:
    """Return the analysis after an edit; None if all has to be analysed afresh."""
    question, before = previous.question, previous.ready
    if source.used or len(source.text) >= MAX_TOKENS:
        return None
    change = _read_again(before, source)
    if change is None:
        return None
    change = _understood_again(before, _defined_again(before, change, question.files), question)
    found = Found(wrong_as_read(change.made))
    if _is_too_large(change.made):
        return None
    if question.names is None or question.catalog is None:
        return reported(question, found, change.made)
    return _replayed((question.names, question.catalog), question, found, before, change)


def _is_too_large(made: InPieces) -> bool:
    """Return whether what is defined is not put in everywhere."""
    return bool(made.gathered.definitions.lets) and made.lines.sums("n_nodes")[-1] > MAX_ALL_NODES


def _read_again(before: InPieces, source: Source) -> Change | None:
    """Return what an edit has changed, read but not understood.

    None where signs make comments of whatever stands between them, or braces stand in too many others.
    """
    from mlmg_lang.editing import Change
    from mlmg_lang.rereading import edit_between, reread, without_same

    spot = reread(before, source, edit_between(before.source.text, source.text))
    around, size = spot.around, len(spot.source.text)
    read = read_marks(spot.source, spot.tokens, around, spot.n_before)
    if opens_or_closes(read.narrow) or read.deep:
        return None
    again = lines_of(size, spot.tokens, read, around, spot.n_before, before.room)
    first, new, end = without_same(before, spot, again)
    made = before.edited(source, before.lines.spliced(first, end, new), size)
    return _read_behind(before, Change(made, first, len(new), end))


def _read_behind(before: InPieces, change: Change) -> Change | None:
    """Return a change with what it makes of the lines behind it; None where these are cut elsewhere."""
    from mlmg_lang.rereading import CutElsewhere, behind, read_behind

    made, end = change.made, change.first + change.n_new
    was, now = behind(before.lines, change.end), behind(made.lines, end)
    if now == was:
        return change
    starts, lines, text = made.places.starts, made.lines, made.source.text
    try:
        found = dict(read_behind(lines, end, was, now, lambda at: text[starts[at] : starts[at + 1]]))
    except CutElsewhere:
        return None
    return replace(change, made=made.with_lines(lines.replaced(found)), again=tuple(found))


def _defined_again(before: InPieces, change: Change, files: Files) -> Change:
    """Return a change with the definitions of the script."""
    from mlmg_lang.editing import changed_names

    made, lines = change.made, change.made.lines
    defining = [item for line in change.touching(before) for item in line.defining]
    moved = lines.all("defining") if change.moves_braces(before) else ()
    if any(isinstance(item, Use) for item in (*defining, *moved)):
        alone = replace(made.source, used=())
        made = made.using(gather(alone, _defining(lines, grouped(lines)), files, made.room))
    elif defining:
        made = replace(made, gathered=gather_with(_defining(lines, lines), before.gathered.used))
    else:
        return change
    names = changed_names(before.gathered.definitions, made.gathered.definitions)
    return replace(change, made=made, names=names)


def _understood_again(before: InPieces, change: Change, question: Question) -> Change:
    """Return what an edit has changed, with what it means."""
    from mlmg_lang.editing import regrouped, touched

    made = change.made
    reader = Reader(question, made.gathered, made.addressed)
    understood = reader.all_understood(made.lines, frozenset(touched(before, change)))
    lines = made.lines.replaced(understood)
    made = replace(made.with_lines(lines), untold=_untold(lines))
    change = regrouped(before, replace(change, made=made, numbers=tuple(understood)))
    made = change.made
    if made.gathered is not before.gathered:
        made = replace(made, defined=reader.defined())
    changed = made.gathered is not before.gathered or change.moves_braces(before) or change.again
    if changed or not change.uses_the_same(before):
        made = replace(made, unused=tuple(_unused(made)))
    return replace(change, made=made)


def _replayed(
    library: tuple[Names, Catalog], question: Question, found: Found, before: InPieces, change: Change
) -> Analysis | None:
    """Return the analysis after an edit against a library; None where there is no more room for keys."""
    from mlmg_lang.editing import runs
    from mlmg_lang.planning.resolve import start_of
    from mlmg_lang.planning.resolve_again import Player, keyed_between, with_unknown

    made, pieces = change.made, change.regrouping
    unknown = before.keys.spliced(change.first, change.end, [range(0)] * change.n_new)
    keys = keyed_between(made.lines, unknown, runs(change.numbers), made.serial)
    if keys is None:
        return None
    start, wrong = start_of(all_of(made.pieces, "statements"), *library, question.start)
    known, moves = with_unknown(before.played, pieces.first, pieces.n_new, pieces.end)
    player = Player(made.places, keys, library, made.addressed, start, moves)
    played = player.replay(known, runs(pieces.numbers if start == before.start else (0, *pieces.numbers)))
    told, hints = (tuple(played.all(name)) for name in ("told", "hints"))
    found = replace(found, played=wrong_as_played((*wrong, *told), made), hints=hints)
    return reported(question, found, replace(made, start=start, played=played, keys=keys))
