"""A long text -> its beginnings, one longer than the other, and what is wrong with one whatever stands behind it.

So there is something to say of a long text before all of it has been read.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import Final

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.diagnostics import Severity

_FEWEST: Final = 300
"""So many lines a beginning has more than the one before: what these say is found out in about a tenth of a second."""
_FURTHER: Final = 0.25
"""And at least by this share more, so that of a text of any length there are few beginnings."""
_OPENS, _CLOSES = (re.compile(signs) for signs in (r"[({（｛]|/\*", r"[)}）｝]|\*/"))
_MAY_DEFINE: Final = re.compile(r"\b(?:let|use)\b|\.ms\b|^\s*[^\s(]+\s+[^\s(]+(?:\([^)]*\))?\s*=", re.IGNORECASE)
"""A definition, or a file with some, even where `let` or `use` is misspelt."""


def longer(lines: Sequence[str], n_read: int) -> int:
    """Return how many lines the next beginning of a text has, when the last has had so many, or none."""
    return closed(lines, n_read, n_read + max(_FEWEST, int(n_read * _FURTHER)))


def closed(lines: Sequence[str], n_closed: int, n_lines: int) -> int:
    """Return the fewest lines that are at least so many, and at whose end nothing is open.

    Parameters
    ----------
    lines : of the text, with their ends.
    n_closed : how many there are where nothing is open, as far as is known; not more than `n_lines`.
    """
    depths = accumulate(map(_deeper, lines[n_closed:]), lambda depth, more: max(depth + more, 0), initial=0)
    return next((end for end, depth in enumerate(depths, n_closed) if end >= n_lines and not depth), len(lines))


def _deeper(line: str) -> int:
    """Return how much more is open behind a line than before it."""
    said = _said(line)
    return len(_OPENS.findall(said)) - len(_CLOSES.findall(said))


def n_defining(lines: Sequence[str]) -> int:
    """Return how many lines there are up to the last that may define names, which may be used before."""
    found = (at + 1 for at in reversed(range(len(lines))) if _MAY_DEFINE.search(_said(lines[at])))
    return next(found, 0)


def _said(line: str) -> str:
    return line.partition("#")[0]


def sure(analysis: Analysis) -> Analysis:
    """Return the analysis of a beginning, with those of its diagnostics alone that the whole text has too.

    These are mistakes before its last statement; nothing may be defined behind it.
    """
    end = _last(analysis.made)
    told = (one for one in analysis.diagnostics if one.severity is Severity.ERROR)
    return replace(analysis, diagnostics=tuple(one for one in told if one.span is not None and one.span.end <= end))


def _last(made: InPieces) -> int:
    """Return where the last statement of a script begins."""
    last = next(made.pieces.where_back("solid", len(made.pieces)), 0)
    return made.places.starts[last]
