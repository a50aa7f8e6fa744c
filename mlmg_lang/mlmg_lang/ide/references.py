"""A name in a script -> all places where the same is named."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.definition import declaration
from mlmg_lang.ide.occurrences import RENAMED, Occurrence, Place, Sort, Symbol, occurrence_at, occurrences_of, place_of
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Highlight:
    """A name that is the one at a cursor; `declares`: whether it gets its meaning here."""

    span: Span
    declares: bool


def references(
    analysis: Analysis, offset: int, others: Iterable[Analysis] = (), declarations: bool = True
) -> tuple[Place, ...]:
    """Return where the name at an offset is used, in the script and in the files that it uses; none if there is none.

    Parameters
    ----------
    others : scripts that may use the same files, or this one.
    declarations : whether the places are among them where it gets its meaning.
    """
    found = occurrence_at(analysis, offset)
    if found is None or found.symbol.sort is Sort.UNKNOWN:
        return ()
    places = (
        place_of(script.source, one.span)
        for script, one in everywhere(analysis, found.symbol, others)
        if declarations or not one.declares
    )
    return tuple(dict.fromkeys(places))


def home_at(analysis: Analysis, offset: int) -> str | None:
    """Return the name of the file that defines the name at an offset; None if no script does."""
    found = occurrence_at(analysis, offset)
    return None if found is None else _home(analysis, found.symbol) or None


def everywhere(
    analysis: Analysis, symbol: Symbol, others: Iterable[Analysis] = ()
) -> Iterator[tuple[Analysis, Occurrence]]:
    """Yield where something is named, in a script and in others in which the name means the same."""
    home = _home(analysis, symbol)
    for script in (analysis, *(other for other in others if home != "" and _home(other, symbol) == home)):
        for one in occurrences_of(script, symbol):
            yield script, one


def _home(analysis: Analysis, symbol: Symbol) -> str | None:
    """Return the name of the file that defines something, empty if none does; None of what no script can define."""
    if symbol.sort not in RENAMED:
        return None
    span = declaration(analysis, symbol)
    return "" if span is None else place_of(analysis.source, span).file


def highlights(analysis: Analysis, offset: int) -> tuple[Highlight, ...]:
    """Return where the name at an offset stands in the same file, in the order of the text."""
    found = occurrence_at(analysis, offset)
    if found is None:
        return ()
    _, base = analysis.source.file(offset)
    return tuple(
        Highlight(one.span, one.declares)
        for one in occurrences_of(analysis, found.symbol)
        if analysis.source.file(one.span.start)[1] == base
    )
