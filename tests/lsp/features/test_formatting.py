"""What brings a text into canonical form, piece by piece."""

from __future__ import annotations

import random
from collections.abc import Iterable

import pytest
from lsprotocol import types

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source
from mlmg_lsp.convert import offset_of
from mlmg_lsp.features.formatting import formatting, on_type_formatting, range_formatting
from mlmg_lsp.open_text import Snapshot
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
    draw = random.Random(1)
    for snapshot in snapshots("utf-16", 8):
        text, all_edits = snapshot.analysis.source.text, formatting(snapshot, ALL)
        n_lines = len(snapshot.analysis.source.line_starts)
        for begin in range(n_lines):
            end = min(begin + draw.choice((0, 0, 1, 3, 8)), n_lines - 1)
            found = of_lines(snapshot, begin, end)
            whole = [one for one in all_edits if begin <= one.range.start.line and last_of(one) <= end]
            others = [one for one in found if one not in whole]  # of what would change other lines too
            assert [one for one in found if one in whole] == whole
            assert all(one.range.start.line == one.range.end.line for one in others)
            assert canonical(applied(text, found, "utf-16")) == canonical(text)
            typed = types.DocumentOnTypeFormattingParams(TEXT, types.Position(begin, 0), "}", OPTIONS)
            after = applied(text, on_type_formatting(snapshot, typed), "utf-16")
            assert canonical(after) == canonical(text)
            assert len(Source(after).line_starts) >= n_lines


def test_of_some_lines_no_others_change(snapshots):
    draw = random.Random(2)
    for snapshot in snapshots("utf-16", 60):
        text = snapshot.analysis.source.text
        starts = (*snapshot.analysis.source.line_starts, len(text))
        begin, end = sorted(draw.choices(range(len(starts) - 1), k=2))
        after = applied(text, of_lines(snapshot, begin, end), "utf-16")
        assert after.startswith(text[: starts[begin]])
        assert after.endswith(text[starts[end + 1] :])


def test_one_selection_after_the_other_comes_to_the_whole_where_no_change_lies_in_both(snapshots, known):
    for snapshot in snapshots("utf-16", 8):
        text = snapshot.analysis.source.text
        ends = sorted({last_of(edit) for edit in formatting(snapshot, ALL)}, reverse=True)
        wanted = canonical(text)
        for end, before in zip(ends, (*ends[1:], -1), strict=True):
            text = applied(text, of_lines(known(text), before + 1, end), "utf-16")
        assert text == wanted


def of_lines(snapshot: Snapshot, begin: int, end: int) -> list[types.TextEdit]:
    place = types.Range(types.Position(begin, 1), types.Position(end, 1))
    return range_formatting(snapshot, types.DocumentRangeFormattingParams(TEXT, place, OPTIONS))


def last_of(edit: types.TextEdit) -> int:
    start, end = edit.range.start, edit.range.end
    return end.line - 1 if end.character == 0 and end.line > start.line else end.line


@pytest.mark.parametrize(
    ("text", "ch", "expected"),
    [
        ("repeat 2 {\n    WALK for 3s\n    }¦", "}", "repeat 2 {\n    WALK for 3s\n}"),
        ("IDLE\nWALK  \r\n¦", "\n", "IDLE\nWALK\n"),
        ("WALK\n\n\n¦", "\n", "WALK\n\n\n"),
        ("WALK\n\n\n¦\nIDLE", "\n", "WALK\n\n\n\nIDLE"),
        ("repeat 2 {\n    \n    ¦\n}\n", "\n", "repeat 2 {\n    \n    \n}\n"),
        ("repeat 2 {\n    WALK for 3s\n    }¦\n", "}", "repeat 2 {\n    WALK for 3s\n}\n"),
        ("  repeat 2 {\n  WALK\n      IDLE\n    }¦\n", "}", "  repeat 2 {\n  WALK\n      IDLE\n}\n"),
        ("repeat 2 {\nrepeat 3 {\nWALK\n}¦\n}\n", "}", "repeat 2 {\nrepeat 3 {\nWALK\n    }\n}\n"),
        ("repeat 2 {\n WALK }¦\nIDLE  once\n", "}", "repeat 2 {\n    WALK\n}\nIDLE  once\n"),
        ("choose {\n WALK | repeat 2 {\nIDLE\n}\n  }¦\n", "}", "choose {\n WALK | repeat 2 {\nIDLE\n}\n}\n"),
        ("repeat 2 {\r\n\tWALK for 3s\r\n\t}¦\r\n", "}", "repeat 2 {\r\n\tWALK for 3s\r\n}\r\n"),
        ("repeat 2 {\n WALK  FOR 3s\n WLAK  once\n  }¦\n", "}", "repeat 2 {\n WALK  FOR 3s\n WLAK  once\n}\n"),
        ("repeat 2{\n¦\nWALK  once\n}\n", "\n", "repeat 2 {\n\nWALK  once\n}\n"),
        ("repeat 2 {\nWALK   for 3s\n¦\nIDLE  once\n}\n", "\n", "repeat 2 {\n    WALK for 3 sec\n\nIDLE  once\n}\n"),
        ("repeat 2 {\r\n\tWALK   for 3s\r\n\t¦\r\n\t}", "\n", "repeat 2 {\r\n    WALK for 3 sec\r\n\t\r\n\t}"),
        ("repeat 2 {\nWALK  FOR 3s\n¦\nIDLE  once\n}\n", "\n", "repeat 2 {\n    WALK  FOR 3s\n\nIDLE  once\n}\n"),
        ("repeat 2{\n    ¦\n}\n", "\n", "repeat 2 {\n    \n}\n"),
        ("choose{\n  WALK  for 05 s # so\n¦|IDLE\n}\n", "\n", "choose{\n    WALK for 5 sec  # so\n|IDLE\n}\n"),
        ("choose{\n  WALK  for 05 s\n¦|IDLE\n}\n", "\n", "choose{\n  WALK for 5 sec\n|IDLE\n}\n"),
        ("choose{\n  WALK  for 05 s;TALK\n¦|IDLE\n}\n", "\n", "choose{\n    WALK for 5 sec\n    TALK\n|IDLE\n}\n"),
        ("WALK   with  Sub TALK\n¦ for 3s\n", "\n", "WALK with Sub TALK\n for 3s\n"),
        ("WALK; IDLE  once # so\n¦TALK  once\n", "\n", "WALK\nIDLE once  # so\nTALK  once\n"),
    ],
)
def test_what_is_typed_has_its_line_formatted_and_no_other(known, text, ch, expected):
    before, after = text.split("¦")
    line = len(Source(before).line_starts) - 1
    at = types.Position(line, len(before) - Source(before).line_starts[-1])
    typed = types.DocumentOnTypeFormattingParams(TEXT, at, ch, OPTIONS)
    assert applied(before + after, on_type_formatting(known(before + after), typed), "utf-16") == expected


def test_what_is_typed_has_no_more_changed_than_has_to_be(known):
    text = "repeat 2 {\r\n    WALK  \r\n    }\r\n"
    for line, start, end in ((1, 8, 10), (2, 0, 4)):
        typed = types.DocumentOnTypeFormattingParams(TEXT, types.Position(line, end), "}", OPTIONS)
        place = types.Range(types.Position(line, start), types.Position(line, end))
        assert on_type_formatting(known(text), typed) == [types.TextEdit(place, "")]


def test_of_a_selection_its_lines_are_formatted_and_no_others(known):
    text = "repeat 2 {\nTALK   for 3 s\n IDLE  \n}\n"
    found = of_lines(known(text), 1, 1)
    assert applied(text, found, "utf-16") == "repeat 2 {\n    TALK for 3 sec\n IDLE  \n}\n"
