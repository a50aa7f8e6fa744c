from __future__ import annotations

import itertools
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.parsing.cutting import Balance, balance, cut
from mlmg_lang.parsing.lookalikes import narrowed
from mlmg_lang.parsing.nesting import Around, Mark, after
from mlmg_lang.parsing.parse import read_marks
from mlmg_lang.parsing.quotes import requoted
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source

BITS = (
    "A",
    "(",
    ")",
    "\n",
    "\n",
    "# c",
    "with B",
    "for 1 sec",
    ";",
    "{",
    "}",
    "|",
    "repeat 2",
    "let x =",
    "wait 1 sec",
    " ",
)


def pieces(text: str) -> list[str]:
    bounds = [0, *cut(narrowed(requoted(tokenize(Source(text))))).starts, len(text)]
    return [text[first:last] for first, last in itertools.pairwise(bounds)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A\nB\n", ["A\n", "B\n"]),
        ("# c\nA\n\n# d\nB", ["# c\nA\n", "\n# d\nB"]),
        ("A\n with B\nC", ["A\n with B\n", "C"]),
        ("repeat 2 {\nA\n}\nB", ["repeat 2 {\n", "A\n", "}\n", "B"]),
        ("repeat 2 { A; B }\nC", ["repeat 2 { A; B }\n", "C"]),
        ("(A\nand B)\nC", ["(A\nand B)\n", "C"]),
        ("(A\nB\nC", ["(A\n", "B\n", "C"]),
        ("(A\nwait 1 sec\nB)", ["(A\n", "wait 1 sec\n", "B)"]),
        ("repeat 2\n{ A }\nB", ["repeat 2\n{ A }\n", "B"]),
    ],
)
def test_a_piece_is_a_statement_with_the_lines_before_it(text: str, expected: list[str]) -> None:
    assert pieces(text) == expected


@given(st.lists(st.sampled_from(BITS), max_size=30).map(" ".join))
def test_pieces_say_alone_in_the_braces_around_them_what_they_say_together(text: str) -> None:
    def read(part: str, around: Around) -> Sequence[Mark]:
        return read_marks(Source(part), tokenize(Source(part)), around).marks

    def shown(marks: Sequence[Mark], part: str) -> list[tuple[type, str]]:
        return [(type(mark), part[mark.span.start : mark.span.end]) for mark in marks]

    around: Around = ()
    alone = []
    for part in pieces(text):
        marks = read(part, around)
        alone += shown(marks, part)
        around = after(around, marks)
    assert alone == shown(read(text, ()), text)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A (B)\n", Balance(0, 0, False)),
        ("A) (B\n", Balance(1, 1, False)),
        ("A (\n;\n", Balance(0, 0, True)),
        ("A)\nwait 1 sec)\n((\n", Balance(1, 2, True)),
    ],
)
def test_parentheses_without_a_partner_are_counted(text: str, expected: Balance) -> None:
    assert balance(tokenize(Source(text))) == expected
