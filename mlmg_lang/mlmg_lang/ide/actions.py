"""An analysis and a stretch of its text -> what can be rewritten there without another meaning.

The compiler's own edits are with its diagnostics; these are the others.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from mlmg_lang.analysis import Analysis
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.ide.extracting import extraction
from mlmg_lang.ide.inlining import inlinings
from mlmg_lang.ide.touching import pieces_touching, tokens_at
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import is_sub
from mlmg_lang.planning import typed
from mlmg_lang.source import Edit, Source, Span


class Kind(StrEnum):
    """What an action is."""

    SUPPRESS = "suppress"
    QUALIFY = "qualify"
    EXTRACT = "extract"
    INLINE = "inline"


@dataclass(frozen=True, slots=True)
class Action:
    """A change that can be chosen from a menu.

    Attributes
    ----------
    edits : in the order of the text; they do not overlap, and none is outside the script itself.
    about : the diagnostic that it silences; None if it is not about one.
    """

    title: str
    kind: Kind
    edits: tuple[Edit, ...]
    about: Diagnostic | None = None


def actions(analysis: Analysis, within: Span, used: Collection[str] = ()) -> tuple[Action, ...]:
    """Return what can be rewritten in a stretch of a script; what plays stays the same.

    Parameters
    ----------
    within : what is selected, or an empty span at the cursor.
    used : the names of the files that other scripts use, as far as known.
    """
    found = [*_suppressions(analysis, within), *_qualifications(analysis, within)]
    extracted = extraction(analysis, within)
    if extracted is not None:
        found.append(Action(f"extract into `let {extracted.name}`", Kind.EXTRACT, extracted.edits))
    found += [Action(one.title, Kind.INLINE, one.edits) for one in inlinings(analysis, within, used)]
    return tuple(found)


# --- suppress -------------------------------------------------------------------------------------------

_DIRECTIVE: Final = re.compile(r"#\s*mlmg\s*:\s*ignore\s*\[([^\]]*)\]")
_OF_COMMENTS: Final = frozenset({"MS070", "MS071", "MS072"})
"""What is said of comments that ask for silence: these are mended, not silenced."""


def _suppressions(analysis: Analysis, within: Span) -> Iterator[Action]:
    """Yield what silences the diagnostics that are there, each with a comment at the end of its first line."""
    size = len(analysis.source.text)
    for one in analysis.diagnostics:
        if one.span is None or one.span.end > size or one.severity is Severity.ERROR or one.code in _OF_COMMENTS:
            continue
        if one.span.start <= within.end and within.start <= one.span.end:
            edit = _silencing(analysis, one.code, one.span.start)
            if edit is not None:
                yield Action(f"ignore `{one.code}` here", Kind.SUPPRESS, (edit,), one)


def _silencing(analysis: Analysis, code: str, offset: int) -> Edit | None:
    """Return what silences a diagnostic on the line of an offset; None where a comment would be in an open quote."""
    source = analysis.source
    end = _line_end(source, offset)
    tokens, further = tokens_at(analysis, end)
    last = next((token for token in tokens if token.span.end + further == end), None)
    if last is None or last.type not in ("COMMENT", "UNCLOSED"):
        return Edit(Span(end, end), f"  # mlmg: ignore[{code}]")
    if last.type == "UNCLOSED":
        return None
    start = last.span.start + further
    directive = _DIRECTIVE.match(last.text)
    if directive is not None:
        at = start + directive.end(1)
        return Edit(Span(at, at), f", {code}" if directive[1].strip() else code)
    return None if re.match(r"#\s*mlmg\s*:", last.text) else Edit(Span(start, start + 1), f"# mlmg: ignore[{code}]")


def _line_end(source: Source, offset: int) -> int:
    """Return where the line of an offset ends, without the spaces at its end."""
    row, _ = source.position(offset)
    start = source.line_starts[row - 1]
    end = source.line_starts[row] if row < len(source.line_starts) else len(source.text)
    return start + len(source.text[start:end].rstrip("\r\n"))


# --- qualify with graph ---------------------------------------------------------------------------------


def _qualifications(analysis: Analysis, within: Span) -> Iterator[Action]:
    """Yield what writes its graph before a name that means one graph alone, and has none."""
    if analysis.question.names is None:
        return
    for piece, further in pieces_touching(analysis, Span(within.start, within.start)):  # a name is in one
        planned = list(_planned(piece.statements))
        for command in syntax.commands(piece.items):
            typed_command = next((one for one in planned if one.span == command.span), None)
            named = {} if typed_command is None else _named(typed_command)
            for name in _unqualified(command.motion):
                at = name.span.shifted(further)
                graph = named.get(name.span)
                if graph is not None and at.start <= within.start and within.end <= at.end:
                    text = f"{script_name(graph)} "
                    yield Action(f"write `{text}` before it", Kind.QUALIFY, (Edit(Span(at.start, at.start), text),))


def _planned(statements: Sequence[typed.Statement]) -> Iterator[typed.Command]:
    for statement in statements:
        match statement:
            case typed.Command():
                yield statement
            case typed.Repeat(body=body):
                yield from _planned(body)
            case typed.Choose(branches):
                yield from (one for branch in branches for one in _planned(branch.body))


def _named(command: typed.Command) -> dict[Span, str]:
    """Return the graphs of a command's names, where only one assignment is allowed.

    The name of a motion alone may be where a script starts, which it no longer is with a graph.
    """
    if command.start is not None or len(command.ways) != 1 or command.ways[0].shared:
        return {}
    choices = [layer.choice for layer in command.ways[0].layers]
    found: dict[Span, str] = {}
    while choices:
        match choices.pop():
            case typed.Named(graph=graph, span=span):
                found[span] = graph
            case typed.AllBut(operand=operand):
                choices.append(operand)
            case typed.Both(operands=operands) | typed.Either(operands=operands):
                choices += operands
    return found


def _unqualified(motion: syntax.Motion) -> Iterator[syntax.Name]:
    """Yield the names in an expression that no graph's name is before, be it far before."""
    match motion:
        case syntax.Reference(name):
            if not is_sub(name):
                yield name
        case syntax.Group(inner) | syntax.Not(inner):
            yield from _unqualified(inner)
        case syntax.And(operands) | syntax.Or(operands) | syntax.With(operands):
            for operand in operands:
                yield from _unqualified(operand)
