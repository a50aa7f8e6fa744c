"""What a rule about a mistake returns, and what the rules have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from mlmg_lang.diagnostics import Brace, Diagnostic, Fix
from mlmg_lang.parsing.line_parser import Stuck, read
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Mistake:
    """What is wrong, and the tokens that were probably meant (None: there is no telling)."""

    diagnostic: Diagnostic
    meant: tuple[Token, ...] | None = None


def mistake(
    code: str,
    message: str,
    span: Span,
    advice: str | None = None,
    *fixes: Fix,
    meant: tuple[Token, ...] | None = None,
    brace: Brace | None = None,
) -> Mistake:
    """Return a mistake; no tokens at all cannot have been meant."""
    return Mistake(Diagnostic(code, message, span, help=advice, fixes=fixes, brace=brace), meant or None)


def gets_further(stuck: Stuck, meant: Sequence[Token]) -> bool:
    """Return whether the parser leaves fewer tokens unread of these than of the line as it stands."""
    outcome = read(stuck.source, meant)
    return not isinstance(outcome, Stuck) or outcome.left < stuck.left


def n_unread(stuck: Stuck, meant: Sequence[Token]) -> int:
    """Return how many tokens of a line, as it may have been meant, the parser leaves unread; -1 if it reads all."""
    outcome = read(stuck.source, meant)
    return outcome.left if isinstance(outcome, Stuck) else -1


def replaced(stuck: Stuck, at: int, *tokens: Token, n: int = 1) -> tuple[Token, ...]:
    """Return the tokens of a line with `n` of them replaced."""
    return (*stuck.tokens[:at], *tokens, *stuck.tokens[at + n :])


def across(first: Token, last: Token) -> Span:
    """Return the span from one token to another."""
    return Span(first.span.start, last.span.end)


def found(stuck: Stuck) -> str:
    """Return in words what stands where the parser is stuck."""
    token = stuck.token(0)
    return "the end of the statement" if token is None else f"`{token.text}`"


def expected(stuck: Stuck) -> list[str]:
    """Return in words what could stand there, always in the same order."""
    accepts = stuck.accepts
    if "LET" in accepts:
        return ["a statement"]
    words = []
    if "NAME" in accepts:
        words.append("a motion or tag" if "NOT" in accepts else "a name")
    elif "STRING" in accepts:
        words.append("a name in double quotes")
    elif "UNIT" in accepts:
        words.append("a unit of time")
    return words + [text for kind, text in _WORDS.items() if kind in accepts]


_WORDS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "INTEGER": "a number",
        "WITH": "`with`",
        "AND": "`and`",
        "OR": "`or`",
        "EQUALS": "`=`",
        "COLON": "`:`",
        "COMMA": "`,`",
        "RIGHT": "`)`",
        "FOR": "`for`",
        "ONCE": "`once`",
        "$END": "the end of the statement",
    }
)
