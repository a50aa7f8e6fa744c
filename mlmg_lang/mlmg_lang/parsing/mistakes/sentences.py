"""Statements that begin as those of other texts do: as in a list, with a condition, with numbers."""

from __future__ import annotations

from typing import Final

from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, mistake
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, OPENS_STATEMENT, Token
from mlmg_lang.source import Span

_BEGINS: Final = NAMES | OPENS_STATEMENT | {"LEFT", "NOT"}
_BULLETS: Final = frozenset({"-", "*", "--", "**", ">"})


def list_item(stuck: Stuck) -> Mistake | None:
    """`1. WALK`, `2) TALK`, `- WALK`."""
    kinds, first = [token.type for token in stuck.tokens[:3]], stuck.tokens[0]
    is_numbered = len(kinds) == 3 and kinds[0] == "INTEGER" and stuck.tokens[1].text in (".", ")", ".)")
    if stuck.at > 1 or not (is_numbered or first.text in _BULLETS):
        return None
    rest = stuck.tokens[2 if is_numbered else 1 :]
    if not rest or rest[0].type not in _BEGINS:
        return None
    marker = across(first, stuck.tokens[1] if is_numbered else first)
    fix = Fix(Span(marker.start, rest[0].span.start), "", safe=not stuck.in_choose)
    message = "statements stand one below the other, without numbers or signs before them"
    code = "MS010" if is_numbered else "MS003"
    advice = f"take `{stuck.source.slice(marker)}` out"
    return mistake(code, message, marker, advice, fix, meant=rest)


def condition(stuck: Stuck) -> Mistake | None:
    """`if WALK then IDLE else TALK`."""
    first, *rest = stuck.tokens
    if first.type != "NAME" or first.text.lower() != "if" or not rest or stuck.at < 2:
        return None
    words = [token.text.lower() for token in stuck.tokens]
    message = "there are no conditions in Motion Script; which of several is played can be drawn"
    advice = "write `choose { ... | ... }`"
    if words.count("then") != 1 or words.count("else") != 1 or not words.index("then") < words.index("else") - 1:
        return mistake("MS019", message, first.span, advice)
    then, other = stuck.tokens[words.index("then") + 1 : words.index("else")], stuck.tokens[words.index("else") + 1 :]
    if not other:
        return mistake("MS019", message, first.span, advice)
    right = " | ".join(stuck.source.slice(across(part[0], part[-1])) for part in (then, other))
    fix = Fix(across(first, stuck.tokens[-1]), f"choose {{ {right} }}", safe=False)
    return mistake("MS019", message, first.span, f"write `choose {{ {right} }}`", fix)


def weight_without_colon(stuck: Stuck) -> Mistake | None:
    """`choose { 3 WALK | 1: TALK }`."""
    kinds = [token.type for token in stuck.tokens[:2]]
    if not stuck.in_choose or len(kinds) < 2 or kinds[0] != "INTEGER" or kinds[1] not in _BEGINS - {"UNIT"}:
        return None
    number, rest = stuck.tokens[0], stuck.tokens[1:]
    if number.span.end == rest[0].span.start:
        return None
    fix = Fix(Span(number.span.end, number.span.end), ":", safe=False)
    message = "the weight of a branch has a `:` behind it"
    return mistake("MS010", message, number.span, f"write `{number.text}:`", fix, meant=rest)


def number_first(stuck: Stuck) -> Mistake | None:
    """`5 WALK`, `-5.1 2.3`, `-5 sec`."""
    number, rest = _number(stuck)
    if number is None or stuck.at > 1:
        return None
    shown, kinds = stuck.source.slice(number), [token.type for token in rest]
    if kinds == ["UNIT"]:
        waits = f"wait {shown.lstrip('+-')} {rest[0].text}"
        fix = Fix(Span(number.start, rest[0].span.end), waits, safe=False)
        return mistake("MS010", "a duration alone is no command", fix.span, f"to let time pass, write `{waits}`", fix)
    message = f"a statement begins with a motion or tag, not with the number `{shown}`"
    if kinds and kinds[0] in _BEGINS - {"UNIT"} and rest[0].span.start > number.end:
        fix = Fix(Span(number.start, rest[0].span.start), "", safe=False)
        return mistake("MS010", message, number, "take it out", fix, meant=rest)
    if (shown[0] in "+-" and not kinds) or (kinds and (kinds[0] in NUMBERS or rest[0].text in ("-", "+"))):
        return mistake("MS010", message, number, "write what is played, and how long: `WALK for 10 sec`")
    return None


def _number(stuck: Stuck) -> tuple[Span | None, tuple[Token, ...]]:
    """Return the number, with its sign, that a statement begins with, and what stands behind it."""
    at = 1 if stuck.tokens[0].text in ("-", "+") else 0
    if at == len(stuck.tokens) or stuck.tokens[at].type not in NUMBERS:
        return None, ()
    if at and stuck.tokens[0].span.end != stuck.tokens[1].span.start:
        return None, ()
    return across(stuck.tokens[0], stuck.tokens[at]), stuck.tokens[at + 1 :]


def wait_for_motion(stuck: Stuck) -> Mistake | None:
    """`wait until WALK`, `wait till TALK ends`."""
    if stuck.tokens[0].type != "WAIT" or len(stuck.tokens) < 2:
        return None
    word = stuck.tokens[1]
    if word.text.lower() not in ("until", "till", "while", "after", "before"):
        return None
    message = f"`wait` needs a duration after it, found `{word.text}`"
    advice = "write how long, as in `wait 10 sec`; a statement begins by itself when the one before it has ended"
    return mistake("MS017", message, word.span, advice)
