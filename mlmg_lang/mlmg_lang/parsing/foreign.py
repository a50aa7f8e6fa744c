"""Words that other languages, and people, have for what Motion Script says with a word of its own."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

OTHER_WORDS: Final[Mapping[str, str]] = MappingProxyType(
    {
        **dict.fromkeys(("def", "define", "set", "var", "const", "function", "func", "fn", "fun", "macro"), "let"),
        **dict.fromkeys(("import", "include", "require", "load"), "use"),
        **dict.fromkeys(("loop", "times", "while", "do", "foreach"), "repeat"),
        **dict.fromkeys(("random", "randomly", "either", "pick", "select", "switch"), "choose"),
        **dict.fromkeys(("pause", "sleep", "hold", "delay", "stay"), "wait"),
        **dict.fromkeys(("stop", "finish", "release", "halt", "cancel"), "end"),
        **dict.fromkeys(("while", "during", "plus", "whilst"), "with"),
        **dict.fromkeys(("during", "lasting"), "for"),
    }
)
"""Such a word -> the word of the language."""

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


def other_word(text: str, wanted: str) -> bool:
    """Return whether a word stands elsewhere for a word of the language."""
    return OTHER_WORDS.get(text.lower()) == wanted
