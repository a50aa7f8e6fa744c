"""textDocument/formatting, textDocument/rangeFormatting and textDocument/onTypeFormatting."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator

from lsprotocol import types

from mlmg_lang.formatting.by_pieces import Forms, forms_of
from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source, Span
from mlmg_lsp.convert import changed_lines, range_of
from mlmg_lsp.open_text import Snapshot


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    for _ in _changes(snapshot, range(len(snapshot.analysis.source.line_starts))):
        pass


def formatting(snapshot: Snapshot, _params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return what brings a script into canonical form."""
    return _edits(snapshot, range(len(snapshot.analysis.source.line_starts)), lambda _first, _last: True)


def range_formatting(snapshot: Snapshot, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
    """Return what of that has to do with some lines."""
    begin, end = params.range.start.line, params.range.end.line
    if params.range.end.character == 0 and end > begin:
        end -= 1
    return _edits(snapshot, range(begin, end + 1), lambda first, last: first <= end and last >= begin)


def on_type_formatting(snapshot: Snapshot, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
    """Return what of that has to do with the line that has just been finished, and with no other."""
    line = params.position.line - (params.ch == "\n")
    return _edits(snapshot, range(line, line + 1), lambda first, last: first == last == line)


def _edits(snapshot: Snapshot, lines: range, wanted: Callable[[int, int], bool]) -> list[types.TextEdit]:
    """Return the edits of which the first and the last line that they change are wanted; `lines`: where these are."""
    source = snapshot.analysis.source
    edits = (
        types.TextEdit(range_of(source, span, snapshot.client.encoding), text)
        for span, text in _changes(snapshot, lines)
    )
    return list(_wanted(edits, wanted))


def _changes(snapshot: Snapshot, lines: range) -> Iterator[tuple[Span, str]]:
    """Yield what changes in some lines, piece by piece where each can be written by itself; there may be more."""
    forms = forms_of(snapshot.analysis, snapshot.kept.get("forms"))
    snapshot.kept["forms"] = forms
    source = snapshot.analysis.source
    if not forms.alone:
        whole = Source(source.text)
        yield from changed_lines(whole, _with_line_ends_of(source, format_source(whole)))
        return
    for number in _pieces_at(snapshot, lines):
        yield from _in_piece(snapshot, forms, number)


def _pieces_at(snapshot: Snapshot, lines: range) -> range:
    """Return the pieces that some lines touch."""
    made = snapshot.analysis.made
    line_starts, starts = made.source.line_starts, made.places.starts
    first, last = (min(line, len(line_starts) - 1) for line in (lines.start, lines.stop - 1))
    end = len(made.source.text) if last + 1 == len(line_starts) else line_starts[last + 1]
    begin = min(starts.last_to(line_starts[first]), len(made.pieces) - 1)
    return range(begin, max(bisect_left(starts, end), begin + 1))


def _in_piece(snapshot: Snapshot, forms: Forms, number: int) -> Iterator[tuple[Span, str]]:
    before, start = forms.text(number), snapshot.analysis.made.places.starts[number]
    after = _with_line_ends_of(snapshot.analysis.source, forms.written(number))
    if after != before:
        for span, text in changed_lines(Source(before), after):
            yield Span(span.start + start, span.end + start), text


def _wanted(edits: Iterable[types.TextEdit], wanted: Callable[[int, int], bool]) -> Iterable[types.TextEdit]:
    for edit in edits:
        start, end = edit.range.start, edit.range.end
        last = end.line - 1 if end.character == 0 and end.line > start.line else end.line
        if wanted(start.line, last):
            yield edit


def _with_line_ends_of(source: Source, text: str) -> str:
    """Return a text with the line ends of another: which they are is up to the editor, not to the formatter."""
    first = source.line_starts[1] if len(source.line_starts) > 1 else 0
    if source.text[max(first - 2, 0) : first] == "\r\n":
        return text.replace("\r\n", "\n").replace("\n", "\r\n")
    return text
