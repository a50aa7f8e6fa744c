"""Where in a text, and in the files that it uses, things are."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.source import Source, Span

TEXTS = st.text(
    alphabet=st.sampled_from(["a", " ", "\n", "\r", "\t", "走", "😀", "\u0301", "\x85", "\u2028", "\x0b", "\x0c"])
)
SOURCES = st.builds(
    lambda text, used: Source(text, "main.ms", tuple(Source(one, f"{at}.ms") for at, one in enumerate(used))),
    TEXTS,
    st.lists(TEXTS, max_size=4),
)


def lines(text: str) -> list[str]:
    """Return the lines of a text, without what ends them."""
    return re.split(r"\r\n|\n|\r", text)


@pytest.mark.parametrize(
    ("text", "starts"),
    [
        ("", (0,)),
        ("ab", (0,)),
        ("a\nb", (0, 2)),
        ("a\r\nb", (0, 3)),
        ("a\rb", (0, 2)),
        ("a\n\rb", (0, 2, 3)),
        ("\n", (0, 1)),
        ("\r\n", (0, 2)),
        ("\r", (0, 1)),
        ("a\x85b\u2028c\x0bd\x0ce", (0,)),
    ],
)
def test_lines_end_in_lf_crlf_or_cr_and_in_nothing_else(text: str, starts: tuple[int, ...]) -> None:
    assert Source(text).line_starts == starts


@given(TEXTS)
def test_every_line_begins_where_it_is_said_to(text: str) -> None:
    source = Source(text)
    assert len(source.line_starts) == len(lines(text))
    assert all(text.startswith(line, start) for line, start in zip(lines(text), source.line_starts, strict=True))


@given(TEXTS)
def test_a_position_leads_back_to_its_offset(text: str) -> None:
    source = Source(text)
    for offset in range(len(text) + 1):
        line, column = source.position(offset)
        assert source.line_starts[line - 1] + column - 1 == offset
        assert column >= 1
    assert [source.position(start) for start in source.line_starts] == [
        (number, 1) for number in range(1, len(source.line_starts) + 1)
    ]


def test_columns_count_code_points() -> None:
    assert Source("走😀e\u0301x").location(Span(4, 5)) == (1, 5, 1, 6)


@given(SOURCES)
def test_every_offset_lies_in_one_file_and_is_told_as_in_that_file(source: Source) -> None:
    base = 0
    for file in (source, *source.used):
        alone = Source(file.text)
        for offset in range(len(file.text) + 1):
            found, begins = source.file(base + offset)
            assert (found.name, begins) == (file.name, base)
            assert source.position(base + offset) == alone.position(offset)
            assert source.slice(Span(base + offset, base + len(file.text))) == file.text[offset:]
        base += len(file.text) + 1
    assert source.end == base


@given(SOURCES)
def test_an_offset_after_all_files_lies_in_none(source: Source) -> None:
    with pytest.raises(ValueError, match=f"offset {source.end} is in none of the files"):
        source.file(source.end)


def test_where_another_file_is_added_it_begins_at_the_end() -> None:
    one = Source("ab", "main.ms", (Source("c", "c.ms"),))
    two = Source("ab", "main.ms", (*one.used, Source("d", "d.ms")))
    assert two.file(one.end) == (two.used[1], one.end)
    assert two.slice(Span(one.end, one.end + 1)) == "d"


def test_an_empty_file_has_a_place_of_its_own() -> None:
    source = Source("", "main.ms", (Source("", "a.ms"), Source("b", "b.ms")))
    assert [source.file(offset)[0].name for offset in range(source.end)] == ["main.ms", "a.ms", "b.ms", "b.ms"]
    assert source.position(1) == (1, 1)
    assert source.slice(Span(1, 1)) == ""


def test_a_source_is_the_same_as_another_with_the_same_text_and_files() -> None:
    assert Source("a", "x", (Source("b"),)) == Source("a", "x", (Source("b"),))
    assert Source("a", "x") != Source("a", "x", (Source("b"),))
