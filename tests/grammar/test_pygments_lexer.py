"""The lexer for Pygments."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_grammar import load, scan
from mlmg_grammar.roles import Role

pygments = pytest.importorskip("pygments", reason="Pygments is not installed")

from pygments.formatters import HtmlFormatter  # noqa: E402
from pygments.token import Comment, Error, Keyword, Name, Number, Punctuation, String, Whitespace, _TokenType  # noqa: E402

from mlmg_grammar.pygments_lexer import TOKENS, MotionScriptLexer  # noqa: E402

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted([*ROOT.glob("examples/*.ms"), *ROOT.glob("tests/golden/scripts/*.ms")])
LANGUAGE = load()
LEXER = MotionScriptLexer()
KINDS: dict[_TokenType, str] = {
    Whitespace: "SPACE NEWLINE",
    Comment: "COMMENT",
    Number: "INTEGER DECIMAL",
    String: "STRING",
    Punctuation: "LEFT RIGHT OPEN CLOSE BAR SEMICOLON COLON COMMA EQUALS",
    Error: "UNCLOSED UNKNOWN",
    Keyword: "WITH AND OR NOT FOR ONCE WAIT LET REPEAT END CHOOSE USE KEEPING TO ALONG FACING UNIT",
    Name: "NAME UNIT STRING",
}


@given(st.text())
def test_the_lexer_gives_the_whole_text_back(text: str) -> None:
    pieces = list(LEXER.get_tokens_unprocessed(text))
    assert "".join(piece for _, _, piece in pieces) == text
    assert all(text.startswith(piece, at) for at, _, piece in pieces)


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_the_kinds_are_those_of_the_terminals(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    terminals = [token.type for token in scan(LANGUAGE, text)]
    kinds = [kind for _, kind, _ in LEXER.get_tokens_unprocessed(text)]
    for terminal, kind in zip(terminals, kinds, strict=True):
        assert any(kind in wide and terminal in names.split() for wide, names in KINDS.items()), (terminal, kind)


def test_every_role_has_a_kind() -> None:
    assert set(TOKENS) == set(Role)


def test_a_unit_is_a_word_only_after_a_number() -> None:
    kinds = {(piece, kind) for _, kind, piece in LEXER.get_tokens_unprocessed("sec for 10 sec")}
    assert {("sec", Name), ("sec", Keyword.Type)} <= kinds


def test_a_script_is_coloured_for_a_page() -> None:
    html = pygments.highlight("WALK with Upper-Body TALK\n", LEXER, HtmlFormatter(nowrap=True))
    assert '<span class="k">with</span>' in html
    assert '<span class="nc">Upper-Body</span>' in html


def test_a_script_is_told_from_the_files_of_others() -> None:
    assert MotionScriptLexer.analyse_text("Idle_01\nWALK for 10 sec\n") > 0
    assert MotionScriptLexer.analyse_text(".TL\nA title\n# for 10 sec\n") == 0
