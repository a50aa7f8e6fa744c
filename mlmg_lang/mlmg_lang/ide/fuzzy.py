"""What has been written of a word, and what could be meant -> that, the likeliest first."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from itertools import compress
from typing import TypeVar

T = TypeVar("T")


def matching(word: str, offered: Iterable[T], name: Callable[[T], str], most: int | None = None) -> list[T]:
    """Return what has the letters of a word in its name, in their order; case does not count.

    First come names that are the word, then those that begin with it, then those in which a part does, then those that
    hold it, then the others; what is alike in that keeps its order.

    Parameters
    ----------
    most : where more than so many begin with the word and go on, all further ones are left out.
    """
    everything = list(offered)
    if not word:
        return everything
    wanted = word.casefold()
    names = list(map(str.casefold, map(name, everything)))
    same = list(compress(everything, map(wanted.__eq__, names)))
    begins: list[T] = []
    part_begins: list[T] = []
    holds: list[T] = []
    others: list[T] = []
    for one, folded in compress(zip(everything, names, strict=True), map(_letters(wanted).match, names)):
        at = folded.find(wanted)
        if folded == wanted:
            continue
        if at == 0:
            begins.append(one)
            if most is not None and len(begins) > most:
                return same + begins
        elif at < 0:
            others.append(one)
        else:
            (holds if folded[at - 1].isalnum() else part_begins).append(one)
    return same + begins + part_begins + holds + others


def _letters(word: str) -> re.Pattern[str]:
    """Return what matches texts with the letters of a word in their order: each where it comes first, tried once."""
    return re.compile("".join(f"[^{sign}]*+{sign}" for sign in map(re.escape, word)))
