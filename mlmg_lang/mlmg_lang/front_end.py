"""A script's text -> everything that is known of it. This module alone knows the order of the stages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from mlmg_lang.analysis import Analysis, Found, InPieces, Question, Whole
from mlmg_lang.catalog import Catalog
from mlmg_lang.definitions.expand import expand
from mlmg_lang.definitions.gather import Definitions, Files, NoFiles, gather
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.case import guess_case
from mlmg_lang.parsing.lookalikes import opens_or_closes
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.structure import check_definition, check_structure, misplaced
from mlmg_lang.parsing.syntax import Choose, Let, Repeat, Script, Use, walk
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source
from mlmg_lang.suppression import suppress

if TYPE_CHECKING:
    from mlmg_lang.editing import Edit
    from mlmg_lang.planning.names import Names
    from mlmg_lang.planning.resolve import Resolution
    from mlmg_lang.planning.resolve_again import Change
    from mlmg_lang.planning.typed import Statement

_MAX_FOUND = 200
"""With so many diagnostics of texts and names, stages may have given up, which depends on the whole script."""

__all__ = ["Analysis", "analyse", "analyse_again"]


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
    return _analysed(source, Question(catalog, None if catalog is None else _names(catalog), start, files or NoFiles()))


def analyse_again(previous: Analysis, source: Source) -> Analysis:
    """Return what `analyse` does for another text against the same library, sooner if it is much the same text.

    What lines say that have not changed is kept. All is analysed afresh where a script defines something or uses
    files, or there is very much to say of it.
    """
    again = None
    if _stands_alone(previous) and not source.used:
        again = _edited(previous, source)
    return _analysed(source, previous.question) if again is None else again


# --- all afresh ---


def _analysed(source: Source, question: Question) -> Analysis:
    tokens = tokenize(source)
    parsed = parse(source, tokens)
    gathered = gather(source, parsed.script, question.files)
    definitions = gathered.definitions
    expanded = expand(parsed.script, definitions)
    structural = _structure(parsed.script, expanded.script, definitions, question.catalog)
    read = (*parsed.diagnostics, *gathered.diagnostics, *expanded.diagnostics, *structural)
    whole = Whole(gathered.source, tokens, parsed.script, expanded.script)
    if question.catalog is None or question.names is None:
        return _told(definitions, question, Found((*read, *guess_case(parsed.script))), whole)
    return _against(question.names, question.catalog, question, definitions, whole, read)


def _against(
    names: Names,
    catalog: Catalog,
    question: Question,
    definitions: Definitions,
    whole: Whole,
    read: tuple[Diagnostic, ...],
) -> Analysis:
    """Return an analysis that goes on with what a library says."""
    # A fifth of what checking a small script without a library takes would be spent on importing these.
    from mlmg_lang.planning.plan import plan
    from mlmg_lang.planning.resolve import resolve

    planned = plan(whole.expanded, definitions, names, catalog.frame_rate, whole.source)
    resolution = resolve(planned.plan, names, catalog, whole.source, question.start)
    hints = _hints(resolution, resolution, names, catalog)
    found = Found((*read, *planned.diagnostics), resolution.diagnostics, hints)
    return _told(definitions, question, found, replace(whole, plan=planned.plan, resolution=resolution))


def _names(catalog: Catalog) -> Names:
    from mlmg_lang.planning.names import Names

    return Names(catalog)


def _structure(
    script: Script, expanded: Script, definitions: Definitions, catalog: Catalog | None
) -> Iterator[Diagnostic]:
    frame_rate = None if catalog is None else catalog.frame_rate
    yield from misplaced(script)
    for let in definitions.lets.values():
        yield from check_definition(let, frame_rate)
    own = tuple(let.name.text for let in definitions.lets.values())
    yield from check_structure(expanded, frame_rate, definitions.complete, own)


def _hints(resolution: Resolution, around: Resolution, names: Names, catalog: Catalog) -> tuple[Diagnostic, ...]:
    """Return what could be better in what is played.

    Parameters
    ----------
    around : the same with the statements beside it.
    """
    from mlmg_lang.planning.passing import left_at_once
    from mlmg_lang.planning.unusual import unusual

    return (*left_at_once(around, names), *unusual(resolution, names, catalog))


def _told(definitions: Definitions, question: Question, found: Found, made: Whole | InPieces) -> Analysis:
    """Return the analysis, with what is told of what has been found."""
    source, complete = made.source, question.catalog is not None and not found.wrong
    tokens = made.tokens if "mlmg" in source.text else ()
    told = _sorted(suppress(found.told, tokens, source, complete))
    return Analysis(source, definitions, told, question, found, made)


def _sorted(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return diagnostics in the order of the text, each once; those without a place come first."""
    once = {(one.code, one.span, one.message): one for one in reversed(diagnostics)}
    return tuple(sorted(once.values(), key=lambda one: (one.span is not None, one.span, one.code)))


# --- what has changed ---


def _stands_alone(analysis: Analysis) -> bool:
    """Return whether what a line says has nothing to do with any definition, and nothing is left out."""
    if analysis.definitions.lets or analysis.source.used or len(analysis.found.read) >= _MAX_FOUND:
        return False
    return isinstance(analysis.made, InPieces) or not _defines(analysis.made.script)


def _defines(script: Script) -> bool:
    """Return whether there is a definition or the use of a file somewhere."""
    for item in script.items:
        for node in walk(item) if isinstance(item, Repeat | Choose) else (item,):
            if isinstance(node, Let | Use):
                return True
    return False


def _edited(previous: Analysis, source: Source) -> Analysis | None:
    """Return the analysis after an edit; None if all has to be analysed afresh."""
    from mlmg_lang.editing import change_of, edit_between, reread, spliced
    from mlmg_lang.moving import by, moved
    from mlmg_lang.planning.plan import plan

    before, question = previous.pieces, previous.question
    edit = edit_between(previous.source.text, source.text)
    spot = reread(before, source, edit)
    if opens_or_closes(spot.tokens):
        return None
    parsed = parse(spot.source, spot.tokens)
    if _defines(parsed.script):
        return None
    new = [*parsed.diagnostics, *_structure(parsed.script, parsed.script, previous.definitions, question.catalog)]
    statements: tuple[Statement, ...] = ()
    if question.catalog is None or question.names is None:
        new += guess_case(parsed.script)
    else:
        rate = question.catalog.frame_rate
        planned = plan(parsed.script, previous.definitions, question.names, rate, spot.source)
        new += planned.diagnostics
        statements = planned.plan.statements
    end = before.starts[spot.end] if spot.end < len(before.pieces) else None
    read = spliced(previous.found.read, moved(tuple(new), by(spot.start)), spot.start, end, edit)
    change = None if len(read) >= _MAX_FOUND else change_of(before, spot, parsed.script.items, statements)
    if change is None:
        return None
    if question.catalog is not None and question.names is not None:
        return _replayed(previous, source, change, read, edit)
    made = InPieces(source, change.pieces, change.starts, None, "", before.serial + 1)
    return _told(previous.definitions, question, Found(read), made)


def _replayed(
    previous: Analysis, source: Source, change: Change, read: tuple[Diagnostic, ...], edit: Edit
) -> Analysis | None:
    """Return the analysis after an edit against a library; None if the script starts in another motion."""
    from mlmg_lang.editing import spliced
    from mlmg_lang.planning.resolve import start_of
    from mlmg_lang.planning.resolve_again import resolve_again

    before, question = previous.pieces, previous.question
    assert question.catalog is not None
    assert question.names is not None
    assert before.played is not None
    names, catalog = question.names, question.catalog
    start, wrong = start_of(
        (one for piece in change.pieces for one in piece.statements), names, catalog, question.start
    )
    if start != before.start:
        return None
    replay = resolve_again(change, before.played, (names, catalog), source, start)
    high = replay.high - change.further
    end = before.starts[high] if high < len(before.pieces) else None
    found = previous.found
    played = spliced(found.played, replay.diagnostics, before.starts[replay.low], end, edit)
    hints = _hints(replay.resolution, replay.around, names, catalog)
    found = Found(read, (*wrong, *played), spliced(found.hints, hints, replay.since, end, edit))
    made = InPieces(source, change.pieces, change.starts, replay.played, start, before.serial + 1)
    return _told(previous.definitions, question, found, made)
