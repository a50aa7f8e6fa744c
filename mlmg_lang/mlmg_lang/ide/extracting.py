"""A part of a command -> a definition of its own, and its name where the part was."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.rewriting import Edit, commands, lasting
from mlmg_lang.ide.touching import pieces_touching
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import is_sub
from mlmg_lang.source import Span
from mlmg_lang.spelling import folded

_NAME = "PART"


@dataclass(frozen=True, slots=True)
class Extraction:
    """The edits that define a part of a command as a name."""

    name: str
    edits: tuple[Edit, ...]


def extraction(analysis: Analysis, within: Span) -> Extraction | None:
    """Return what defines the part of a command that is selected; None if nothing is, or it cannot be defined.

    The definition stands before the statement that the part is in, with its comments, at the top level.
    """
    selected = _without_spaces(analysis, within)
    if selected.start == selected.end:
        return None
    for piece, further in pieces_touching(analysis, Span(selected.start, selected.start)):  # a part is in one
        for command in commands(piece.items):
            for part in _parts(command.motion):
                at = Span(part.span.start + further, part.span.end + further)
                if at == selected:
                    return _extraction(analysis, part, at, piece.address + further)
    return None


def _without_spaces(analysis: Analysis, within: Span) -> Span:
    text = analysis.source.text[within.start : within.end]
    start = within.start + len(text) - len(text.lstrip())
    return Span(start, start + len(text.strip()))


def _extraction(analysis: Analysis, part: syntax.Motion, at: Span, before: int) -> Extraction | None:
    if any(isinstance(node, syntax.Name) and is_sub(node) for node in syntax.walk(part)) or lasting(part, analysis):
        return None  # `Sub` depends on what stands before it, and what lasts is a whole statement.
    text = analysis.source.text
    name = _fresh(analysis)
    before += text.startswith("\ufeff", before)
    ending = "\r\n" if "\r\n" in text else "\n"
    definition = Edit(Span(before, before), f"let {name} = {text[at.start : at.end]}{ending}")
    return Extraction(name, (definition, Edit(at, name)))


def _parts(motion: syntax.Motion) -> Iterator[syntax.Motion]:
    """Yield the parts of an expression that can be defined, outermost first: all but names, and what has a graph."""
    if not isinstance(motion, syntax.Reference):
        yield motion
    match motion:
        case syntax.Group(inner) | syntax.Not(inner):
            yield from _parts(inner)
        case syntax.And(operands) | syntax.Or(operands) | syntax.With(operands):
            for operand in operands:
                yield from _parts(operand)


def _fresh(analysis: Analysis) -> str:
    """Return a name that means nothing yet, however it is spelt, in the script or in the library."""
    tokens = (token for line in analysis.made.lines for token in line.tokens)
    taken = {folded(token.text.strip('"')) for token in tokens if token.type in ("NAME", "STRING", "UNIT")}
    taken |= {folded(name) for name in analysis.made.gathered.definitions.lets}
    names = analysis.question.names
    for name in (_NAME if n == 1 else f"{_NAME}_{n}" for n in count(1)):
        known = names is not None and (names.graph(name) is not None or bool(names.places(name)))
        if folded(name) not in taken and not known:
            return name
    raise AssertionError("there is no end of names")
