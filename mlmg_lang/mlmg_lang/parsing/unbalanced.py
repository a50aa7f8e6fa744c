"""What is wrong with the braces of a whole script -> each mistake once, where it was probably made.

A brace that is missing, or is too much, is found out about where it stands, and again where its partner is left over.
Which of two blocks a `}` was meant for tells the indentation, as it does to those who read.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from mlmg_lang.diagnostics import Brace, Diagnostic, Fix, Label
from mlmg_lang.parsing.indentation import end_by_indentation, never_closed, too_many
from mlmg_lang.parsing.layout import unclosed
from mlmg_lang.parsing.nesting import Mark
from mlmg_lang.source import Source, Span


def balanced(told: Sequence[Diagnostic], marks: Iterable[Mark], source: Source) -> Sequence[Diagnostic]:
    """Return what is wrong with a script, of its braces each mistake once; the very same if there is nothing to change.

    Parameters
    ----------
    told : also of the files that it uses, in any order.
    marks : what stands in and around the braces of the script that have their partners in other lines, or none.
    """
    braces = sorted((one for one in told if one.brace is not None and one.span is not None), key=_start)
    if not braces:
        return told
    by_file: dict[int, list[Diagnostic]] = {}
    for one in braces:
        by_file.setdefault(source.file(_start(one))[1], []).append(one)
    known = tuple(marks)
    kept = [one for base, some in by_file.items() for one in _once(some, () if base else known, source)]
    return (*(one for one in told if one.brace is None or one.span is None), *kept)


def _start(one: Diagnostic) -> int:
    assert one.span is not None
    return one.span.start


def _once(braces: Sequence[Diagnostic], marks: Sequence[Mark], source: Source) -> list[Diagnostic]:
    """Return what is wrong with the braces of a file, in the order of the text, each mistake once."""
    kept: list[Diagnostic] = []
    for one in braces:
        if one.brace is Brace.NEEDLESS:
            kept = _with_needless(kept, one)
        elif one.brace is Brace.UNOPENED:
            kept = _with_unopened(kept, one, marks, source)
        else:
            kept.append(one)
    spans = [_span(one) for one in kept if one.brace is Brace.UNCLOSED]
    found = [one for one in kept if one.brace is not Brace.UNCLOSED]
    blamed = never_closed(marks, source) if spans else []
    for span in [*blamed, *spans[len(blamed) :]][: len(spans)]:
        found = _with_unclosed(found, span, source)
    return found


def _span(one: Diagnostic) -> Span:
    assert one.span is not None
    return one.span


# --- a `{` too much, or a `}` too few ---


def _with_needless(kept: Sequence[Diagnostic], needless: Diagnostic) -> list[Diagnostic]:
    """Return what is wrong up to a `{` that is too much: a block around it is then closed by the `}` of that."""
    at = _last(kept, Brace.UNCLOSED)
    if at is None:
        return [*kept, needless]
    fix = Fix(_span(needless), "", safe=False)
    return [*kept[:at], *kept[at + 1 :], replace(needless, help="take it out", fixes=(fix,))]


def _with_unclosed(found: Sequence[Diagnostic], brace: Span, source: Source) -> list[Diagnostic]:
    """Return what is wrong with a `{` that is never closed: a `)` that closes nothing may be meant for its `}`."""
    for at, one in enumerate(found):
        if one.brace is Brace.PARENTHESIS and _start(one) > brace.start:
            fix, label = Fix(_span(one), "}", safe=False), Label(brace, "this `{` is never closed")
            told = replace(one, help="write `}`", fixes=(fix,), labels=(label,), brace=None)
            return [*found[:at], told, *found[at + 1 :]]
    return [*found, _unclosed(brace, source)]


def _unclosed(brace: Span, source: Source) -> Diagnostic:
    """Say where a block probably ends that has no end."""
    told = unclosed(brace)
    file, base = source.file(brace.start)
    end = end_by_indentation(file, brace.start - base)
    if end is None:
        return told
    fix = Fix(Span(base + end.at, base + end.at), end.text, safe=False, name="add `}`")
    if end.behind is None:
        return replace(told, fixes=(fix,))
    behind = Span(base + end.behind.start, base + end.behind.end)
    return replace(told, fixes=(fix,), labels=(Label(behind, "its end is probably before this"),))


# --- a `{` too few, or a `}` too much ---


def _with_unopened(
    kept: Sequence[Diagnostic], closing: Diagnostic, marks: Sequence[Mark], source: Source
) -> list[Diagnostic]:
    """Return what is wrong up to a `}` that closes nothing, which most often follows from something before it."""
    at = _last(kept, Brace.MISSING)
    if at is not None:
        told = _with_brace(kept[at], source)
        return [*kept[:at], told, *(one for one in kept[at + 1 :] if one.brace is not Brace.OUTSIDE)]
    at = _last(kept, Brace.OPEN_PARENTHESIS)
    brace = None if at is None else _brace_for_parenthesis(kept[at], source)
    if at is not None and brace is not None:
        fix, label = Fix(brace, ")", safe=False), Label(_span(kept[at]), "it is opened here")
        message = "a `(` is closed by `)`, not by `}`"
        told = Diagnostic("MS012", message, brace, "write `)`", fixes=(fix,), labels=(label,))
        return [*kept[:at], told, *kept[at + 1 :]]
    at = next((at for at, one in enumerate(kept) if one.brace is Brace.OUTSIDE), None)
    left = Label(_span(closing), "this `}` closes nothing")
    if at is not None:
        advice = "a `}` before it is too much: it ends the block too early"
        told = replace(kept[at], help=advice, fixes=(), labels=(left,), brace=None)
        return [*kept[:at], told, *(one for one in kept[at + 1 :] if one.brace is not Brace.OUTSIDE)]
    brace = next((one for one in too_many(marks, source) if one.start < left.span.start), None)
    if brace is not None:
        fix = Fix(brace, "", safe=False)
        return [*kept, Diagnostic("MS013", "this `}` is one too many", brace, "take it out", (), (fix,), (left,))]
    return [*kept, closing]


def _last(kept: Sequence[Diagnostic], brace: Brace) -> int | None:
    return next((at for at in range(len(kept) - 1, -1, -1) if kept[at].brace is brace), None)


def _with_brace(missing: Diagnostic, source: Source) -> Diagnostic:
    """Return what is told of `repeat 3` or `choose` without `{`, with the edit, as there is a `}` for it."""
    span = _span(missing)
    found = source.slice(span)
    advice, place, text = "write `{` before it", Span(span.start, span.start), "{ "
    if found.startswith(("repeat", "choose")):
        advice, place, text = "write `{` behind it", Span(span.end, span.end), " {"
    elif found == "(":
        advice, place, text = "write `{` in its place", span, "{"
    return replace(missing, help=advice, fixes=(Fix(place, text, safe=False),), brace=None)


def _brace_for_parenthesis(unclosed_one: Diagnostic, source: Source) -> Span | None:
    """Return the `}` that stands where the `)` is missing, if one does."""
    place = unclosed_one.fixes[0].span.start
    file, base = source.file(place)
    rest = file.text[place - base :]
    at = place + len(rest) - len(rest.lstrip(" \t"))
    return Span(at, at + 1) if rest.lstrip(" \t").startswith("}") else None
