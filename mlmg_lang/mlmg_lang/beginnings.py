"""A long text -> its beginnings, one longer than the other, and what is wrong with one whatever stands behind it.

So there is something to say of a long text before all of it has been read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import Final

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.diagnostics import Severity
from mlmg_lang.parsing.foreign import MEANT

_FEWEST: Final = 100
"""So many lines a beginning has more than the one before: there are answers of the first in a tenth of a second."""
_FURTHER: Final = 0.25
"""And at least by this share more, so that of a text of any length there are few beginnings."""
_NARROW: Final = str.maketrans("（）｛｝＝", "(){}=")
_QUOTED, _COMMENT, _GROUP = (re.compile(form) for form in (r'"(?:[^"\\]|\\.)*"', "#.*", r"\([^()]*\)"))
_OPENS, _CLOSES = (re.compile(signs) for signs in (r"[({]|/\*", r"[)}]|\*/"))
_BRACKETS: Final = re.compile(r"[(){}（）｛｝*]")
_DEFINING: Final = tuple(word for word, meant in MEANT.items() if not {"let", "use"}.isdisjoint(meant))
_MAY_DEFINE: Final = re.compile(rf"=|\b(?:let|use)\b|(?:^|;)\s*(?:{'|'.join(_DEFINING)})\b", re.IGNORECASE)
"""A definition, or a file with some, even where `let` or `use` is another word; outside of parentheses."""
_HINTS: Final = ("=", "＝", '.ms"', "let", "use", *_DEFINING)
"""No line without one of these may define anything; most have none, and are not looked at twice."""


def beginnings(lines: Sequence[str], n_read: int = 0) -> Iterator[tuple[int, bool]]:
    """Yield how many lines ever longer beginnings of a text have, and whether what these say is sure; the last is all.

    Nothing is open at their ends. What one says is sure if nothing behind it may define names, which it may use.

    Parameters
    ----------
    lines : of the text, with their ends.
    n_read : the fewest that the first is to have, as so many were read before an edit.
    """
    depths = accumulate(map(_deeper, lines), lambda depth, more: max(depth + more, 0), initial=0)
    fewest, n_defining = n_read or _FEWEST, None
    for end, depth in enumerate(depths):
        if fewest <= end < len(lines) and not depth:
            n_defining = _n_defining(lines) if n_defining is None else n_defining
            yield end, n_defining <= end
            fewest = end + max(_FEWEST, int(end * _FURTHER))
    yield len(lines), True


def _deeper(line: str) -> int:
    """Return how much more is open behind a line than before it."""
    if not _BRACKETS.search(line):
        return 0
    said = _said(line)
    return len(_OPENS.findall(said)) - len(_CLOSES.findall(said))


def _n_defining(lines: Sequence[str]) -> int:
    """Return how many lines there are up to the last that may define names."""
    return next((at + 1 for at in reversed(range(len(lines))) if _may_define(lines[at])), 0)


def _may_define(line: str) -> bool:
    lowered = line.lower()
    if not any(hint in lowered for hint in _HINTS):
        return False
    said, n_groups = _said(line), 1
    while n_groups:
        said, n_groups = _GROUP.subn("", said)
    return _MAY_DEFINE.search(said) is not None or '.ms"' in line


def _said(line: str) -> str:
    """Return a line without its comment and what its quotes say, in signs of the script."""
    return _COMMENT.sub("", _QUOTED.sub("_", line)).translate(_NARROW)


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
