"""The parser of the kept tables is that of the grammar."""

from __future__ import annotations

from mlmg_grammar import LINE, grammar_text, load, make
from mlmg_grammar.tables import language_from_tables, tables_text

LINES = (
    "WALK with Upper-Body (TALK or not IDLE) for 10 sec",
    "repeat 3",
    "let x(a, t = 2 sec) = a for t",
    'use "a b.ms"',
)


def test_the_kept_tables_give_the_parser_that_the_grammar_gives() -> None:
    for line in LINES:
        assert load().parse(line, start=LINE) == make().parse(line, start=LINE)


def test_the_same_grammar_gives_the_same_text() -> None:
    assert tables_text(make(), grammar_text()) == tables_text(load(), grammar_text())


def test_tables_of_another_grammar_are_not_used() -> None:
    tables = tables_text(make(), grammar_text())
    assert language_from_tables(tables, grammar_text(), None) is not None
    assert language_from_tables(tables, grammar_text() + "\n", None) is None


def test_tables_of_another_lark_are_not_used() -> None:
    tables = tables_text(make(), grammar_text()).replace('"mark":"lark ', '"mark":"lark 0.', 1)
    assert language_from_tables(tables, grammar_text(), None) is None
