"""Two sequences -> how far they are the same at both ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

S = TypeVar("S", str, Sequence[str], Sequence[int])


def common_ends(one: S, other: S) -> tuple[int, int]:
    """Return how many items two texts, or two lists, share from the first on; of the others, how many up to the last.

    It is found by comparing slices, which takes Python far less than item by item.
    """
    limit = min(len(one), len(other))
    head = _longest(limit, lambda first, end: one[first:end] == other[first:end])
    ends = len(one), len(other)
    tail = _longest(
        limit - head,
        lambda first, end: one[ends[0] - end : ends[0] - first] == other[ends[1] - end : ends[1] - first],
    )
    return head, tail


def _longest(limit: int, is_common: Callable[[int, int], bool]) -> int:
    """Return how long two sequences are the same, up to a limit; each stretch is compared about once."""
    length, step = 0, 1 << limit.bit_length()
    while step := step // 2:
        if length + step <= limit and is_common(length, length + step):
            length += step
    return length
