from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.formatting.words import words_of
from mlmg_lang.formatting.wrapping import WIDTH, Row, columns, wrap
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


def wrapped(text: str, indent: int = 0, lead: int = 0) -> list[Row]:
    tokens = tokenize(Source(text))
    said = [token for token in tokens if token.type not in ("NEWLINE", "COMMENT")]
    return wrap(tokens, words_of([]).written(said), indent, lead)


@pytest.mark.parametrize(("text", "width"), [("WALK", 4), ("走路", 4), ("e\u0301", 1), ("é", 1), ("👩‍👧", 2), ("", 0)])
def test_columns_are_those_of_a_terminal(text: str, width: int) -> None:
    assert columns(text) == width


def test_what_fits_stays_in_one_line() -> None:
    name = "N" * (WIDTH - len(" with B"))
    assert wrapped(f"{name} with B") == [Row(0, f"{name} with B")]
    assert wrapped(f"{name}N with B") == [Row(0, f"{name}N"), Row(4, "with B")]


def test_indentation_and_what_leads_a_line_take_their_room() -> None:
    name = "N" * (WIDTH - len(" with B") - 7)
    assert len(wrapped(f"{name} with B", indent=4, lead=3)) == 1
    assert len(wrapped(f"{name}N with B", indent=4, lead=3)) == 2
    assert len(wrapped(f"{name}N with B", indent=5, lead=3)) == 2


def test_a_group_is_kept_in_one_line_where_that_can_be() -> None:
    rows = wrapped(f"{'A' * 60} or G ({'B' * 20} and {'C' * 20} or D)")
    assert [(row.indent, row.code[:4]) for row in rows] == [(0, "AAAA"), (4, "or G")]


def test_a_group_that_is_too_long_is_broken_where_it_binds_loosest() -> None:
    rows = wrapped(f"G ({'B' * 30} and {'C' * 30} or {'D' * 30} and {'E' * 30})")
    assert [(row.indent, row.code[:4]) for row in rows] == [(0, "G (B"), (4, "or D")]


def test_a_comment_breaks_the_line_that_it_stands_in() -> None:
    rows = wrapped("A # a\n # b\n with G (B # c\n and C) with D")
    assert rows == [
        Row(0, "A", "# a"),
        Row(4, "", "# b"),
        Row(4, "with G (B", "# c"),
        Row(8, "and C)"),
        Row(4, "with D"),
    ]


@given(st.lists(st.tuples(st.sampled_from(["with", "or", "and"]), st.integers(1, 45)), max_size=12), st.integers(0, 40))
def test_no_line_is_too_long_where_names_are_short_and_no_word_is_lost(
    operands: list[tuple[str, int]], indent: int
) -> None:
    text = " ".join(["A", *(f"{joiner} {'N' * length}" for joiner, length in operands)])
    rows = wrapped(text, indent)
    assert " ".join(row.code for row in rows) == text
    assert all(row.indent + columns(row.code) <= WIDTH for row in rows)
    assert all(row.code == row.code.strip() for row in rows)
