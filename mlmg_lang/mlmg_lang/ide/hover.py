"""A place in a script -> what there is to say of what stands there, in parts that are ready for Markdown."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import PurePath

from mlmg_lang.analysis import Analysis
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.ide.definition import declaration
from mlmg_lang.ide.hover_name import Anatomy, told_of_name
from mlmg_lang.ide.markdown import Part, code
from mlmg_lang.ide.occurrences import Symbol, occurrence_at, place_of
from mlmg_lang.ide.sayings import understood
from mlmg_lang.ide.statements import Statement, statements_at
from mlmg_lang.ide.touching import tokens_at
from mlmg_lang.ide.words import UNIT_SAYS, WORDS
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import seconds_from_quantity, spelled, unit_of
from mlmg_lang.planning import typed
from mlmg_lang.rendering.wording import safe
from mlmg_lang.rules import read_rule
from mlmg_lang.source import Source, Span


@dataclass(frozen=True, slots=True)
class Hover:
    """What is said of a stretch of a text; `span` has offsets of the script or of a file behind it."""

    span: Span
    parts: tuple[Part, ...]


def hover(analysis: Analysis, offset: int, anatomy: Anatomy | None = None) -> Hover | None:
    """Return what there is to say of what stands at an offset; None if there is nothing.

    Parameters
    ----------
    offset : in the script, or behind it in a file that it uses (see `Source`).
    anatomy : without it, joints and transitions are left out.
    """
    found = occurrence_at(analysis, offset)
    statements = statements_at(analysis.made, offset)
    if found is not None:
        parts = tuple(told_of_name(analysis, found, statements, anatomy))
        return Hover(found.span, parts) if parts else None
    return _quantity_at(analysis, statements, offset) or _word_at(analysis, offset)


def hover_declaration(analysis: Analysis, symbol: Symbol) -> tuple[Part, ...]:
    """Return what there is to say of a script's own name where it gets its meaning, and where that is."""
    span = declaration(analysis, symbol)
    found = None if span is None else hover(analysis, span.start)
    if span is None or found is None:
        return ()
    place = place_of(analysis.source, span)
    line, _ = Source(analysis.source.file(span.start)[0].text).position(place.span.start)
    where = "" if place.file == analysis.source.name else f" of {code(PurePath(place.file).name)}"
    return (*found.parts, Part(f"defined in line {line}{where}"))


def hover_mistakes(analysis: Analysis, offset: int, *, errors: bool) -> Hover | None:
    """Return what the diagnostics at an offset say, and then what that means, each code once; None if there are none.

    Parameters
    ----------
    errors : whether errors are told; else warnings and hints are.
    """
    wrong = [
        one
        for one in analysis.diagnostics
        if one.span and one.span.start <= offset <= one.span.end and (one.severity is Severity.ERROR) == errors
    ]
    if not wrong or wrong[0].span is None:
        return None
    said = [part for one in wrong for part in _of_diagnostic(one)]
    meant = [part for code in dict.fromkeys(one.code for one in wrong) for part in _of_rule(code)]
    return Hover(wrong[0].span, (*said, *meant))


def _of_diagnostic(one: Diagnostic) -> Iterator[Part]:
    yield Part(f"**{one.severity.value}:** {safe(one.message)}")
    if one.help:
        yield Part(f"help: {safe(one.help)}")


@cache
def _of_rule(code: str) -> tuple[Part, ...]:
    """Return what a diagnostic means, and why it is one."""
    rule = read_rule(code)
    return (Part(f"**{code}** {rule.meaning}"), Part(rule.why))


# --- numbers and words -----------------------------------------------------------------------------------


def _quantity_at(analysis: Analysis, statements: Sequence[Statement], offset: int) -> Hover | None:
    for statement in statements:
        for node in syntax.walk(statement.item):
            if isinstance(node, syntax.Quantity):
                span = statement.at(node.span)
                if span.start <= offset <= span.end:
                    return Hover(span, tuple(_of_quantity(analysis, statement, node)))
    return None


def _of_quantity(analysis: Analysis, statement: Statement, quantity: syntax.Quantity) -> Iterator[Part]:
    catalog, unit = analysis.question.catalog, unit_of(quantity)
    rate = None if catalog is None else catalog.frame_rate
    seconds = seconds_from_quantity(quantity, rate)
    if unit == "cycles":
        yield Part(f"{quantity.number} {UNIT_SAYS[unit]}")
        yield from _of_cycles(analysis, statement, float(quantity.number))
    elif seconds is None:
        yield Part(f"{quantity.number} frames; how long they last depends on the library")
    else:
        yield Part(_lasting(seconds, rate))


def _lasting(seconds: float, rate: float | None) -> str:
    """Return a duration in seconds and frames."""
    said = f"{spelled(seconds)} sec"
    return said if rate is None else f"{said}, {spelled(seconds * rate)} frames at {spelled(rate)} frames a second"


def _of_cycles(analysis: Analysis, statement: Statement, number: float) -> Iterator[Part]:
    """Yield how long cycles of the motions last that a command may take."""
    catalog, command = analysis.question.catalog, statement.item
    if catalog is None or not isinstance(command, syntax.Command):
        return
    way = understood(analysis, command).way
    if way is not None:
        lengths = sorted(catalog.n_frames(motion) * number for motion in _topmost(analysis, way).motions)
        first, last = (
            _lasting(frames / catalog.frame_rate, catalog.frame_rate) for frames in (lengths[0], lengths[-1])
        )
        yield Part(f"here {first}" if first == last else f"here from {first} to {last}")


def _topmost(analysis: Analysis, way: typed.Layering) -> typed.Layer:
    names = analysis.question.names
    assert names is not None, "what is understood has been looked up"
    return min(way.layers, key=lambda layer: names.height(layer.graph))


def _word_at(analysis: Analysis, offset: int) -> Hover | None:
    """Return what a word of the language says."""
    tokens, further = tokens_at(analysis, offset)
    at = bisect_right(tokens, offset - further, key=lambda token: token.span.start)
    for token in reversed(tokens[max(at - 2, 0) : at]):
        span = token.span.shifted(further)
        if offset <= span.end and token.type in WORDS:
            return Hover(span, (of_word(token.text, WORDS[token.type]),))
    return None


def of_word(word: str, says: str) -> Part:
    """Return what is told of a word of the language that says something."""
    return Part(f"{code(word)}: {says}")
