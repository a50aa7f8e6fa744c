"""An analysis -> what can be done with a script and with each of its commands, to be offered above them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import Statement, WholeBlock
from mlmg_lang.diagnostics import has_errors
from mlmg_lang.parsing import syntax
from mlmg_lang.planning import resolved
from mlmg_lang.source import Span


class Deed(StrEnum):
    """What can be done."""

    PLAY = "play"
    EXPLAIN = "explain"
    CANDIDATES = "candidates"


@dataclass(frozen=True, slots=True)
class Lens:
    """Something that can be done.

    Attributes
    ----------
    span : what it is shown above.
    title : what it does, in a few words.
    about : the command that it is about; None if it is about the script.
    """

    span: Span
    title: str
    deed: Deed
    about: Span | None = None


def lenses(analysis: Analysis) -> tuple[Lens, ...]:
    """Return what can be done, in the order of the text: play and explain the script, see the candidates of commands.

    Without a library there is nothing that could be played. In a script with mistakes, what is sound has lenses too, so
    that lines do not jump about while one is written: its candidates go with whatever broken lines may come to.
    """
    made = analysis.ready
    parts = zip(made.pieces, made.played, made.places.starts, strict=False)
    found = [_moved(lens, start) for piece, played, start in parts for lens in piece_lenses(piece, played.statements)]
    return (*of_script(), *found) if found else ()


def of_script() -> tuple[Lens, Lens]:
    """Return what can be done with a script that has any command."""
    top = Span(0, 0)
    return Lens(top, "play to BVH", Deed.PLAY), Lens(top, "explain", Deed.EXPLAIN)


def piece_lenses(piece: Statement, played: Iterable[resolved.Statement]) -> tuple[Lens, ...]:
    """Return what can be done with the commands of a piece, with places counted from its beginning.

    Parameters
    ----------
    played : what is played by it, at its addresses.
    """
    titles = {command.span: _title(command) for command in resolved.commands(played)}
    return tuple(_candidates(piece, titles)) if titles else ()


def _candidates(piece: Statement, titles: Mapping[Span, str]) -> Iterator[Lens]:
    start = 0
    for line in piece.lines if isinstance(piece, WholeBlock) else (piece,):
        further = start - line.address
        for command in () if has_errors(line.told) else syntax.commands(line.items):
            if command.span in titles:
                span = command.span.shifted(further)
                yield Lens(span, titles[command.span], Deed.CANDIDATES, span)
        start += line.size


def _moved(lens: Lens, further: int) -> Lens:
    span = lens.span.shifted(further)
    return replace(lens, span=span, about=span)


def _title(command: resolved.Command) -> str:
    """Return how many candidates a command has on each graph; a single one by its name."""
    return ", ".join(f"{_said(layer.candidates)} on {layer.graph}" for layer in command.layers)


def _said(candidates: Sequence[str]) -> str:
    return candidates[0] if len(candidates) == 1 else f"{len(candidates)} candidates"
