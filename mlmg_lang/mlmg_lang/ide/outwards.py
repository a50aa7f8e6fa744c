"""Tokens before a cursor -> those that what is written there goes on from: what is closed before it is passed over."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mlmg_lang.parsing.tokens import Token


def outwards(tokens: Sequence[Token]) -> Iterator[int]:
    """Yield the numbers of tokens, the last first, but not those of parentheses that are closed and what is in them."""
    depth = 0
    for at in reversed(range(len(tokens))):
        kind = tokens[at].type
        if kind == "RIGHT":
            depth += 1
        elif kind == "LEFT" and depth:
            depth -= 1
        elif not depth:
            yield at
