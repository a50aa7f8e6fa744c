"""The TextMate grammar colours text as the compiler reads it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_grammar import load, scan
from mlmg_grammar.roles import Role, roles
from mlmg_grammar.textmate import SCOPES, SIGNS, language_configuration, oniguruma, textmate_grammar
from mlmg_lang.parsing.build_syntax import bad_escapes

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted(
    [*ROOT.glob("examples/*.ms"), *ROOT.glob("tests/golden/scripts/*.ms"), *ROOT.glob("tests/invalid/*.ms")]
)
LANGUAGE = load()
GRAMMAR = textmate_grammar()
ROLE_OF_SCOPE = {f"{scope}.motion-script": role for role, scope in SCOPES.items()}
WORDS = [
    *("with", "and", "not", "for", "once", "wait", "let", "repeat", "end", "choose", "use", "to", "WALK", "Upper-Body"),
    *("TALK", "t", "sec", "min", "3", "2.5", "a-b", "走路", "withdraw"),
]
SIGNS_AND_SPACE = [
    "(",
    ")",
    "(",
    ")",
    "{",
    "}",
    "|",
    ";",
    ":",
    ",",
    "=",
    "-",
    "\n",
    " ",
    " ",
    "\t",
    '"a b"',
    '"a\\"',
    "# c\n",
]
SOUP = st.lists(st.sampled_from([*WORDS, *SIGNS_AND_SPACE, " let A(", " let"])).map("".join)
TEXT = st.text(
    st.characters(exclude_characters="\x1c\x1d\x1e\x1f", exclude_categories=["Cs"])
)  # white space in Python alone


def role_of(scopes: tuple[str, ...]) -> Role:
    """Return what a stretch of text is to a reader by its scopes, innermost last."""
    if not scopes:
        return Role.SPACE
    last = scopes[0] if scopes[0].startswith("comment") else scopes[-1]
    return ROLE_OF_SCOPE.get(last) or (
        Role.SIGN if last.removesuffix(".motion-script") in SIGNS.values() else Role.WRONG
    )


def letters(pieces: Iterator[tuple[str, Role]]) -> list[tuple[str, Role]]:
    """Return every character with its role, white space left out."""
    return [(letter, role) for text, role in pieces for letter in text if not letter.isspace() and letter != "\ufeff"]


def assert_coloured_as_read(text: str, textmate: Callable[..., Any]) -> None:
    seen = letters((piece, role_of(scopes)) for piece, scopes in textmate(GRAMMAR).pieces(text))
    assert seen == letters((str(token), role) for token, role in roles(scan(LANGUAGE, text)))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_is_coloured_as_it_is_read(path: Path, textmate: Callable[..., Any]) -> None:
    assert_coloured_as_read(path.read_text(encoding="utf-8"), textmate)


@given(SOUP)
def test_any_words_and_signs_are_coloured_as_they_are_read(textmate: Callable[..., Any], text: str) -> None:
    assert_coloured_as_read(text, textmate)


@given(TEXT)
def test_any_text_is_coloured_as_it_is_read(textmate: Callable[..., Any], text: str) -> None:
    assert_coloured_as_read(text, textmate)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("with", "keyword.operator.wordlike"),
        ("repeat", "keyword.control"),
        ("10", "constant.numeric"),
        ("# with", "comment.line.number-sign"),
        ('"with"', "string.quoted.double"),
        ("{", "punctuation.section.block.begin"),
        ("|", "punctuation.separator.branch"),
        (";", "punctuation.terminator.statement"),
        (":", "punctuation.separator.weight"),
        ("&", "invalid.illegal"),
        ('"a', "invalid.illegal"),
    ],
)
def test_themes_know_what_a_token_is(text: str, name: str, textmate: Callable[..., Any]) -> None:
    assert {scopes[0] for _, scopes in textmate(GRAMMAR).pieces(text)} == {f"{name}.motion-script"}


def test_code_points_are_written_as_oniguruma_reads_them() -> None:
    assert oniguruma(r"[\x00-\x7f\s]\ufeff\U0010ffff\\d") == r"[\x{0}-\x{7f}\s]\x{feff}\x{10ffff}\\d"


@pytest.mark.parametrize("inside", [r"\"", r"\\\\", r"\n", "\\走", r"a\"b\c\\\\"])
def test_the_escapes_that_are_wrong_are_those_that_the_compiler_refuses(inside: str) -> None:
    good, bad = (escape["match"] for escape in GRAMMAR["repository"]["escapes"]["patterns"])
    found = re.findall(f"{good}|{bad}", inside)
    refused = [escape for escape in found if not re.fullmatch(good, escape)]
    assert refused == bad_escapes(inside)


# --- what VS Code asks besides ---

CONFIGURATION = language_configuration()


def test_a_word_is_a_name_or_a_number() -> None:
    text = 'WALK with Upper-Body "hand on" for 10.5sec; 走路'
    words = ["WALK", "with", "Upper-Body", "hand", "on", "for", "10.5", "sec", "走路"]
    assert re.findall(CONFIGURATION["wordPattern"], text) == words


@pytest.mark.parametrize(
    ("line", "deeper"),
    [
        ("repeat 3 {", True),
        ("repeat 3 { # often", True),
        ("choose { 2: WALK | ", True),
        ("repeat 2 { choose { A | B }", True),
        ("repeat 2 { WALK }", False),
        ("repeat 2 { choose { A | B } }", False),
        ("WALK # {", False),
        ('"a {" with B', False),
    ],
)
def test_what_stands_in_open_braces_is_indented(line: str, deeper: bool) -> None:
    assert bool(re.search(CONFIGURATION["indentationRules"]["increaseIndentPattern"], line)) == deeper


def test_a_closing_brace_stands_further_left() -> None:
    assert re.search(CONFIGURATION["indentationRules"]["decreaseIndentPattern"], "  } # end")


@pytest.mark.parametrize(
    ("before", "after", "action"), [("repeat 3 {", "}", "indentOutdent"), ("choose {", "", "indent")]
)
def test_enter_after_an_opening_brace_indents(before: str, after: str, action: str) -> None:
    rules = CONFIGURATION["onEnterRules"]
    taken = (
        rule["action"]["indent"]
        for rule in rules
        if re.search(rule["beforeText"], before) and re.search(rule.get("afterText", ""), after)
    )
    assert next(taken) == action
    assert not any(re.search(rule["beforeText"], "WALK # {") for rule in rules)
