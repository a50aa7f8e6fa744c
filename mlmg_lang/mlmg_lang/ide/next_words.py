"""The statement up to a cursor, and what the parser accepts there -> the words and units that could come next."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Final

from mlmg_lang.ide.arguments import argument_at
from mlmg_lang.ide.cursor import Cursor
from mlmg_lang.ide.offers import Completion, What
from mlmg_lang.ide.reach import Reach, expression, left_of_with
from mlmg_lang.ide.words import UNIT_SAYS, WORDS
from mlmg_lang.parsing.line_parser import accepted
from mlmg_lang.parsing.tokens import Token

_STATEMENT_WORDS: Final = frozenset({"WAIT", "END", "REPEAT", "CHOOSE", "LET", "USE"})
_TOP_LEVEL: Final = frozenset({"LET", "USE"})


def next_units(types: Collection[str]) -> Iterator[Completion]:
    """Yield the units that could stand behind a number; `types`: of the tokens that the parser accepts."""
    if "UNIT" in types:
        yield from (Completion(unit, unit, What.UNIT, says=says) for unit, says in UNIT_SAYS.items())


def next_words(types: Collection[str], cursor: Cursor, reach: Reach) -> Iterator[Completion]:
    """Yield the words that could stand at a cursor; `types`: of the tokens that the parser accepts."""
    continuing = accepted(cursor.last) or frozenset() if cursor.last else frozenset()
    for terminal, says in WORDS.items():
        if terminal in _TOP_LEVEL and cursor.nested:
            continue
        if terminal in types or (terminal in continuing and terminal not in _STATEMENT_WORDS):
            if terminal == "WITH" and not reach.leaves_room(expression(cursor.before or cursor.last)):
                continue
            if terminal == "NOT" and not _takes_motion(expression(cursor.before), reach):
                continue
            yield Completion(terminal.lower(), terminal.lower(), What.WORD, says=says)


def _takes_motion(own: Sequence[Token], reach: Reach) -> bool:
    """Return whether a motion can come next: on a graph that the `with` before has left, if there is one."""
    argument = argument_at(own, reach.definitions)
    if argument is not None and not argument.takes_motion:
        return False
    left = left_of_with(own)
    return left is None or reach.leaves_room(left)
