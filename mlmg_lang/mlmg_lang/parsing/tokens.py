"""A token: the smallest piece of a script that means something."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from mlmg_lang.source import Span

NUMBERS: Final = frozenset({"INTEGER", "DECIMAL"})
NAMES: Final = frozenset({"NAME", "UNIT", "STRING"})
JOINERS: Final = frozenset({"WITH", "AND", "OR", "NOT"})
CONTINUES: Final = frozenset({"WITH", "AND", "OR", "FOR", "ONCE"})
"""What a line starts with if it goes on with the last one."""
OPENS_STATEMENT: Final = frozenset({"LET", "USE", "REPEAT", "CHOOSE", "WAIT", "END"})
ENDS_PARENTHESES: Final = frozenset({"SEMICOLON", "OPEN", "CLOSE", "BAR"})
"""What no parenthesis has its partner behind."""


@dataclass(frozen=True, slots=True)
class Token:
    """A piece of text and what it is.

    Attributes
    ----------
    type : the name of a terminal of the grammar, such as `NAME` or `WITH`.
    """

    type: str
    text: str
    span: Span

    @property
    def start_pos(self) -> int:
        """Return where it begins, in the grammar's words."""
        return self.span.start

    @property
    def end_pos(self) -> int:
        """Return where it ends, in the grammar's words."""
        return self.span.end


def n_open_braces(tokens: Iterable[Token]) -> int:
    """Return how many braces are open behind some tokens; those that close none are passed over."""
    n_open = 0
    for token in tokens:
        n_open = max(0, n_open + (token.type == "OPEN") - (token.type == "CLOSE"))
    return n_open
