"""Where blocks that have no end were probably meant to end: what is indented tells, as it does to those who read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.parsing.layout import Close
from mlmg_lang.parsing.nesting import Mark, Opened
from mlmg_lang.source import Source, Span


@dataclass(frozen=True, slots=True)
class End:
    """Where a block was probably meant to end.

    Attributes
    ----------
    at : where the brace is missing. text : what is to be written there.
    behind : the place of what stands behind the block; None where the file ends.
    """

    at: int
    text: str
    behind: Span | None


def never_closed(marks: Iterable[Mark], source: Source) -> list[Span]:
    """Return the braces to which there is no end, the likeliest first.

    A `}` ends the innermost block; where it is indented as the head of one further out, that was probably meant, and
    the inner one has no end.
    """
    opened: list[Opened] = []
    passed_over: list[Span] = []
    for mark in marks:
        if isinstance(mark, Opened):
            opened.append(mark)
        elif isinstance(mark, Close) and opened:
            inner, indent = opened.pop(), _indent(source, mark.span.start)
            others = (_indent(source, other.span.start) for other in opened)
            if inner.head is not None and len(indent) < len(_indent(source, inner.span.start)) and indent in others:
                passed_over.append(inner.brace)
    return [*passed_over, *(one.brace for one in opened if not one.is_told)]


def too_many(marks: Iterable[Mark], source: Source) -> Iterator[Span]:
    """Yield the braces that are indented further than the block that they end: those that may be too much."""
    opened: list[Opened] = []
    for mark in marks:
        if isinstance(mark, Opened):
            opened.append(mark)
        elif isinstance(mark, Close) and opened:
            indent, own = (_indent(source, at) for at in (opened.pop().span.start, mark.span.start))
            is_first = source.position(mark.span.start)[1] == len(own) + 1
            if is_first and len(own) > len(indent):
                yield mark.span


def end_by_indentation(source: Source, brace: int) -> End | None:
    """Return where a block that has no end was probably meant to end; None if its lines are not indented."""
    number = source.position(brace)[0]
    indent = _indent(source, brace)
    found = indented = False
    last = len(source.text.rstrip())
    for line in range(number, len(source.line_starts)):
        start = source.line_starts[line]
        text = _line(source, line)
        if not text.strip() or text.lstrip().startswith(("#", "|")):
            continue
        found = True
        if len(text) - len(text.lstrip()) <= len(indent):
            behind = Span(start + len(text) - len(text.lstrip()), start + len(text.rstrip()))
            if indented:
                return End(start, f"{indent}}}\n", behind)
            return _in_line(source, brace, behind)
        indented = True
    if indented:
        return End(last, f"\n{indent}}}", None)
    return None if found else _in_line(source, brace, None)


def _in_line(source: Source, brace: int, behind: Span | None) -> End | None:
    """Return the end of the line that a brace stands in, if a statement stands behind it."""
    rest = _line(source, source.position(brace)[0] - 1)[source.position(brace)[1] :].split("#")[0].rstrip()
    return End(brace + 1 + len(rest), " }", behind) if rest.strip() else None


def _indent(source: Source, offset: int) -> str:
    """Return what a line begins with before its first word or sign."""
    text = _line(source, source.position(offset)[0] - 1)
    return text[: len(text) - len(text.lstrip())]


def _line(source: Source, number: int) -> str:
    """Return a line, the first of which has the number 0."""
    starts = source.line_starts
    end = starts[number + 1] if number + 1 < len(starts) else len(source.text)
    return source.text[starts[number] : end].rstrip("\r\n")
