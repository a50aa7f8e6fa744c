"""The rules as people read them are the rules that the parser obeys."""

from __future__ import annotations

from functools import cache

import lark
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_grammar import SCRIPT, grammar_text, make
from mlmg_grammar.definitions import Definition, definitions
from mlmg_grammar.ebnf import ebnf
from mlmg_grammar.expressions import Choice, Expression, Optional, Repeat, Sequence, Symbol, Text, walk
from mlmg_grammar.readable import HIDDEN, INLINED, readable

RULES = {one.name: one.expression for section in readable(grammar_text()) for one in section.definitions}
FIXED = {one.text: name for name, one in definitions(grammar_text()).items() if isinstance(one, Text)}
LANGUAGE = make(starts=(SCRIPT, "line", "unparsed"))
COMMAND = [
    "NAME",
    "NAME LEFT NAME RIGHT",
    "LEFT NAME WITH NAME RIGHT",
    "NOT NAME",
    "NAME FOR INTEGER UNIT",
    "NAME ONCE",
]
PIECES = [
    *(*COMMAND, "WITH", "AND", "OR", "WAIT DECIMAL UNIT", "END STRING", "USE STRING", "NEWLINE", "SEMICOLON", "COMMA"),
    *("LET NAME EQUALS NAME", "LET NAME LEFT NAME COMMA UNIT EQUALS INTEGER UNIT RIGHT EQUALS NAME FOR NAME"),
    *(
        "REPEAT INTEGER OPEN",
        "CHOOSE OPEN",
        "INTEGER COLON",
        "BAR",
        "CLOSE",
        "CLOSE",
        "NAME LEFT NAME EQUALS NAME RIGHT",
    ),
    *("LEFT", "RIGHT", "NAME", "EQUALS", "INTEGER", "UNIT", "FOR", "NOT"),
]
SOUP = st.lists(st.sampled_from(PIECES), max_size=12).map(lambda pieces: tuple(" ".join(pieces).split()))


def follows_rules(tokens: tuple[str, ...]) -> bool:
    """Return whether the rules as shown allow a text, by trying all ways along them."""

    @cache
    def ends(expression: Expression, start: int) -> frozenset[int]:
        match expression:
            case Text(text):
                return here(FIXED[text], start)
            case Symbol(name) if expression.is_terminal:
                return here(name, start)
            case Symbol(name):
                return ends(RULES[name], start)
            case Optional(part):
                return ends(part, start) | {start}
            case Choice(options):
                return frozenset().union(*(ends(option, start) for option in options))
            case Sequence(parts):
                return along(parts, start)
            case Repeat(part, separator):
                again = Sequence((separator or Optional(part), part))
                reached = new = ends(part, start)
                while new:
                    new = frozenset().union(*(ends(again, at) for at in new)) - reached
                    reached |= new
                return reached
        raise AssertionError(expression)

    def here(terminal: str, start: int) -> frozenset[int]:
        return frozenset({start + 1}) if tokens[start : start + 1] == (terminal,) else frozenset()

    def along(parts: tuple[Expression, ...], start: int) -> frozenset[int]:
        reached = frozenset({start})
        for part in parts:
            reached = frozenset().union(*(ends(part, at) for at in reached))
        return reached

    return len(tokens) in ends(Symbol("script"), 0)


def parser_accepts(tokens: tuple[str, ...]) -> bool:
    parser = LANGUAGE.parse_interactive(start=SCRIPT)
    try:
        for token in tokens:
            parser.feed_token(lark.Token(token, ""))
        parser.feed_token(lark.Token("$END", ""))
    except lark.UnexpectedToken:
        return False
    return True


@given(SOUP)
def test_the_rules_as_shown_allow_what_the_parser_accepts(tokens: tuple[str, ...]) -> None:
    assert follows_rules(tokens) == parser_accepts(tokens)


def sentence(draw: st.DrawFn, expression: Expression, depth: int = 0) -> list[str]:
    """Return a text that an expression allows; what is deeper than a limit is the shortest of its kind."""
    shallow = depth < 25
    match expression:
        case Text(text):
            return [FIXED[text]]
        case Symbol(name):
            return [name] if expression.is_terminal else sentence(draw, RULES[name], depth + 1)
        case Optional(part):
            return sentence(draw, part, depth + 1) if shallow and draw(st.booleans()) else []
        case Choice(options):
            chosen = draw(st.sampled_from(options)) if shallow else options[0]
            return sentence(draw, chosen, depth + 1)
        case Sequence(parts):
            return [token for part in parts for token in sentence(draw, part, depth + 1)]
        case Repeat(part, separator):
            again = (part,) if separator is None else (separator, part)
            times = draw(st.integers(0, 2)) if shallow else 0
            return [token for one in (part, *again * times) for token in sentence(draw, one, depth + 1)]
    raise AssertionError(expression)


@given(st.composite(sentence)(Symbol("script")))
def test_the_parser_accepts_what_the_rules_as_shown_allow(tokens: list[str]) -> None:
    assert parser_accepts(tuple(tokens))


@pytest.mark.parametrize(
    ("rule", "text"),
    [
        ("body", 'body = [ item ] { ( NEWLINE | ";" ) [ item ] }'),
        ("choose", 'choose = "choose" "{" branch { "|" branch } "}"'),
        ("command", 'command = motion [ "for" amount | "once" ]'),
        ("motion", 'motion = choice { "with" choice }'),
        ("term", 'term = atom | name atom | "not" term | "(" motion ")"'),
        ("atom", 'atom = name [ "(" [ argument { "," argument } ] ")" ]'),
        ("NAME", "NAME = NAME_START { NAME_PART } { /-/ NAME_PART { NAME_PART } }"),
    ],
)
def test_a_rule_is_written_as_one_would_by_hand(rule: str, text: str) -> None:
    assert ebnf(Definition(rule, RULES[rule])) == text


def test_a_rule_is_shown_once_unless_it_is_there_for_the_parser_alone() -> None:
    names = [name.lstrip("_") for name in definitions(grammar_text()) if name not in HIDDEN | INLINED]
    assert list(RULES) == names
    used = {part.name for one in RULES.values() for part in walk(one) if isinstance(part, Symbol)}
    assert used <= set(RULES)
    assert set(definitions(grammar_text())) >= HIDDEN | INLINED
