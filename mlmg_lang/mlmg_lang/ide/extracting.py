"""A command or a part of one -> a definition of its own, and its name where that was."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count, takewhile
from typing import Final

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.sayings import understood
from mlmg_lang.ide.substitution import substituted
from mlmg_lang.ide.touching import pieces_touching
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import group_of, is_sub
from mlmg_lang.source import Edit, Source, Span
from mlmg_lang.spelling import folded, normal

_NAME = "PART"
_INDENTATION: Final = re.compile(r"[ \t]*")
_COMMENT: Final = re.compile(r"[ \t]*#")
_OF_THE_NEXT: Final = re.compile(r"[ \t]*#\s*mlmg\s*:\s*ignore\s*\[")
"""A comment that asks for silence about the next statement."""


@dataclass(frozen=True, slots=True)
class Extraction:
    """The edits that define a command, or a part of one, as a name."""

    name: str
    edits: tuple[Edit, ...]


def extraction(analysis: Analysis, within: Span) -> Extraction | None:
    """Return what defines the command or part of one that is selected; None if nothing is, or it cannot be defined.

    The definition stands before the statement that this is in, with its comments, at the top level; but below the
    comment at the head of the script. What a definition says can be parted too, but for what has its parameters in it.
    """
    selected = _without_spaces(analysis, within)
    if selected.start == selected.end:
        return None
    for piece, further in pieces_touching(analysis, Span(selected.start, selected.start)):  # a part is in one
        for command, own in _commands(piece.items):
            for span, part in _parts(command, analysis):
                if _without_spaces(analysis, span.shifted(further)) == selected:
                    first = next(token.span.start for token in piece.tokens if token.type not in ("COMMENT", "NEWLINE"))
                    is_possible = _can_be_defined(analysis, command, part, own)
                    return _extraction(analysis, selected, first + further) if is_possible else None
    return None


def _commands(items: Sequence[syntax.Item]) -> Iterator[tuple[syntax.Command, frozenset[str] | None]]:
    """Yield the commands of some items; of a definition, with its parameters, else with None."""
    yield from ((command, None) for command in syntax.commands(items))
    for item in items:
        if isinstance(item, syntax.Let):
            yield item.command, frozenset(normal(one.name.text) for one in item.parameters or ())


def _without_spaces(analysis: Analysis, within: Span) -> Span:
    text = analysis.source.text[within.start : within.end]
    start = within.start + len(text) - len(text.lstrip())
    return Span(start, start + len(text.strip()))


def _can_be_defined(
    analysis: Analysis, command: syntax.Command, part: syntax.Command | syntax.Motion, own: frozenset[str] | None
) -> bool:
    """Return whether a part of a command can have a name; `own`: the parameters of the definition that it is in."""
    if isinstance(part, syntax.Command):
        return own is None and not _lasts(part, analysis)
    names = [node for node in syntax.walk(part) if isinstance(node, syntax.Name)]
    if _lasts(part, analysis) or (own and any(normal(name.text) in own for name in names)):
        return False
    return not any(map(is_sub, names)) or _means_the_same_apart(analysis, command, part)


def _means_the_same_apart(analysis: Analysis, command: syntax.Command, part: syntax.Motion) -> bool:
    """Return whether `Sub` in a part means the same if that is put in where it is named: in parentheses."""
    way = understood(analysis, command).way
    apart = substituted(command.motion, part, syntax.Group(part, part.span))
    return way is not None and way == understood(analysis, replace(command, motion=apart)).way


def _extraction(analysis: Analysis, at: Span, statement: int) -> Extraction:
    text = analysis.source.text
    name = _fresh(analysis)
    before = _before(analysis.source, statement)
    indentation = _INDENTATION.match(text, _line_start(analysis.source, statement))
    assert indentation is not None, "there may be none"
    ending = "\r\n" if "\r\n" in text else "\n"
    definition = f"{indentation[0]}let {name} = {text[at.start : at.end]}{ending}"
    return Extraction(name, (Edit(Span(before, before), definition), Edit(at, _apart(text, at, name))))


def _apart(text: str, at: Span, name: str) -> str:
    """Return a name that is to stand at a place, with spaces where it would grow together with what is beside that."""
    before, behind = text[at.start - 1 : at.start], text[at.end : at.end + 1]
    return f"{' ' * _is_of_word(before)}{name}{' ' * _is_of_word(behind)}"


def _is_of_word(sign: str) -> bool:
    return sign.isalnum() or (sign != "" and sign in '"_-')


def _before(source: Source, statement: int) -> int:
    """Return where a definition stands that a statement needs."""
    above = source.position(statement)[0] - 1
    n_comments = _n_lines(source, above, _COMMENT)
    if n_comments == above:  # Those at the head of a script are about all of it.
        n_comments = _n_lines(source, above, _OF_THE_NEXT)
    return _line_start(source, source.line_starts[above - n_comments])


def _n_lines(source: Source, end: int, pattern: re.Pattern[str]) -> int:
    """Return how many lines in a row, up to before a number, begin with a pattern."""
    lines = takewhile(
        lambda row: pattern.match(source.text, _line_start(source, source.line_starts[row])), reversed(range(end))
    )
    return sum(1 for _ in lines)


def _line_start(source: Source, offset: int) -> int:
    """Return where the line of an offset begins, behind the mark that a file may begin with."""
    start = source.line_starts[source.position(offset)[0] - 1]
    return start + source.text.startswith("\ufeff", start)


def _parts(command: syntax.Command, analysis: Analysis) -> Iterator[tuple[Span, syntax.Command | syntax.Motion]]:
    """Yield what can be defined of a command, each with its place, which may begin with spaces; outermost first."""
    if command.span != command.motion.span:
        yield command.span, command
    yield from _motion_parts(command.motion, analysis)


def _motion_parts(motion: syntax.Motion, analysis: Analysis) -> Iterator[tuple[Span, syntax.Motion]]:
    """Yield the parts of an expression that can be defined: all but names, and single names that have a graph."""
    if not isinstance(motion, syntax.Reference):
        yield motion.span, motion
    match motion:
        case syntax.Call(name):
            group = group_of(motion)
            if group is not None and analysis.made.gathered.definitions.find(name) is None:
                yield Span(name.span.end, motion.span.end), group
                yield from _motion_parts(group, analysis)
        case syntax.Group(inner) | syntax.Not(inner):
            yield from _motion_parts(inner, analysis)
        case syntax.And(operands) | syntax.Or(operands) | syntax.With(operands):
            for operand in operands:
                yield from _motion_parts(operand, analysis)


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


def _lasts(node: syntax.Node, analysis: Analysis) -> bool:
    """Return whether a definition is used in a node that says itself how long it lasts."""
    signatures = analysis.made.gathered.definitions.signatures
    used = (part for part in syntax.walk(node) if isinstance(part, syntax.Reference | syntax.Call))
    return any((known := signatures.get(normal(part.name.text))) is not None and known.lasts for part in used)
