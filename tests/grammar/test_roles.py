"""What each token is to a reader."""

from __future__ import annotations

import pytest

from mlmg_grammar import load, reserved_words, scan
from mlmg_grammar.roles import BEGINS_STATEMENT, ROLES, Role, roles
from mlmg_lang.parsing.tokens import CONTINUES, JOINERS, NAMES, NUMBERS, OPENS_STATEMENT

LANGUAGE = load()


def having(*wanted: Role) -> set[str]:
    return {terminal for terminal, role in ROLES.items() if role in wanted}


def test_every_terminal_has_a_role_and_no_other() -> None:
    assert set(ROLES) == {terminal.name for terminal in LANGUAGE.terminals}


def test_the_roles_of_words_are_those_that_the_parser_gives_them() -> None:
    assert having(*BEGINS_STATEMENT) == OPENS_STATEMENT
    assert having(Role.JOINER) == JOINERS
    assert having(Role.JOINER, Role.CLAUSE) - {"NOT"} == CONTINUES
    assert having(Role.NUMBER) == NUMBERS
    assert having(Role.NAME, Role.QUOTED) == NAMES


def test_every_reserved_word_is_a_word_to_a_reader() -> None:
    words = having(*BEGINS_STATEMENT, Role.JOINER, Role.CLAUSE, Role.RESERVED)
    assert words == set(reserved_words(LANGUAGE).values())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK", "WALK:name"),
        ("Upper-Body TALK", "Upper-Body:graph TALK:name"),
        ('"Upper-Body" "a b"', '"Upper-Body":graph "a b":quoted'),
        ("Upper-Body (TALK)", "Upper-Body:graph TALK:name"),
        ("GREET(TALK)", "GREET:call TALK:name"),
        ("GREET(x = TALK)", "GREET:call x:parameter TALK:name"),
        ("end Upper-Body", "Upper-Body:graph"),
        ("Upper-Body\nTALK", "Upper-Body:name TALK:name"),
        ("Upper-Body # TALK", "Upper-Body:name"),
        ("10 sec", "sec:unit"),
        ("WALK for 2.5sec", "WALK:name sec:unit"),
        ("sec with s", "sec:name s:name"),
        ("WALK for t; wait t", "WALK:name t:parameter t:parameter"),
        ("let A = WALK", "A:defined WALK:name"),
        ("let A(x, t = 2 sec) = x", "A:defined x:parameter t:parameter sec:unit x:name"),
        ("let A(x = Upper-Body (B), y) = x", "A:defined x:parameter Upper-Body:graph B:name y:parameter x:name"),
        ("let A(\n  x,\n  y) = x", "A:defined x:parameter y:parameter x:name"),
        ("let A(x\nwait t\ny", "A:defined x:parameter t:parameter y:name"),
        ("let A(x; y", "A:defined x:parameter y:name"),
    ],
)
def test_a_name_is_told_by_its_neighbours(text: str, expected: str) -> None:
    told = {Role.NAME, Role.QUOTED, Role.GRAPH, Role.CALL, Role.PARAMETER, Role.DEFINED, Role.UNIT}
    found = ((str(token), role) for token, role in roles(scan(LANGUAGE, text)) if role in told)
    assert " ".join(f"{name}:{role.name.lower()}" for name, role in found) == expected
