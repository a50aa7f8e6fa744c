from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.parsing.layout import MAX_DEPTH, Block, Line, lay_out
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


def shape(pieces: tuple[Line | Block, ...]) -> list[object]:
    """Return lines as text, blocks as (head, branches)."""
    found: list[object] = []
    for piece in pieces:
        if isinstance(piece, Line):
            found.append(" ".join(token.text for token in piece.tokens))
        else:
            head = " ".join(token.text for token in piece.head)
            found.append((head, *(shape(branch) for branch in piece.branches)))
    return found


def laid_out(text: str) -> list[object]:
    return shape(lay_out(tokenize(Source(text))).items)


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("A\nB", ["A", "B"]),
        ("A\r\nB\rC", ["A", "B", "C"]),
        ("A; B;; C;", ["A", "B", "C"]),
        ("\n\n # nothing\n", []),
        ("A\nwith B\n and C", ["A with B and C"]),
        ("A\n\n# still going on\n for 3 sec", ["A for 3 sec"]),
        ("A with\nB", ["A with", "B"]),
        ("A;\nwith B", ["A", "with B"]),
        ("with A", ["with A"]),
        ("G (A\nand\nB)\nC", ["G ( A and B )", "C"]),
        ("G (A\nB", ["G ( A", "B"]),
        ("(A; B)", ["( A", "B )"]),
        ("(A\nlet B = C)", ["( A", "let B = C )"]),
        ("A) \n B", ["A )", "B"]),
        ("repeat 3 { A\nB; C }", [("repeat 3", ["A", "B", "C"])]),
        ("repeat 3 {\n\nA }\nB", [("repeat 3", ["A"]), "B"]),
        ("repeat 2 { A } B", [("repeat 2", ["A"]), "B"]),
        ("repeat 2 { A }\nfor 3 sec", [("repeat 2", ["A"]), "for 3 sec"]),
        ("choose { 2: A | B\n| }", [("choose", ["2 :", "A"], ["B"], [])]),
        ("choose { repeat 2 { A } | B }", [("choose", [("repeat 2", ["A"])], ["B"])]),
        ("A | B", ["A | B"]),
        ("repeat 3\n{ A }", [("repeat 3", ["A"])]),
        ("A\n{ B }", ["A", ("", ["B"])]),
        ("A { B }", [("A", ["B"])]),
        ("A }", ["A"]),
        ("repeat 2 { A", [("repeat 2", ["A"])]),
    ],
)
def test_a_script_falls_into_the_lines_that_a_reader_sees(text: str, lines: list[object]) -> None:
    assert laid_out(text) == lines


@pytest.mark.parametrize("text", ["A }", "repeat 2 { A", "repeat 2\n{ A }", "{" * (MAX_DEPTH + 5)])
def test_a_brace_without_its_place_is_reported(text: str) -> None:
    assert lay_out(tokenize(Source(text))).diagnostics


def test_braces_that_are_too_deep_hide_what_is_in_them_alone() -> None:
    deep = "repeat 1 { " * (MAX_DEPTH + 1) + "A" + " }" * (MAX_DEPTH + 1)
    layout = lay_out(tokenize(Source(f"{deep}\nB")))
    assert [one.code for one in layout.diagnostics] == ["MS005"]
    assert shape(layout.items)[-1] == "B"


@given(st.text(alphabet="A(){}|;:\n #2", max_size=40))
def test_no_token_is_lost_or_made_up(text: str) -> None:
    tokens = tokenize(Source(text))
    kept = {"NAME", "LEFT", "RIGHT", "COLON", "INTEGER"}
    flat: list[str] = []

    def collect(pieces: tuple[Line | Block, ...]) -> None:
        for piece in pieces:
            if isinstance(piece, Line):
                flat.extend(token.text for token in piece.tokens)
            else:
                flat.extend(token.text for token in piece.head)
                for branch in piece.branches:
                    collect(branch)

    collect(lay_out(tokens).items)
    assert [word for word in flat if word != "|"] == [token.text for token in tokens if token.type in kept]


def test_a_block_that_is_not_closed_reaches_to_the_end() -> None:
    (block,) = lay_out(tokenize(Source("repeat 2 { A\n B # c"))).items
    assert isinstance(block, Block)
    assert (block.span.start, block.span.end) == (0, 15)
