"""What is said of a script, in parts that are ready for Markdown."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

from mlmg_lang.spelling import joined

_MOST: Final = 8
"""So many names are listed."""
_LONGEST: Final = 600
"""So long may a stretch of a script be, in code points."""


@dataclass(frozen=True, slots=True)
class Part:
    """A paragraph in Markdown, or a line of a list (`- `); `code`: a stretch of a script, as it is."""

    text: str
    code: bool = False


def code(name: str) -> str:
    """Return a name in Markdown as code, whatever is in it."""
    ticks = "`" * (1 + max(map(len, re.findall("`+", name)), default=0))
    pad = " " if name.startswith("`") or name.endswith("`") else ""
    return f"{ticks}{pad}{name}{pad}{ticks}"


def some(listed: Sequence[str]) -> str:
    """Return words as a sentence has them, but only the first of many."""
    n_more = len(listed) - _MOST
    return joined(chain(listed[:_MOST], (f"{n_more} more",) if n_more > 0 else ())) if listed else "none"


def shortened(text: str) -> str:
    """Return a stretch of a script, cut off if it is too long."""
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ..."
