"""A tree of labelled sentences -> lines that a person can read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.rendering.cells import cells
from mlmg_lang.rendering.colour import Painter
from mlmg_lang.rendering.wording import safe

_NARROWEST = 24
"""However deep a tree is, its lines are not broken up further than to so many columns."""


@dataclass(frozen=True, slots=True)
class Tree:
    """A line with what belongs to it below it.

    Attributes
    ----------
    label : what it is about; painted in `style`. text : what there is to say of that.
    """

    label: str
    text: str = ""
    children: tuple[Tree, ...] = ()
    style: tuple[str, ...] = ()


def tree_lines(tree: Tree, width: int, paint: Painter) -> Iterator[str]:
    """Yield the lines of a tree, of at most `width` columns where words allow it."""
    yield from _lines(tree, width, paint, "", "")


def _lines(tree: Tree, width: int, paint: Painter, first: str, others: str) -> Iterator[str]:
    label, text = safe(tree.label), safe(tree.text)
    whole = f"{label}: {text}" if label and text else label or text
    stem = "│  " if tree.children else "   "
    left = len(label)
    for at, line in enumerate(_wrapped(whole, max(width - n_columns(others), _NARROWEST))):
        painted = paint(line[:left], *tree.style) + line[left:] if left > 0 else line
        yield first + painted if at == 0 else others + stem + painted
        # What is broken at a space goes on without it.
        left -= len(line) + 1
    for number, child in enumerate(tree.children, 1):
        is_last = number == len(tree.children)
        branch, beside = ("└─ ", "   ") if is_last else ("├─ ", "│  ")
        yield from _lines(child, width, paint, others + branch, others + beside)


def _wrapped(text: str, width: int) -> Iterator[str]:
    """Yield a text in lines; those after the first are to be indented, and so have less room."""
    room, line = width, ""
    for word in text.split(" "):
        longer = f"{line} {word}" if line else word
        if line.strip() and n_columns(longer) > room:
            yield line
            room, line = width - 3, word
        else:
            line = longer
    yield line


def n_columns(text: str) -> int:
    """Return how many columns of a terminal a text takes."""
    return len(text) if text.isascii() else sum(cell.width for cell in cells(text))


def table(rows: Iterable[tuple[str, ...]]) -> list[str]:
    """Return rows as lines with their columns below each other."""
    every = list(rows)
    n = max(map(len, every), default=0)
    widths = [max((n_columns(row[at]) for row in every if at < len(row)), default=0) for at in range(n)]
    lines = []
    for row in every:
        padded = (cell + " " * (widths[at] - n_columns(cell)) for at, cell in enumerate(row) if widths[at])
        lines.append("  ".join(padded).rstrip())
    return lines
