"""What each token of a script is to a reader: the one table that colours it, in editors and elsewhere.

Most of it is the token's terminal alone. What a name is for is told from its neighbours in the line, as far as that
is possible without a library; the TextMate grammar says the same in regular expressions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import Enum, StrEnum, auto
from types import MappingProxyType
from typing import Final, Generic, Protocol, TypeVar


class Placed(Protocol):
    """A token of the grammar with its place, be it the parser's own or the compiler's."""

    @property
    def type(self) -> str:
        """Return the name of its terminal."""

    @property
    def start_pos(self) -> int | None:
        """Return where it begins."""

    @property
    def end_pos(self) -> int | None:
        """Return where it ends."""


Token = TypeVar("Token", bound=Placed)


class Role(StrEnum):
    """What a token is to a reader."""

    SPACE = "white space"
    COMMENT = "comment"
    DECLARATION = "word that begins a definition"
    IMPORT = "word that brings in another file"
    STATEMENT = "word that begins a statement"
    JOINER = "word between motions"
    CLAUSE = "word that says how long"
    RESERVED = "word that is kept for later"
    NUMBER = "number"
    UNIT = "unit"
    NAME = "name of a motion, a tag or a definition"
    QUOTED = "the same in quotes"
    GRAPH = "name of a graph"
    CALL = "name with arguments"
    DEFINED = "name that is defined here"
    PARAMETER = "name of a parameter"
    SIGN = "sign"
    WRONG = "what no script may hold"


def _table() -> dict[str, Role]:
    terminals = {
        Role.SPACE: "SPACE NEWLINE",
        Role.COMMENT: "COMMENT",
        Role.DECLARATION: "LET",
        Role.IMPORT: "USE",
        Role.STATEMENT: "WAIT END REPEAT CHOOSE",
        Role.JOINER: "WITH AND OR NOT",
        Role.CLAUSE: "FOR ONCE",
        Role.RESERVED: "KEEPING TO ALONG FACING",
        Role.NUMBER: "INTEGER DECIMAL",
        Role.NAME: "NAME UNIT",
        Role.QUOTED: "STRING",
        Role.SIGN: "LEFT RIGHT OPEN CLOSE BAR SEMICOLON COLON COMMA EQUALS",
        Role.WRONG: "UNCLOSED UNKNOWN",
    }
    return {terminal: role for role, listed in terminals.items() for terminal in listed.split()}


ROLES: Final[Mapping[str, Role]] = MappingProxyType(_table())
"""Every terminal of the grammar, with what it is if nothing around it says more."""

BEGINS_STATEMENT: Final = frozenset({Role.DECLARATION, Role.IMPORT, Role.STATEMENT})
_NAMES: Final = frozenset({"NAME", "UNIT", "STRING"})
_NUMBERS: Final = frozenset({"INTEGER", "DECIMAL"})
_BEFORE_AMOUNT: Final = frozenset({"FOR", "WAIT"})
_ENDS_PARENTHESES: Final = frozenset({"SEMICOLON", "OPEN", "CLOSE", "BAR"})


def roles(tokens: Iterable[Token]) -> Iterator[tuple[Token, Role]]:
    """Yield every token of a text with its role; white space too, which may be left out."""
    reader: _Reader[Token] = _Reader()
    line: list[Token] = []
    for token in tokens:
        line.append(token)
        if token.type == "NEWLINE":
            yield from reader.line(line)
            line = []
    yield from reader.line(line)


class _Inside(Enum):
    """What an open parenthesis holds."""

    GROUP = auto()
    PARAMETERS = auto()
    DEFAULT = auto()


class _Reader(Generic[Token]):
    """Takes one line after the other; knows the parentheses that are open."""

    def __init__(self) -> None:
        self._open: list[_Inside] = []

    def line(self, tokens: list[Token]) -> Iterator[tuple[Token, Role]]:
        """Yield the tokens of a line with their roles."""
        seen = [token for token in tokens if token.type != "SPACE"]
        at = 0
        for token in tokens:
            if token.type == "SPACE":
                yield token, Role.SPACE
                continue
            self._follow(seen, at)
            yield token, self._role(seen, at)
            at += 1

    def _follow(self, line: list[Token], at: int) -> None:
        """Keep account of what is open."""
        kind = line[at].type
        if kind in _ENDS_PARENTHESES or (at == 0 and ROLES[kind] in BEGINS_STATEMENT):
            self._open.clear()
        elif kind == "LEFT":
            defines = _type(line, at - 2) == "LET" and _type(line, at - 1) in _NAMES
            self._open.append(_Inside.PARAMETERS if defines else _Inside.GROUP)
        elif self._open:
            self._go_on(kind, self._open.pop())

    def _go_on(self, kind: str, inside: _Inside) -> None:
        """Put back what is still open after a token."""
        if kind == "RIGHT":
            return
        if kind == "EQUALS" and inside is _Inside.PARAMETERS:
            inside = _Inside.DEFAULT
        elif kind == "COMMA" and inside is _Inside.DEFAULT:
            inside = _Inside.PARAMETERS
        self._open.append(inside)

    def _role(self, line: list[Token], at: int) -> Role:
        """Return what a token is between its neighbours."""
        kind, before, after = line[at].type, _type(line, at - 1), _type(line, at + 1)
        if kind not in _NAMES:
            return ROLES[kind]
        if kind == "UNIT" and before in _NUMBERS:
            return Role.UNIT
        if before in ("LET", "END"):
            return Role.DEFINED if before == "LET" else Role.GRAPH
        stands_for_one = before in _BEFORE_AMOUNT or after == "EQUALS" or self._open[-1:] == [_Inside.PARAMETERS]
        if kind != "STRING" and stands_for_one:
            return Role.PARAMETER
        if after == "LEFT":
            return Role.CALL if line[at].end_pos == line[at + 1].start_pos else Role.GRAPH
        return Role.GRAPH if after in _NAMES else ROLES[kind]


def _type(line: Sequence[Placed], at: int) -> str | None:
    """Return the type of a token of a line, None beside the line."""
    return line[at].type if 0 <= at < len(line) else None
