"""A place in a script, or a name -> the statements that are there, or may have that name in them.

Statements are kept with addresses (see `pieces`); with each comes what makes offsets of these.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from unicodedata import normalize

from mlmg_lang.analysis import InPieces
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import folded


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement that holds no others.

    Attributes
    ----------
    item : with addresses. further : what makes offsets of them. source : the script, with the files that it uses.
    """

    item: syntax.Item
    further: int
    source: Source

    def at(self, span: Span) -> Span:
        """Return where something of it is."""
        return span.shifted(self.further)


def statements_at(made: InPieces, offset: int) -> list[Statement]:
    """Return the statements that hold no others and that an offset is in or at an end of, in the order of the text."""
    items, further = _items_at(made, offset)
    return [Statement(item, further, made.source) for item in _touching(items, offset - further)]


def _items_at(made: InPieces, offset: int) -> tuple[Sequence[syntax.Item], int]:
    """Return the items among which those at an offset are, and what makes offsets of their addresses."""
    starts = made.places.logical_line_starts
    if offset <= starts[-1]:
        number = made.places.line_at(offset)
        line = made.lines[number]
        return line.items, starts[number] - line.address
    further = starts[-1] + 1 - made.places.files.start
    scripts = (*made.gathered.used.earlier, *made.gathered.used.scripts)
    address = offset - further
    return next((one.items for one in scripts if one.span.start <= address <= one.span.end), ()), further


def _touching(items: Sequence[syntax.Item], address: int) -> Iterator[syntax.Item]:
    """Yield the statements at an address, those in blocks too."""
    after = bisect_right(items, address, key=lambda item: item.span.start)
    for item in items[max(after - 2, 0) : after]:
        if address <= item.span.end:
            if isinstance(item, syntax.Repeat):
                yield from _touching(item.body, address)
            elif isinstance(item, syntax.Choose):
                for branch in item.branches:
                    yield from _touching(branch.body, address)
            else:
                yield item


def statements_naming(made: InPieces, name: str, *, defined: bool) -> Iterator[Statement]:
    """Yield the statements of a script and the files it uses that may have a name in them, some several times in a row.

    Parameters
    ----------
    name : in NFC. defined : whether scripts define it: it is spelt in one way then, while a library's may be otherwise.
    """
    base = 0
    for file in (made.source, *made.source.used):
        for hit in _hits(file.text, name, defined):
            yield from statements_at(made, base + hit)
        base += len(file.text) + 1


def _hits(text: str, name: str, defined: bool) -> Iterable[int]:
    """Return where a name may stand in a text; everywhere if its letters cannot be found so."""
    seen = normalize("NFC", text if defined else text.casefold())
    if len(seen) != len(text):
        return range(len(text) + 1)
    word = name if defined else folded(name)
    letters = [f"\\\\{re.escape(sign)}" if sign in '"\\' else re.escape(sign) for sign in word]
    spelled = ("" if defined else "[-_]*").join(letters)
    found = (one.start() for one in re.finditer(rf"{spelled}(?!\w|-\w)", seen))
    # What stands before is looked at afterwards: an expression that begins with letters is found far sooner.
    return (at for at in found if not _in_name(seen[max(at - 2, 0) : at]))


def _in_name(before: str) -> bool:
    """Return whether what stands behind two characters goes on with a name."""
    return before.endswith("_") or before.rstrip("-")[-1:].isalnum()
