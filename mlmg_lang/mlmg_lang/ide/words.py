"""What the words of the language say, each in a few words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

WORDS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "WITH": "and, at the same time, on a part of the body",
        "FOR": "so long",
        "ONCE": "once, from its beginning to its end",
        "AND": "what is both",
        "OR": "what is one of both",
        "NOT": "all but",
        "WAIT": "stay in what is playing",
        "END": "give a part of the body back",
        "REPEAT": "several times",
        "CHOOSE": "one of several, by chance",
        "LET": "define a name",
        "USE": "the definitions of another file",
    }
)
"""The words of the language, the likeliest first, each with what it says."""
UNIT_SAYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "sec": "seconds",
        "ms": "thousandths of a second",
        "min": "minutes",
        "frames": "frames of the library",
        "cycles": "passes of the topmost motion that is named; after `wait`, of the command before",
    }
)
"""The units in their one spelling, each with what it counts."""
