"""What has been written of a word, and what could be meant -> that, the likeliest first."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")


def matching(word: str, offered: Iterable[T], name: Callable[[T], str]) -> list[T]:
    """Return what has the letters of a word in its name, in their order; case does not count.

    First come names that begin with the word, then those in which a part begins with it, then those that hold it, then
    the others; what is alike in that keeps its order.
    """
    if not word:
        return list(offered)
    wanted = word.casefold()
    letters = re.compile(".*?".join(map(re.escape, wanted)), re.DOTALL)
    begins: list[T] = []
    part_begins: list[T] = []
    holds: list[T] = []
    others: list[T] = []
    for one in offered:
        folded = name(one).casefold()
        at = folded.find(wanted)
        if at == 0:
            begins.append(one)
        elif at > 0:
            (holds if folded[at - 1].isalnum() else part_begins).append(one)
        elif letters.search(folded):
            others.append(one)
    return begins + part_begins + holds + others
