"""A name in a script -> where it gets its meaning: in a script, or in what a library was built from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.layers import graph_at
from mlmg_lang.ide.occurrences import Occurrence, Place, Sort, Symbol, occurrence_at, place_of, reader_of
from mlmg_lang.ide.statements import statements_at
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal


class Origins(Protocol):
    """Where what a library has comes from."""

    def motion(self, motion: str) -> Place | None:
        """Return the file of a motion's clip; None if it is not known."""

    def tag(self, tag: str, graph: str | None) -> tuple[Place, ...]:
        """Return where a tag is given to motions, on one of the graphs first."""

    def graph(self, graph: str) -> Place | None:
        """Return where a graph is described; None if it is not known."""


@dataclass(frozen=True, slots=True)
class Definition:
    """Where a name gets its meaning.

    Attributes
    ----------
    span : of the name that was asked about, as an offset of the script or of a file behind it.
    places : where it leads, the likeliest first; never empty.
    """

    span: Span
    places: tuple[Place, ...]


def definition(analysis: Analysis, offset: int, origins: Origins | None = None) -> Definition | None:
    """Return where the name at an offset gets its meaning; None if there is no name, or that is not known.

    Parameters
    ----------
    offset : in the script, or behind it in a file that it uses (see `Source`).
    origins : without them, the names of a library lead nowhere.
    """
    found = occurrence_at(analysis, offset)
    if found is None:
        return None
    places = _places(analysis, found, origins)
    return Definition(found.span, places) if places else None


def declaration(analysis: Analysis, symbol: Symbol) -> Span | None:
    """Return where a script's own name gets its meaning: of a definition that stands twice, the first."""
    lets = analysis.made.gathered.definitions.lets
    name = _declared(lets.get(symbol.owner or symbol.name), symbol)
    return None if name is None else analysis.made.places(name.span)


def _declared(let: syntax.Let | None, symbol: Symbol) -> syntax.Name | None:
    if let is None or symbol.sort is Sort.DEFINITION:
        return None if let is None else let.name
    own = (parameter.name for parameter in let.parameters or ())
    return next((name for name in own if normal(name.text) == symbol.name), None)


def _declared_beside(analysis: Analysis, found: Occurrence) -> Span | None:
    """Return where a parameter is declared, if that is in the very statement."""
    if found.symbol.sort is not Sort.PARAMETER:
        return None
    read, at = reader_of(analysis), found.span.start
    beside = (one for statement in statements_at(analysis.made, at) for one in read(statement))
    return next((one.span for one in beside if one.declares and one.symbol == found.symbol), None)


def _places(analysis: Analysis, found: Occurrence, origins: Origins | None) -> tuple[Place, ...]:
    symbol = found.symbol
    match symbol.sort:
        case Sort.DEFINITION | Sort.PARAMETER:
            # A definition that stands a second time has parameters of its own.
            span = _declared_beside(analysis, found) or declaration(analysis, symbol)
            return () if span is None else (place_of(analysis.source, span),)
        case Sort.FILE:
            file = used_file(analysis, found)
            return () if file is None else (Place(file, Span(0, 0)),)
    return () if origins is None else _origins(analysis, found, origins)


def used_file(analysis: Analysis, path: Occurrence) -> str | None:
    """Return the name of the file that a path in a script leads to; None if it leads to none."""
    made = analysis.made
    return next((name for span, name in made.gathered.used.named.items() if made.places(span) == path.span), None)


def _origins(analysis: Analysis, found: Occurrence, origins: Origins) -> tuple[Place, ...]:
    symbol = found.symbol
    if symbol.sort is Sort.TAG:
        return origins.tag(symbol.name, graph_at(analysis, found.span))
    of_one = {Sort.MOTION: origins.motion, Sort.GRAPH: origins.graph}.get(symbol.sort)
    place = None if of_one is None else of_one(symbol.name)
    return () if place is None else (place,)
