"""textDocument/formatting, textDocument/rangeFormatting and textDocument/onTypeFormatting."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator

from lsprotocol import types

from mlmg_lang.formatting.by_pieces import forms_of
from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.formatting.line_changes import Change, line_changes, line_end_of, with_line_ends
from mlmg_lang.source import Source, Span
from mlmg_lsp.convert import range_of
from mlmg_lsp.open_text import Snapshot


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    for _ in _changes(snapshot, _all_lines(snapshot)):
        pass


def formatting(snapshot: Snapshot, _params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return what brings a script into canonical form."""
    return _edits(snapshot, _all_lines(snapshot))


def range_formatting(snapshot: Snapshot, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
    """Return what of that changes the lines of a selection, and no others."""
    begin, end = params.range.start.line, params.range.end.line
    if params.range.end.character == 0 and end > begin:
        end -= 1
    return _edits(snapshot, range(begin, end + 1))


def on_type_formatting(snapshot: Snapshot, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
    """Return what of that changes the line that has just been finished, and no other."""
    line = params.position.line - (params.ch == "\n")
    return _edits(snapshot, range(line, line + 1))


def _all_lines(snapshot: Snapshot) -> range:
    return range(len(snapshot.analysis.source.line_starts))


def _edits(snapshot: Snapshot, lines: range) -> list[types.TextEdit]:
    """Return what changes in some lines; what would change others too is left out."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    changes = ((range_of(source, one.span, encoding), one.text) for one in _changes(snapshot, lines))
    return [
        types.TextEdit(place, text) for place, text in changes if place.start.line in lines and _last(place) in lines
    ]


def _last(place: types.Range) -> int:
    """Return the last line of which there is something in a place."""
    return place.end.line - (place.end.character == 0 and place.end.line > place.start.line)


def _changes(snapshot: Snapshot, lines: range) -> Iterator[Change]:
    """Yield what changes in some lines, piece by piece where each can be written by itself; there may be more."""
    forms = forms_of(snapshot.analysis, snapshot.kept.get("forms"))
    snapshot.kept["forms"] = forms
    if not forms.alone:
        whole = Source(snapshot.analysis.source.text)
        yield from line_changes(whole, with_line_ends(format_source(whole), line_end_of(whole)))
        return
    starts = snapshot.analysis.made.places.starts
    for number in _pieces_at(snapshot, lines):
        start = starts[number]
        for change in forms.changes(number):
            yield Change(Span(change.span.start + start, change.span.end + start), change.text)


def _pieces_at(snapshot: Snapshot, lines: range) -> range:
    """Return the pieces that some lines touch."""
    made = snapshot.analysis.made
    line_starts, starts = made.source.line_starts, made.places.starts
    first, last = (min(line, len(line_starts) - 1) for line in (lines.start, lines.stop - 1))
    end = len(made.source.text) if last + 1 == len(line_starts) else line_starts[last + 1]
    begin = min(starts.last_to(line_starts[first]), len(made.pieces) - 1)
    return range(begin, max(bisect_left(starts, end), begin + 1))
