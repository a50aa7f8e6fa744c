"""textDocument/formatting, textDocument/rangeFormatting and textDocument/onTypeFormatting."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from lsprotocol import types

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source
from mlmg_lsp.convert import edits_between
from mlmg_lsp.documents import Snapshot


def formatting(snapshot: Snapshot, _params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return what brings a script into canonical form."""
    return _edits(snapshot, lambda _first, _last: True)


def range_formatting(snapshot: Snapshot, params: types.DocumentRangeFormattingParams) -> list[types.TextEdit]:
    """Return what of that has to do with some lines."""
    begin, end = params.range.start.line, params.range.end.line
    if params.range.end.character == 0 and end > begin:
        end -= 1
    return _edits(snapshot, lambda first, last: first <= end and last >= begin)


def on_type_formatting(snapshot: Snapshot, params: types.DocumentOnTypeFormattingParams) -> list[types.TextEdit]:
    """Return what of that has to do with the line that has just been finished, and with no other."""
    line = params.position.line - (params.ch == "\n")
    return _edits(snapshot, lambda first, last: first == last == line)


def _edits(snapshot: Snapshot, wanted: Callable[[int, int], bool]) -> list[types.TextEdit]:
    """Return the edits of which the first and the last line that they change are wanted."""
    source = Source(snapshot.analysis.source.text)
    after = _with_line_ends_of(source, format_source(source))
    return list(_wanted(edits_between(source, after, snapshot.client.encoding), wanted))


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
