"""What brings a text into canonical form, piece by piece."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from lsprotocol import types

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source
from mlmg_lsp.convert import offset_of
from mlmg_lsp.features.formatting import formatting, on_type_formatting, range_formatting
from mlmg_lsp.positions import Encoding

TEXT = types.TextDocumentIdentifier("untitled:x")
OPTIONS = types.FormattingOptions(4, True)
ALL = types.DocumentFormattingParams(TEXT, OPTIONS)


def applied(text: str, edits: Iterable[types.TextEdit], encoding: Encoding) -> str:
    source, end = Source(text), len(text)
    for edit in sorted(edits, key=lambda edit: (edit.range.start.line, edit.range.start.character), reverse=True):
        start, stop = (offset_of(source, one, encoding) for one in (edit.range.start, edit.range.end))
        assert stop <= end, "edits overlap"
        text, end = text[:start] + edit.new_text + text[stop:], start
    return text


def canonical(text: str) -> str:
    """Return a text as the formatter writes it, with its own line ends."""
    first = Source(text).line_starts[1:2]
    whole = format_source(Source(text))
    if not first or text[max(first[0] - 2, 0) : first[0]] != "\r\n":
        return whole
    return whole.replace("\r\n", "\n").replace("\n", "\r\n")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_after_any_edits_it_is_that_of_the_whole(snapshots, encoding):
    ways = set()
    for snapshot in snapshots(encoding, 60):
        text = snapshot.analysis.source.text
        assert applied(text, formatting(snapshot, ALL), encoding) == canonical(text), text
        ways.add(snapshot.kept["forms"].alone)
    assert ways == {True, False}


def test_of_some_lines_it_is_what_of_all_of_it_lies_there(snapshots):
    for snapshot in snapshots("utf-16", 25):
        all_edits = formatting(snapshot, ALL)
        n_lines = len(snapshot.analysis.source.line_starts)
        for line in range(n_lines):
            place = types.Range(types.Position(line, 0), types.Position(line, 1))
            found = range_formatting(snapshot, types.DocumentRangeFormattingParams(TEXT, place, OPTIONS))
            assert found == [one for one in all_edits if touches(one, line)]
            typed = types.DocumentOnTypeFormattingParams(TEXT, types.Position(line, 0), "}", OPTIONS)
            assert [one for one in found if is_within(one, line)] == on_type_formatting(snapshot, typed)


def last_of(edit: types.TextEdit) -> int:
    start, end = edit.range.start, edit.range.end
    return end.line - 1 if end.character == 0 and end.line > start.line else end.line


def touches(edit: types.TextEdit, line: int) -> bool:
    return edit.range.start.line <= line <= last_of(edit)


def is_within(edit: types.TextEdit, line: int) -> bool:
    return edit.range.start.line == line == last_of(edit)
