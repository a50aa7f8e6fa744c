"""The grammar by itself, and the front end held against it."""

from __future__ import annotations

import lark
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from lark.common import LexerConf
from lark.lexer import BasicLexer

from mlmg_grammar import LINE, SCRIPT, grammar_text, is_name, make, reserved_words, scan
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

WHOLE = make(starts=(SCRIPT, LINE, "unparsed"))
RESERVED = ["with", "and", "or", "not", "for", "once", "wait", "let", "repeat", "end", "choose", "use", "to"]
WORDS = ["WALK", "Upper-Body", "TALK", *RESERVED, "sec", "min", "3", "2.5"]
SIGNS = ["(", ")", "{", "}", "|", ";", ":", ",", "=", "\n", "\n", '"a b"', "# c\n"]
SOUP = st.lists(st.sampled_from(WORDS + SIGNS), max_size=14).map(" ".join)


def stream(pieces: tuple[Line | Block, ...]) -> list[Token]:
    """Return the tokens of laid-out lines as the rule `script` has them, line ends between statements alone."""
    nowhere = Span(0, 0)
    tokens: list[Token] = []
    for piece in pieces:
        if isinstance(piece, Line):
            tokens += piece.tokens
            if [token.type for token in piece.tokens] != ["INTEGER", "COLON"]:
                tokens.append(Token("NEWLINE", "\n", nowhere))
            continue
        tokens += [*piece.head, Token("OPEN", "{", nowhere)]
        for at, branch in enumerate(piece.branches):
            tokens += [Token("BAR", "|", nowhere)] if at else []
            tokens += stream(branch)
        tokens += [Token("CLOSE", "}", nowhere), Token("NEWLINE", "\n", nowhere)]
    return tokens


def whole_grammar_accepts(tokens: list[Token]) -> bool:
    parser = WHOLE.parse_interactive(start=SCRIPT)
    try:
        for token in tokens:
            parser.feed_token(token)  # type: ignore[arg-type]
        parser.feed_token(lark.Token("$END", ""))
    except lark.UnexpectedToken:
        return False
    return True


@given(SOUP)
def test_lines_are_accepted_one_by_one_if_the_grammar_accepts_the_whole_script(text: str) -> None:
    source = Source(text)
    tokens = tokenize(source)
    layout = lay_out(tokens)
    assume(not layout.diagnostics)
    assert (not parse(source, tokens).diagnostics) == whole_grammar_accepts(stream(layout.items))


def test_a_script_with_everything_in_it_is_accepted_whole() -> None:
    text = """
        use "more.ms"; let A(x, t = 2 sec) = x with Upper-Body (TALK or not IDLE) for t
        repeat 3 { A(WALK, t = 1 sec)
          choose { 2: IDLE once | wait 2 sec | } }
        end "Upper-Body"
    """
    layout = lay_out(tokenize(Source(text)))
    assert layout.diagnostics == ()
    assert whole_grammar_accepts(stream(layout.items))


@given(st.text())
def test_every_text_is_cut_into_tokens_that_give_it_back(text: str) -> None:
    assert "".join(scan(WHOLE, text)) == text


@pytest.mark.parametrize(
    ("text", "types"),
    [
        ("Upper-Body", ["NAME"]),
        ("10sec", ["INTEGER", "UNIT"]),
        ("2.5 min", ["DECIMAL", "UNIT"]),
        ("second_hand", ["NAME"]),
        ("with_all", ["NAME"]),
        ("withdraw", ["NAME"]),
        ("sec-ond", ["NAME"]),
        ("e\u0301te\u0301", ["NAME"]),
        ("走路 說話", ["NAME", "NAME"]),
        ("走路\u3000說話", ["NAME", "NAME"]),
        ('"a \\" b"', ["STRING"]),
        ('"a', ["UNCLOSED"]),
        ('"a\\', ["UNCLOSED"]),
        ("WALK# with", ["NAME", "COMMENT"]),
        ("a\r\nb\rc\nd", ["NAME", "NEWLINE", "NAME", "NEWLINE", "NAME", "NEWLINE", "NAME"]),
        ("a\u2028b\x0cc\x85d", ["NAME", "NAME", "NAME", "NAME"]),
        ("\ufeffWALK", ["NAME"]),
        ("-5", ["UNKNOWN", "INTEGER"]),
        (".5", ["UNKNOWN", "INTEGER"]),
        ("\0&\ud800", ["UNKNOWN", "NAME"]),
    ],
)
def test_a_text_has_the_tokens_that_a_reader_sees(text: str, types: list[str]) -> None:
    assert [token.type for token in scan(WHOLE, text) if token.type != "SPACE"] == types


@pytest.mark.parametrize("name", ["WALK", "Upper-Body", "_", "走路", "e\u0301", "Idle-2", "a-b-c", "ª"])
def test_a_name_is_an_identifier_with_single_hyphens_inside(name: str) -> None:
    assert is_name(name)


@pytest.mark.parametrize("name", ["", "3d", "-a", "a-", "a--b", "a b", "a😀", "\u0301", "a.b", "\ud800"])
def test_what_is_no_identifier_is_no_name(name: str) -> None:
    assert not is_name(name)


def test_the_reserved_words_are_those_of_the_language() -> None:
    assert set(reserved_words(WHOLE)) == {*RESERVED, "keeping", "along", "facing"}


def test_the_grammar_is_part_of_the_package() -> None:
    assert "script" in grammar_text()


def test_all_texts_are_scanned_by_one_lexer(monkeypatch: pytest.MonkeyPatch) -> None:
    """To make one takes longer than to scan a line, and texts in other scripts are scanned name by name."""
    language = make()
    made: list[object] = []

    def lexer(conf: LexerConf) -> BasicLexer:
        made.append(conf)
        return BasicLexer(conf)

    monkeypatch.setattr(lark.lexer, "BasicLexer", lexer)
    texts = [[str(token) for token in scan(language, text)] for text in ("WALK  # slowly", "走路;", "10sec")]
    assert texts == [["WALK", "  ", "# slowly"], ["走路", ";"], ["10", "sec"]]
    assert len(made) == 1
