"""Words that other languages, and people, have for what Motion Script says with a word of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final

from mlmg_lang.parsing.tokens import Token
from mlmg_lang.spelling import is_slip_of

_HERE: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "let": ("def", "define", "set", "var", "const", "function", "func", "fn", "fun", "macro"),
        "use": ("import", "include", "require", "load"),
        "repeat": ("loop", "times", "while", "do", "foreach"),
        "choose": ("random", "randomly", "either", "pick", "select", "switch"),
        "wait": ("pause", "sleep", "hold", "delay", "stay"),
        "end": ("stop", "finish", "release", "halt", "cancel"),
        "with": ("while", "during", "plus", "whilst"),
        "for": ("during", "lasting", "over", "at", "in", "within"),
    }
)
"""A word of the language -> those that stand elsewhere for it."""
MEANT: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {word: tuple(own for own, others in _HERE.items() if word in others) for words in _HERE.values() for word in words}
)
"""A word of other languages -> the words of the language that it may stand for."""

NEXT: Final = frozenset({"then", "next", "afterwards", "after", "before", "until"})
"""What people write between two things of which one comes after the other."""

_COUNTED: Final = (
    *("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve", "thirteen"),
    *("fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"),
)
NUMBERS: Final[Mapping[str, str]] = MappingProxyType(
    {word: str(number) for number, word in enumerate(_COUNTED, start=1)}
    | {"a": "1", "an": "1", "half": "0.5", "thirty": "30", "forty": "40", "fifty": "50", "sixty": "60"}
    | {"once": "1", "twice": "2", "thrice": "3", "hundred": "100"}
)
"""Numbers in words."""


_HEADS: Final = frozenset({"repeat", "choose"})


def means_choose(text: str) -> bool:
    """Return whether a word before `{` is `choose`, in another case, misspelt, or as other languages say it."""
    low = text.lower()
    return low == "choose" or other_word(low, "choose") or is_slip_of(low, "choose")


def opens_block(head: Sequence[Token]) -> bool:
    """Return whether what stands before `{` is meant for `repeat` or `choose`, as `for` is in other languages."""
    if head and head[0].type == "FOR":
        return True
    words = [token.text.lower() for token in head if token.type in ("NAME", "REPEAT", "CHOOSE")]
    slips = (is_slip_of(word, meant) for word in words[:1] for meant in _HEADS)
    return any(word in _HEADS or not _HEADS.isdisjoint(MEANT.get(word, ())) for word in words) or any(slips)


def defines(head: Sequence[Token]) -> bool:
    """Return whether what stands before `{` is meant for `let`."""
    return any(token.type == "LET" or other_word(token.text, "let") for token in head)


def other_word(text: str, wanted: str) -> bool:
    """Return whether a word stands elsewhere for a word of the language."""
    return wanted in MEANT.get(text.lower(), ())
