"""A line with several mistakes that one edit would mend -> that edit, as the one mistake that it is.

Each rule about a mistake sees where the parser is stuck, which may be only what follows from a slip before it. So where
rules have found more than one, all that a slip of the hand makes of a line is undone in turn: a word or sign too many,
two that have changed places, one too few. What makes the whole line readable was the mistake.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.line_parser import Stuck, read
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, mistake, replaced
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.source import Span

_MAX_TOKENS: Final = 200
"""The longest line that is tried: each try reads all of it."""
_REACH: Final = 8
"""How many tokens before the one that does not fit are tried."""
_WORDS: Final = frozenset({"WITH", "AND", "OR", "FOR", "COMMA", "EQUALS", "LEFT", "RIGHT"})
"""What is tried where something may be missing."""
_SPELT: Final = {"COMMA": ",", "EQUALS": "=", "LEFT": "(", "RIGHT": ")"}


def one_edit(stuck: Stuck) -> Mistake | None:
    """Return what is wrong with a line if one edit makes all of it readable."""
    if len(stuck.tokens) > _MAX_TOKENS:
        return None
    return next((told for told in _edits(stuck) if told.meant is not None and _reads(stuck, told.meant)), None)


def _reads(stuck: Stuck, tokens: tuple[Token, ...]) -> bool:
    return not isinstance(read(stuck.source, tokens, stuck.in_choose), Stuck)


def _edits(stuck: Stuck) -> Iterator[Mistake]:
    """Yield what could be undone, the likeliest first."""
    last = min(stuck.at, len(stuck.tokens) - 1)
    near = range(last, max(last - _REACH, -1), -1)
    yield from (_twice(stuck, at) for at in near if at and stuck.tokens[at].type == stuck.tokens[at - 1].type)
    kinds = [token.type for token in stuck.tokens]
    if kinds.count("LEFT") > kinds.count("RIGHT"):
        yield from (_too_few(stuck, at, "RIGHT") for at in (last + 1, *near))
    yield from (_too_many(stuck, at) for at in near if stuck.tokens[at].type not in NAMES | NUMBERS)
    yield from (_swapped(stuck, at) for at in near if at + 1 < len(stuck.tokens))
    yield from (_too_many(stuck, at) for at in near if stuck.tokens[at].type in NAMES | NUMBERS)
    yield from (_too_few(stuck, at, kind) for at in (last + 1, *near) for kind in sorted(_WORDS))


def _twice(stuck: Stuck, at: int) -> Mistake:
    """`WALK for for 10 sec`."""
    first, token = stuck.tokens[at - 1 : at + 1]
    if first.text != token.text:
        return _too_many(stuck, at)
    fix = Fix(Span(first.span.end, token.span.end), "", safe=True)
    message = f"`{token.text}` stands here twice"
    return mistake("MS010", message, token.span, "take one of them out", fix, meant=replaced(stuck, at))


def _too_many(stuck: Stuck, at: int) -> Mistake:
    """`WALK = for 10 sec`."""
    token = stuck.tokens[at]
    message = f"`{token.text}` does not fit here"
    code = "MS003" if token.type == "UNKNOWN" else "MS012" if token.type in ("LEFT", "RIGHT") else "MS010"
    fix = Fix(token.span, "", safe=False)
    return mistake(code, message, token.span, "take it out", fix, meant=replaced(stuck, at))


def _swapped(stuck: Stuck, at: int) -> Mistake:
    """`Upper-Body for TALK 10 sec`."""
    first, second = stuck.tokens[at : at + 2]
    between = stuck.source.slice(Span(first.span.end, second.span.start))
    right = f"{second.text}{between or ' '}{first.text}"
    span = across(first, second)
    message = f"`{first.text}` and `{second.text}` have changed places"
    meant = replaced(stuck, at, second, first, n=2)
    return mistake("MS010", message, span, f"write `{' '.join(right.split())}`", Fix(span, right, safe=False),
                   meant=meant)  # fmt: skip


def _too_few(stuck: Stuck, at: int, kind: str) -> Mistake:
    """`let GREET(x = x with WAVE`."""
    text = _SPELT.get(kind, kind.lower())
    before = stuck.tokens[at - 1] if at else None
    place = stuck.tokens[0].span.start if before is None else before.span.end
    span = Span(place, place)
    there = "at the end" if at == len(stuck.tokens) else f"before `{stuck.tokens[at].text}`"
    code = "MS012" if kind in ("LEFT", "RIGHT") else "MS010"
    written = text if kind in ("RIGHT", "COMMA") else f" {text}"
    shown = stuck.span if at == stuck.at else (stuck.tokens[at].span if at < len(stuck.tokens) else span)
    return mistake(code, f"`{text}` is missing {there}", shown, f"write `{text}` there", Fix(span, written, safe=False),
                   meant=replaced(stuck, at, Token(kind, text, span), n=0))  # fmt: skip
