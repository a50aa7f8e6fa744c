"""A script's text -> everything that is known of it. This module alone knows the order of the stages."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from mlmg_lang.analysis import Analysis, Found, InPieces, Question
from mlmg_lang.blocks import Statement, grouped
from mlmg_lang.catalog import Catalog
from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.definitions.expand import MAX_ALL_NODES, Expander, unused
from mlmg_lang.definitions.gather import Files, Gathered, NoFiles, gather, gather_with
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.following import without_following
from mlmg_lang.parsing.case import guess_case
from mlmg_lang.parsing.lookalikes import opens_or_closes
from mlmg_lang.parsing.nesting import Mark
from mlmg_lang.parsing.parse import MAX_MISTAKES, read_marks
from mlmg_lang.parsing.quotes import requoted
from mlmg_lang.parsing.structure import check_definition, check_structure, misplaced
from mlmg_lang.parsing.syntax import Item, Let, Script, Use
from mlmg_lang.parsing.tokenize import MAX_TOKENS, tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece, lines_of
from mlmg_lang.places import Places
from mlmg_lang.source import Source, Span
from mlmg_lang.suppression import suppress

if TYPE_CHECKING:
    from mlmg_lang.editing import Change
    from mlmg_lang.planning import typed
    from mlmg_lang.planning.names import Names
    from mlmg_lang.planning.plan import Planner

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
    reader = _Reader(question, gathered, gathered.source)
    lines = read.replaced(reader.all_understood(read, range(len(read))))
    room = gathered.source.end + 1
    places = Places(grouped(lines), lines, range(len(source.text) + 1, room))
    none: Chunks[Any] = Chunks()
    untold = _untold(lines)
    made = InPieces(gathered.source, places, gathered, reader.defined(), (), untold, "", None, none, none, room, 0)
    made = replace(made, unused=tuple(_unused(made)))
    found = Found(_read(made))
    if question.names is None or question.catalog is None:
        return _told(question, found, made)
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
    return _told(question, replace(found, played=_soundly(resolution.diagnostics, made), hints=hints), made)


def _names(catalog: Catalog) -> Names:
    from mlmg_lang.planning.names import Names

    return Names(catalog)


class _Reader:
    """Finds out what pieces mean, one after the other."""

    def __init__(self, question: Question, gathered: Gathered, source: Source) -> None:
        self._question = question
        self._source = source
        self._gathered = gathered
        self._expander = Expander(gathered.definitions)
        self._own = tuple(let.name.text for let in gathered.definitions.lets.values())
        self._frame_rate = None if question.catalog is None else question.catalog.frame_rate
        self._planners = {explains: self._new_planner(explains) for explains in (True, False)}

    def _new_planner(self, explains: bool = True) -> Planner | None:
        if self._question.names is None or self._frame_rate is None:
            return None
        from mlmg_lang.planning.plan import Planner

        definitions, names = self._gathered.definitions, self._question.names
        return Planner(definitions, names, self._frame_rate, self._source, explains=explains)

    def defined(self) -> tuple[Diagnostic, ...]:
        """Return what is wrong with the definitions."""
        lets = self._gathered.definitions.lets.values()
        structural = (one for let in lets for one in check_definition(let, self._frame_rate))
        planner = self._new_planner()
        if planner is not None:
            planner.define(self._gathered.definitions)
        return (*self._gathered.diagnostics, *structural, *(() if planner is None else planner.diagnostics))

    def all_understood(self, lines: Chunks[Piece], numbers: Collection[int]) -> dict[int, Piece]:
        """Return what some pieces are with what they mean; and others, as they may be told of now, or no longer.

        When as many mistakes in names have been told as anybody reads, what is wrong with the next is not worked out.
        """
        done: dict[int, Piece] = {}
        n_told = 0
        for at in sorted({*lines.where("is_faulty"), *numbers}):
            line, tells = lines[at], n_told <= MAX_MISTAKES
            if at in numbers or (line.n_named >= 0) is not tells:
                line = done[at] = self._understood(line, tells)
            n_told += max(line.n_named, 0)
        return done

    def _understood(self, piece: Piece, tells: bool) -> Piece:
        """Return a piece with what it means; `tells`: and with what is wrong with its names."""
        script = Script(piece.items, Span(piece.address, piece.address + piece.size))
        expanded, n_nodes, said = self._expanded(piece)
        said += misplaced(script) if piece.defining else ()
        known = self._gathered.definitions
        said += check_structure(
            replace(script, items=expanded), self._frame_rate, known.complete, self._own, known.unread
        )
        statements: tuple[typed.Statement, ...] = ()
        planner, is_faulty, n_named = self._planners[tells], False, 0
        if planner is None:
            said += guess_case(script)
        else:
            statements = planner.body(expanded)
            is_faulty, named = planner.take()
            n_named = len(named) if tells else -is_faulty
            said += named if tells else ()
        told = without_following(said, piece.misread, piece.items) if piece.misread else said
        return replace(
            piece,
            expanded=expanded,
            n_nodes=n_nodes,
            statements=statements,
            said=tuple(told),
            is_faulty=is_faulty,
            n_named=n_named,
        )

    def _expanded(self, piece: Piece) -> tuple[tuple[Item, ...], int, list[Diagnostic]]:
        """Return what a piece says with what is defined put in, how large that has made it, and what is wrong."""
        if not self._gathered.definitions.lets:
            if not piece.defining:
                return piece.items, 0, []
            return tuple(item for item in piece.items if not isinstance(item, Let | Use)), 0, []
        before, n_nodes = len(self._expander.diagnostics), self._expander.all_nodes
        items = self._expander.body(piece.items)
        said = self._expander.diagnostics[before:]
        return items if items != piece.items else piece.items, self._expander.all_nodes - n_nodes, said


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


def _read(made: InPieces) -> tuple[Diagnostic, ...]:
    """Return all that is wrong with the text, the names and the types of a script."""
    return (*_defined(made), *made.unused, *made.untold, *made.pieces.all("told"))


def _untold(lines: Chunks[Piece]) -> tuple[Diagnostic, ...]:
    """Return what says from where on mistakes in names are not told, if there are too many."""
    named = (lines[at] for at in lines.where("n_named"))
    first = next((line for line in named if line.n_named < 0), None)
    if first is None:
        return ()
    from mlmg_lang.planning.plan import too_many

    return (too_many(first.items[0].span),)


def _defined(made: InPieces) -> Sequence[Diagnostic]:
    """Return what is wrong with the definitions, but not what may follow from what is wrong with their text."""
    defining = (made.lines[at] for at in made.lines.where("defining")) if made.defined else ()
    return _not_following(made.defined, [line for line in defining if line.misread])


def _not_following(told: tuple[Diagnostic, ...], misread: list[Piece]) -> tuple[Diagnostic, ...]:
    """Return what is told, but not what may follow from what is wrong with the text of some lines."""
    if not misread or not told:
        return told
    misread.sort(key=attrgetter("address"))
    return tuple(one for one in told if not _follows(one, misread))


def _soundly(played: tuple[Diagnostic, ...], made: InPieces) -> tuple[Diagnostic, ...]:
    """Return what is wrong with what a script plays, but not what may follow from what is wrong with its text."""
    misread = [made.lines[at] for at in made.lines.where("misread")] if played else []
    return _not_following(played, misread)


def _follows(one: Diagnostic, misread: Sequence[Piece]) -> bool:
    """Return whether it may follow from what is wrong with the text of the line it is in; these are by address."""
    if one.span is None:
        return False
    at = bisect_right(misread, one.span.start, key=attrgetter("address")) - 1
    line = misread[max(at, 0)]
    if not line.address <= one.span.start < line.address + line.size:
        return False
    return not any(without_following((one,), line.misread, line.items))


def _told(question: Question, found: Found, made: InPieces) -> Analysis:
    """Return the analysis, with what is told of what has been found."""
    complete = question.catalog is not None and not found.wrong
    told = _sorted(suppress(_each_once(found.told, made), _speaking(made), made.source, complete))
    return Analysis(told, question, found, made)


def _each_once(told: tuple[Diagnostic, ...], made: InPieces) -> tuple[Diagnostic, ...]:
    """Return what is told, where it is in the text: what several of them tell of one slip only once."""
    if not told:
        return ()
    # Imported here, as sound scripts, which are most, do not need them.
    from mlmg_lang.definitions.misnamed import Naming, told_once
    from mlmg_lang.parsing.unbalanced import balanced

    known = made.gathered.definitions
    is_used = partial(_is_used, made)
    naming = Naming(made.addressed, made.places, known.lets.values(), known.unread, is_used)
    return tuple(balanced(made.now(tuple(told_once(told, naming))), _braces(made), made.source))


def _is_used(made: InPieces, name: str) -> bool:
    return any(True for _ in made.lines.where_among("names", frozenset({name})))


def _braces(made: InPieces) -> Iterator[Mark]:
    """Yield what stands in and around braces that have their partners in other lines, where these are now."""
    for at in made.lines.where("marks"):
        yield from made.now(made.lines[at].marks)


def _speaking(made: InPieces) -> tuple[Token, ...]:
    """Return the tokens of comments that may be meant for the compiler, of the lines these are about, and of blocks."""
    lines = made.lines
    if "mlmg" not in made.source.text or not lines.has("speaks"):
        return ()
    numbers = sorted({*lines.where("speaks"), *lines.where("marks")})
    return made.now(tuple(all_of((lines[at] for at in numbers), "tokens")))


def _sorted(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return diagnostics in the order of the text, each once; those without a place come first."""
    once = {(one.code, one.span, one.message): one for one in reversed(diagnostics)}
    return tuple(sorted(once.values(), key=lambda one: (one.span is not None, one.span, one.code)))


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
    found = Found(_read(change.made))
    if _is_too_large(change.made):
        return None
    if question.names is None or question.catalog is None:
        return _told(question, found, change.made)
    return _replayed((question.names, question.catalog), question, found, before, change)


def _is_too_large(made: InPieces) -> bool:
    """Return whether what is defined is not put in everywhere."""
    return bool(made.gathered.definitions.lets) and made.lines.sums("n_nodes")[-1] > MAX_ALL_NODES


def _read_again(before: InPieces, source: Source) -> Change | None:
    """Return what an edit has changed, read but not understood.

    None where signs make comments of whatever stands between them, or braces stand in too many others.
    """
    from mlmg_lang.editing import Change, edit_between, reread, without_same

    spot = reread(before, source, edit_between(before.source.text, source.text))
    around, size = spot.around, len(spot.source.text)
    read = read_marks(spot.source, spot.tokens, around, spot.n_before)
    if opens_or_closes(requoted(spot.tokens)) or read.deep:
        return None
    again = lines_of(size, spot.tokens, read, around, spot.n_before, before.room)
    first, new, end = without_same(before, spot, again)
    made = before.edited(source, before.lines.spliced(first, end, new), size)
    return _read_behind(before, Change(made, first, len(new), end))


def _read_behind(before: InPieces, change: Change) -> Change | None:
    """Return a change with what it makes of the lines behind it; None where these are cut elsewhere."""
    from mlmg_lang.editing import CutElsewhere, behind, read_behind

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
    reader = _Reader(question, made.gathered, made.addressed)
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
    found = replace(found, played=_soundly((*wrong, *told), made), hints=hints)
    return _told(question, found, replace(made, start=start, played=played, keys=keys))
