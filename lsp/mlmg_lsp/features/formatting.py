"""textDocument/formatting, textDocument/rangeFormatting and textDocument/onTypeFormatting."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator

from lsprotocol import types

from mlmg_lang.common_ends import common_ends
from mlmg_lang.formatting.by_pieces import forms_of
from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.formatting.line_changes import (
    changes_within_lines,
    line_changes,
    line_end_of,
    with_line_ends,
)
from mlmg_lang.source import Edit, Source, Span
from mlmg_lsp.convert import range_of
from mlmg_lsp.open_text import Snapshot


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    for _ in _changes(snapshot, _all(snapshot)):
        pass


def formatting(snapshot: Snapshot, _params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return what brings a script into canonical form."""
    return _edits(snapshot, _all(snapshot))


def range_formatting(snapshot: Snapshot, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
    """Return what of that changes the lines of a selection, and no others."""
    begin, end = params.range.start.line, params.range.end.line
    if params.range.end.character == 0 and end > begin:
        end -= 1
    return _edits(snapshot, _lines(snapshot, begin, end))


def on_type_formatting(snapshot: Snapshot, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
    """Return what of that changes the line that has just been finished, and no other.

    Empty lines stay, and none is put behind the last line: something is about to be written there.
    """
    line = params.position.line - (params.ch == "\n")
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    least = (_least(source, one) for one in _made_in(snapshot, _lines(snapshot, line, line)) if one.replacement)
    return [types.TextEdit(range_of(source, one.span, encoding), one.replacement) for one in least if one is not None]


def _all(snapshot: Snapshot) -> Span:
    return Span(0, len(snapshot.analysis.source.text))


def _lines(snapshot: Snapshot, first: int, last: int) -> Span:
    """Return where lines are, as far as there are such."""
    source = snapshot.analysis.source
    starts = (*source.line_starts, len(source.text))
    begin, end = (min(max(at, 0), len(starts) - 1) for at in (first, last + 1))
    return Span(starts[begin], starts[end])


def _edits(snapshot: Snapshot, place: Span) -> list[types.TextEdit]:
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    return [types.TextEdit(range_of(source, one.span, encoding), one.replacement) for one in _made_in(snapshot, place)]


def _made_in(snapshot: Snapshot, place: Span) -> Iterator[Edit]:
    """Yield what changes in some lines; of what would change others too, only what can be made in these alone."""
    for change in _changes(snapshot, place):
        if _is_in(change, place):
            yield change
        elif change.span.start < place.end and change.span.end > place.start:
            parts = changes_within_lines(snapshot.analysis.source, change)
            yield from (one for one in parts if _is_in(one, place))


def _is_in(change: Edit, place: Span) -> bool:
    return place.start <= change.span.start and change.span.end <= place.end


def _least(source: Source, change: Edit) -> Edit | None:
    """Return a change without what stays as it is at its ends, so that cursors stay; None if nothing is left."""
    before, after = source.slice(change.span), change.replacement
    if change.span.end == len(source.text) and before[-1:] not in ("\r", "\n"):
        after = after.rstrip("\r\n")
    head, tail = common_ends(before, after)
    if before[len(before) - tail - 1 :].startswith("\r\n"):
        tail -= 1  # no cursor stands there
    if head == len(before) == len(after):
        return None
    return Edit(Span(change.span.start + head, change.span.end - tail), after[head : len(after) - tail])


def _changes(snapshot: Snapshot, place: Span) -> Iterator[Edit]:
    """Yield what changes in some lines, piece by piece where each can be written by itself; there may be more."""
    forms = forms_of(snapshot.analysis, snapshot.kept.get("forms"))
    snapshot.kept["forms"] = forms
    if not forms.alone:
        whole = Source(snapshot.analysis.source.text)
        yield from line_changes(whole, with_line_ends(format_source(whole), line_end_of(whole)))
        return
    starts = snapshot.analysis.made.places.starts
    for number in _pieces_at(snapshot, place):
        start = starts[number]
        for change in forms.changes(number):
            yield Edit(change.span.shifted(start), change.replacement)


def _pieces_at(snapshot: Snapshot, place: Span) -> range:
    """Return the pieces that some lines touch."""
    made = snapshot.analysis.made
    begin = made.places.piece_at(place.start)
    return range(begin, max(bisect_left(made.places.starts, place.end), begin + 1))
