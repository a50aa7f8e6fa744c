"""What is wrong with the meaning of a piece of a script -> that without what only follows from mistakes in its text.

A statement that had to be mended to be read may not be what was meant. What is said of its meaning then is most often
said of the mending. Only slips of names, those that are much like known ones, are there whatever was meant; and where
the mending is sure to be right, so is the meaning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span

INSTEAD: Final = "MS057"
"""What is said in place of what is wrong with a text at the same place: `GREET 3 sec`, where `for` is not meant."""
_SLIPS: Final = frozenset({"MS021", "MS022", "MS026"})


def without_following(
    said: Iterable[Diagnostic], misread: Sequence[Diagnostic], items: Iterable[syntax.Item]
) -> Iterator[Diagnostic]:
    """Yield what is wrong with what statements mean, but not what may follow from what is wrong with their text.

    Parameters
    ----------
    said : of their meaning. misread : of their text.
    """
    wrong = [(one, one.span) for one in misread if one.severity is Severity.ERROR and one.span is not None]
    places = [span for _, span in wrong]
    unsure = [span for one, span in wrong if not any(fix.safe for fix in one.fixes)]
    mended = [line for line in _lines(items) if any(line.start <= place.start <= line.end for place in unsure)]
    for one in said:
        if (
            one.severity is not Severity.ERROR
            or one.span is None
            or (one.code == INSTEAD and one.span in places)
            or (
                not any(_touch(one.span, place, 0 if one.fixes else 2) for place in places)
                and (not any(_is_about(one, line) for line in mended) or _is_slip(one, one.span, unsure))
            )
        ):
            yield one


def _lines(items: Iterable[syntax.Item]) -> Iterator[Span]:
    """Yield the places of statements, and of what stands before braces."""
    for item in items:
        match item:
            case syntax.Repeat(head, body):
                yield head.span
                yield from _lines(body)
            case syntax.Choose(head, branches):
                yield head.span
                yield from (span for branch in branches for span in _lines(branch.body))
            case _:
                yield item.span


def _is_about(one: Diagnostic, line: Span) -> bool:
    """Return whether something stands in a line, or in a definition that this uses."""
    places = (one.span, *(note.span for note in one.notes))
    return any(span is not None and _is_within(span, line) for span in places)


def _is_within(span: Span, line: Span) -> bool:
    return line.start <= span.start and span.end <= line.end


def _touch(one: Span, other: Span, distance: int) -> bool:
    """Return whether two places have something in common, or are no farther apart than a distance."""
    return other.start - distance < one.end and one.start < other.end + distance


def _is_slip(one: Diagnostic, span: Span, unsure: Iterable[Span]) -> bool:
    """Return whether a name is much like a known one, and does not stand right beside a mistake."""
    return one.code in _SLIPS and bool(one.fixes) and not any(_touch(span, place, 2) for place in unsure)
