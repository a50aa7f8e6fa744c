"""Signs that have changed places with what stands beside them -> the tokens in the order that was meant.

`;`, `|` and braces part statements. In the wrong place they would make two mistakes: one where they stand, and one
where they are missing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, OPENS_STATEMENT, Token
from mlmg_lang.source import Span

_SIGNS: Final = frozenset({"SEMICOLON", "BAR", "OPEN", "CLOSE"})
_BEGINS: Final = NAMES | OPENS_STATEMENT | NUMBERS | {"LEFT", "NOT"}
"""What a statement, or the weight before it, begins with."""
_REACH: Final = 60
"""So many tokens before and behind a sign are looked at."""


@dataclass(frozen=True, slots=True)
class Swap:
    """Tokens that stand in another order than they are meant.

    Attributes
    ----------
    at : the index of the first. order : which of them is meant to stand first, and so on.
    """

    at: int
    order: tuple[int, ...]


def in_order(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return tokens in the order that was meant, each in the place of the one before it there; the very same if so."""
    swaps = find_swaps(tokens)
    if not swaps:
        return tokens
    found = list(tokens)
    for swap in swaps:
        for place, number in enumerate(swap.order):
            found[swap.at + place] = replace(tokens[swap.at + number], span=tokens[swap.at + place].span)
    return found


def swapped(tokens: Sequence[Token]) -> Iterator[Diagnostic]:
    """Yield what is wrong with the order of tokens."""
    for swap in find_swaps(tokens):
        parts = tokens[swap.at : swap.at + len(swap.order)]
        right = " ".join(parts[number].text for number in swap.order)
        span = Span(parts[0].span.start, parts[-1].span.end)
        sign = next(number for number, part in enumerate(parts) if part.type in _SIGNS)
        others = " ".join(part.text for number, part in enumerate(parts) if number != sign)
        message = f"`{parts[sign].text}` and `{others}` have changed places"
        yield Diagnostic("MS010", message, span, f"write `{right}`", fixes=(Fix(span, right, safe=False),))


def find_swaps(tokens: Sequence[Token]) -> list[Swap]:
    """Return what stands in another order than it is meant."""
    signs = (at for at, token in enumerate(tokens) if token.type in _SIGNS)
    found: list[Swap] = []
    for at in signs:
        swap = next((swap for rule in _RULES if (swap := rule(tokens, at)) is not None), None)
        if swap is not None and (not found or swap.at > found[-1].at + len(found[-1].order) - 1):
            found.append(swap)
    return found


def _count_in_braces(tokens: Sequence[Token], at: int) -> Swap | None:
    """`repeat { 3`."""
    is_count = _kinds(tokens, at - 1, 3) == ["REPEAT", "OPEN", "INTEGER"]
    return Swap(at, (1, 0)) if is_count and _kind(tokens, at + 2) not in ("COLON", "OPEN") else None


def _brace_before_head(tokens: Sequence[Token], at: int) -> Swap | None:
    """`{ choose`, `{ repeat 3`."""
    if tokens[at].type != "OPEN" or _kind(tokens, at - 1) not in _SIGNS | {"NEWLINE"}:
        return None
    size = 2 if _kind(tokens, at + 1) == "CHOOSE" else 3
    if size == 3 and _kinds(tokens, at + 1, 2) != ["REPEAT", "INTEGER"]:
        return None
    return Swap(at, (*range(1, size), 0)) if _kind(tokens, at + size) != "OPEN" else None


def _weight_before_brace(tokens: Sequence[Token], at: int) -> Swap | None:
    """`choose 3 {: WALK`."""
    is_weight = _kinds(tokens, at - 2, 4) == ["CHOOSE", "INTEGER", "OPEN", "COLON"]
    return Swap(at - 1, (1, 0)) if is_weight else None


def _sign_before_unit(tokens: Sequence[Token], at: int) -> Swap | None:
    """`WALK for 1 | sec TALK`."""
    if _kind(tokens, at - 1) not in NUMBERS or _kind(tokens, at + 1) != "UNIT":
        return None
    kind, behind = tokens[at].type, _kind(tokens, at + 2)
    is_meant = behind in _BEGINS if kind in ("SEMICOLON", "BAR") else kind == "CLOSE" and _opens_here(tokens, at)
    return Swap(at, (1, 0)) if is_meant else None


def _bar_behind_name(tokens: Sequence[Token], at: int) -> Swap | None:
    """`WALK for 1 sec TALK | for 1 sec`."""
    kinds = _kinds(tokens, at - 3, 5)
    is_name = kinds[1:3] == ["UNIT", "NAME"] and kinds[0] in NUMBERS and kinds[4:] in (["FOR"], ["ONCE"])
    return Swap(at - 1, (1, 0)) if is_name and tokens[at].type == "BAR" else None


_RULES: Final[tuple[Callable[[Sequence[Token], int], Swap | None], ...]] = (
    _count_in_braces,
    _brace_before_head,
    _weight_before_brace,
    _sign_before_unit,
    _bar_behind_name,
)
"""Each takes tokens and the index of a sign."""


def _opens_here(tokens: Sequence[Token], at: int) -> bool:
    """Return whether a brace in the same line is open before a sign, to which there is no other end in that line."""
    depth = 0
    for other in range(at - 1, max(at - _REACH, 0) - 1, -1):
        if tokens[other].type == "NEWLINE":
            break
        depth += (tokens[other].type == "OPEN") - (tokens[other].type == "CLOSE")
    for token in tokens[at + 1 : at + _REACH]:
        if token.type == "NEWLINE":
            break
        depth += (token.type == "OPEN") - (token.type == "CLOSE")
    return depth > 0


def _kind(tokens: Sequence[Token], at: int) -> str:
    """Return the type of a token, `NEWLINE` where none is."""
    return tokens[at].type if 0 <= at < len(tokens) else "NEWLINE"


def _kinds(tokens: Sequence[Token], first: int, n: int) -> list[str]:
    return [_kind(tokens, at) for at in range(first, first + n)]
