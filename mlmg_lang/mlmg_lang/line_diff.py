"""Two texts -> the lines that differ between them, as edits that leave all others alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from typing import Final

from mlmg_lang.common_ends import common_ends
from mlmg_lang.source import Edit, Source, Span

_MOST_COMPARED: Final = 5_000
"""Of so many lines it is worked out which of them stay; of more, only where the change begins and ends."""


def changed_lines(source: Source, after: str) -> Iterator[Edit]:
    """Yield the edits of whole lines that make another text of one; where a line has become one other, that alone."""
    starts = (*source.line_starts, len(source.text))
    old, new = source.lines, Source(after).lines
    for first, last, begin, end in _differences(old, new):
        n_alone = _n_alone(old[first:last], new[begin:end])
        for n in range(n_alone):
            if old[first + n] != new[begin + n]:
                yield Edit(Span(starts[first + n], starts[first + n + 1]), new[begin + n])
        rest = Edit(Span(starts[first + n_alone], starts[last]), "".join(new[begin + n_alone : end]))
        if rest.replacement != source.slice(rest.span):
            yield rest


def _n_alone(old: Sequence[str], new: Sequence[str]) -> int:
    """Return how many of the first of some lines become another each: all, or those that are only spaced otherwise."""
    if len(old) == len(new):
        return len(old)
    pairs = zip(old, new, strict=False)
    return next((n for n, pair in enumerate(pairs) if not _is_respaced(*pair)), min(len(old), len(new)))


def _is_respaced(one: str, other: str) -> bool:
    """Return whether two lines have the same signs but for spaces, and some."""
    signs = one.split()
    return bool(signs) and "".join(signs) == "".join(other.split())


def _differences(old: Sequence[str], new: Sequence[str]) -> Iterator[tuple[int, int, int, int]]:
    """Yield which lines have become which: first and behind the last, before and after."""
    head, tail = common_ends(old, new)
    middle, others = old[head : len(old) - tail], new[head : len(new) - tail]
    if len(middle) + len(others) > _MOST_COMPARED:
        yield head, len(old) - tail, head, len(new) - tail
        return
    for kind, first, last, begin, end in SequenceMatcher(None, middle, others, autojunk=False).get_opcodes():
        if kind != "equal":
            yield first + head, last + head, begin + head, end + head
