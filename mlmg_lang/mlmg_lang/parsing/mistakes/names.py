"""Mistakes in names that have to stand in quotes: those that begin with a digit, and those of files."""

from __future__ import annotations

import re
from typing import Final

from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, mistake, replaced
from mlmg_lang.parsing.tokens import CONTINUES, NUMBERS, Token
from mlmg_lang.spelling import nearest

_IN_NAME: Final = NUMBERS | {"NAME", "UNIT"}
_IN_PATH: Final = _IN_NAME | {"UNKNOWN"}
_FILE: Final = re.compile(r"""(?:[^"']*[/\\])?([^/\\"']+)\.(?:bvh|fbx|c3d|amc|asf)""", re.IGNORECASE)
"""The path of a clip; what it is called."""
_BEFORE_NUMBER: Final = frozenset({"FOR", "WAIT", "REPEAT"})
"""What a number stands behind, and no motion."""


def clip_file(stuck: Stuck) -> Mistake | None:
    """`clips/Walk_01.bvh`, `14_02.bvh`."""
    if not stuck.left:
        return None
    first = last = stuck.at
    while first and _touch(stuck, first - 1) and stuck.tokens[first - 1].type in _IN_PATH:
        first -= 1
    while last + 1 < len(stuck.tokens) and _touch(stuck, last) and stuck.tokens[last + 1].type in _IN_PATH:
        last += 1
    span = across(stuck.tokens[first], stuck.tokens[last])
    path = _FILE.fullmatch(stuck.source.slice(span))
    if path is None:
        return None
    name, meant = _name(stuck, path[1], first, last - first + 1)
    message = "a motion is called as its clip, without the folder and the ending of the file"
    return mistake("MS003", message, span, f"write `{name}`", Fix(span, name, safe=False), meant=meant)


def name_from_digit(stuck: Stuck) -> Mistake | None:
    """`14_02`, `3d_walk`, `14-02`."""
    first = next((stuck.at + offset for offset in (0, -1) if stuck.type(offset) in NUMBERS), None)
    if first is None or (first and stuck.tokens[first - 1].type in _BEFORE_NUMBER):
        return None
    n = _n_written_together(stuck, first)
    behind = stuck.tokens[first + n].type if first + n < len(stuck.tokens) else "$END"
    if behind in ("UNIT", "COLON") or (n == 1 and (first or behind not in CONTINUES | {"$END"})):
        return None
    is_amount = n == 2 and _is_unit(stuck.tokens[first + 1].text)
    if is_amount and first and stuck.tokens[first - 1].type == "EQUALS":
        return None  # The default of a parameter.
    span = across(stuck.tokens[first], stuck.tokens[first + n - 1])
    name, meant = _name(stuck, stuck.source.slice(span), first, n)
    message = "a name that begins with a digit stands in quotes"
    fix = Fix(span, name, safe=n == 2 and not is_amount)
    return mistake("MS003", message, span, f"write `{name}`", fix, meant=meant)


def _n_written_together(stuck: Stuck, first: int) -> int:
    """Return how many tokens are a name that begins with a number, with single hyphens in it."""
    last = first
    while last + 1 < len(stuck.tokens) and _touch(stuck, last):
        if stuck.tokens[last + 1].type in _IN_NAME:
            last += 1
        elif stuck.tokens[last + 1].text == "-" and _goes_on(stuck, last + 1):
            last += 2
        else:
            break
    return last - first + 1


def _goes_on(stuck: Stuck, at: int) -> bool:
    """Return whether a part of a name stands directly behind a hyphen."""
    return at + 1 < len(stuck.tokens) and _touch(stuck, at) and stuck.tokens[at + 1].type in _IN_NAME


def _is_unit(word: str) -> bool:
    """Return whether what stands behind a number may say of what: `3x`, `10secs`."""
    return word.lower() == "x" or bool(nearest(word, UNITS, limit=1))


def _name(stuck: Stuck, name: str, first: int, n: int) -> tuple[str, tuple[Token, ...]]:
    """Return how a name is written, and the line with it in place of some tokens."""
    text = script_name(name)
    span = across(stuck.tokens[first], stuck.tokens[first + n - 1])
    return text, replaced(stuck, first, Token("STRING" if text.startswith('"') else "NAME", text, span), n=n)


def _touch(stuck: Stuck, at: int) -> bool:
    """Return whether nothing stands between a token and the next."""
    return stuck.tokens[at].span.end == stuck.tokens[at + 1].span.start
