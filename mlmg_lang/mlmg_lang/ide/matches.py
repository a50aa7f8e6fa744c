"""A text and a place in it -> what has the letters of what is being written there, the likeliest first."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Final

from mlmg_lang.ide.completion import Offered, Surroundings, complete
from mlmg_lang.ide.cursor import Cursor, cursor_at, in_a_row
from mlmg_lang.ide.fuzzy import matching
from mlmg_lang.ide.offers import Completion, What
from mlmg_lang.ide.trying import trial_at, tried
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source

_NAMES: Final = frozenset({What.MOTION, What.TAG, What.GRAPH, What.DEFINITION})
_JOINS: Final = r"[\s_-]*"


@dataclass(frozen=True, slots=True)
class Matches:
    """What may be meant at a place.

    Attributes
    ----------
    offered : of all that could be written there.
    found : of that, what has the letters, the likeliest first.
    apart : whether it takes the place of several words in a row: of a name that lacks its quotes, or what joins it.
    is_final : whether what has more letters is among these.
    """

    offered: Offered
    found: tuple[Completion, ...]
    apart: bool
    is_final: bool


def matches(source: Source, tokens: Sequence[Token], offset: int, around: Surroundings, most: int) -> Matches:
    """Return what may be meant at an offset; where none begins with it, names that begin with several words in a row.

    Parameters
    ----------
    tokens : of the text, or of the lines around the offset.
    most : where more than so many begin with what is written, all further ones are left out.
    """
    cursor = cursor_at(tokens, offset)
    offered = complete(cursor, offset, around)
    word = source.text[offered.span.start : offset].lstrip('"')
    if cursor is None:
        return Matches(offered, (), apart=False, is_final=True)
    trial = trial_at(cursor, around)
    found = matching(word, offered.found, attrgetter("name"), None if trial.tries_library else most)
    is_all = trial.tries_library or len(found) <= most
    rows = tuple(in_a_row(tokens, cursor))
    if rows and not any(one.name.startswith(word) for one in found):
        several = (_apart(source, row, offset, around, most) for row in rows)
        whole = next((one for one in several if one.found), None)
        if whole is not None:
            return whole
    sound = tried(trial, found, offered.found, most)
    is_final = is_all and sound.is_all and len(sound.found) <= most and not rows
    return Matches(offered, sound.found, apart=False, is_final=is_final)


def _apart(source: Source, row: Cursor, offset: int, around: Surroundings, most: int) -> Matches:
    """Return the names that begin with the words of a row."""
    offered = complete(row, offset, around)
    words = source.text[row.span.start : offset].split()
    begins = re.compile(_JOINS.join(map(re.escape, words)), re.IGNORECASE)
    found = [one for one in offered.found if one.what in _NAMES and begins.match(one.name)]
    return Matches(offered, tried(trial_at(row, around), found, offered.found, most).found, apart=True, is_final=False)
