"""Mistakes in the words of the language: their case, their spelling, their use as names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from mlmg_grammar import reserved_words
from mlmg_lang.diagnostics import Brace, Fix
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.foreign import MEANT, NEXT
from mlmg_lang.parsing.foreign import NUMBERS as IN_WORDS
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, found, gets_further, mistake, n_unread, replaced
from mlmg_lang.parsing.tokens import CONTINUES, JOINERS, NUMBERS, Token
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of, listed

_BEGIN: Final = frozenset({"let", "use", "repeat", "choose", "wait", "end"})
"""Words that begin a statement."""
_LATER: Final = frozenset({"KEEPING", "TO", "ALONG", "FACING"})
_JOINED: Final = re.compile(r"(for|wait)([0-9]+)([a-z]*)")
_BEHIND_COUNT: Final = frozenset({"times", "time", "x", ":"})
"""What people write behind how often."""


def wrong_case(stuck: Stuck) -> Mistake | None:
    """`WALK FOR 10 SEC`: one message for all such words of the line."""
    lowered = _lowered(stuck.tokens)
    if 0 in lowered and lowered[0].type == "FOR" and len(stuck.tokens) > 1 and stuck.tokens[1].type in NUMBERS:
        # The rest of a statement on a line of its own: whatever is before it, this is all that is wrong here.
        word = stuck.tokens[0]
        fix = Fix(word.span, "for", safe=True)
        return mistake("MS011", _case_message(listed([word.text])), word.span, "write `for`", fix)
    for first in (0, max(stuck.at - 2, 0)):
        changed = {at: word for at, word in lowered.items() if at >= first}
        meant = tuple(changed.get(at, token) for at, token in enumerate(stuck.tokens))
        if changed and gets_further(stuck, meant):
            span = across(stuck.tokens[min(changed)], stuck.tokens[max(changed)])
            message = _case_message(listed(stuck.tokens[at].text for at in changed))
            advice = f"write {listed(word.text for word in changed.values())}"
            fix = Fix(span, _respelled(stuck, changed, span), safe=True)
            return mistake("MS011", message, span, advice, fix, meant=meant)
    return None


def _case_message(words: str) -> str:
    return f"{words}: the words of the language are written in lower case"


def _lowered(tokens: Sequence[Token]) -> dict[int, Token]:
    """Return, by index, the names that would be words of the language or units in lower case."""
    words = reserved_words(motion_script())
    changed = {}
    for at, token in enumerate(tokens):
        low = token.text.lower()
        if token.type != "NAME" or low == token.text:
            continue
        if low in words:
            changed[at] = replace(token, type=words[low], text=low)
        elif low in UNITS and at and tokens[at - 1].type in NUMBERS:
            changed[at] = replace(token, type="UNIT", text=low)
    return changed


def _respelled(stuck: Stuck, changed: dict[int, Token], span: Span) -> str:
    """Return the text of a span with some of its tokens spelt as changed."""
    pieces, end = [], span.start
    for token in changed.values():
        pieces += [stuck.source.slice(Span(end, token.span.start)), token.text]
        end = token.span.end
    return "".join(pieces)


def misspelt_word(stuck: Stuck) -> Mistake | None:
    """`WALK whit Upper-Body TALK`: the word may stand before the one that does not fit."""
    words = reserved_words(motion_script())
    for at in range(min(stuck.at, len(stuck.tokens) - 1), max(stuck.at - 3, -1), -1):
        token = stuck.tokens[at]
        if token.type != "NAME" or not token.text.islower():
            continue
        slips = {
            word: replaced(stuck, at, replace(token, type=words[word], text=word))
            for word in words
            if is_slip_of(token.text, word)
        }
        for word, meant in sorted(slips.items(), key=lambda slip: n_unread(stuck, slip[1])):
            if gets_further(stuck, meant):
                message, fix = (
                    f"`{token.text}` is not a word of the language",
                    Fix(token.span, word, safe=False),
                )
                return mistake("MS019", message, token.span, f"did you mean `{word}`?", fix, meant=meant)
    return None


def misspelt_before_number(stuck: Stuck) -> Mistake | None:
    """`WALK fro 10 sec`, `wiat 2 sec`: else the word would be a name, behind which `for` is missing."""
    return misspelt_word(stuck) if stuck.type(0) in NUMBERS else None


def comes_next(stuck: Stuck) -> Mistake | None:
    """`WALK for 3 sec then IDLE`, `WALK, then IDLE`."""
    near = range(max(stuck.at - 1, 0), min(stuck.at + 2, len(stuck.tokens)))
    at = next((at for at in near if stuck.tokens[at].type == "NAME" and stuck.tokens[at].text.lower() in NEXT), None)
    if at is None or stuck.tokens[0].type == "LET":
        return None
    word, before = stuck.tokens[at], list(stuck.tokens[:at])
    while before and before[-1].type in ("COMMA", "AND", "WITH"):
        before.pop()
    message = f"`{word.text}` is not a word of the language"
    advice = "what is played later stands on a line of its own, or after `;`"
    if not before or word.text.lower() not in ("then", "next", "afterwards"):
        return mistake("MS019", message, word.span, advice, meant=tuple(before))
    fix = Fix(Span(before[-1].span.end, word.span.end), ";", safe=False)
    return mistake("MS019", message, word.span, advice, fix, meant=tuple(before))


def word_of_other_languages(stuck: Stuck) -> Mistake | None:
    """`sleep 3 sec`, `import "gestures.ms"`, `WALK during 3 sec`, `WALK while Upper-Body TALK`."""
    words = reserved_words(motion_script())
    for at in range(min(stuck.at, len(stuck.tokens) - 1), max(stuck.at - 3, -1), -1):
        token = stuck.tokens[at]
        for word in MEANT.get(token.text, ()) if token.type == "NAME" else ():
            meant = replaced(stuck, at, replace(token, type=words[word], text=word))
            if (at == 0) == (word in _BEGIN) and gets_further(stuck, meant):
                return _instead(stuck, at, word, meant)
    return None


def _instead(stuck: Stuck, at: int, word: str, meant: tuple[Token, ...]) -> Mistake:
    """Say what is written here for a word of other languages; with the unit, which others leave out: `sleep 2`."""
    token, rest = stuck.tokens[at], stuck.tokens[at + 1 :]
    message = f"`{token.text}` is not a word of the language"
    if word not in ("wait", "for") or len(rest) != 1 or rest[0].type not in NUMBERS:
        return mistake("MS019", message, token.span, f"write `{word}`", Fix(token.span, word, safe=False), meant=meant)
    end = Span(rest[0].span.end, rest[0].span.end)
    right = f"{word} {rest[0].text} sec"
    fix = Fix(across(token, rest[0]), right, safe=False)
    meant = (*meant, Token("UNIT", "sec", end))
    return mistake("MS019", message, token.span, f"for seconds, write `{right}`", fix, meant=meant)


def space_missing(stuck: Stuck) -> Mistake | None:
    """`WALK for10 sec`, `wait2sec`."""
    for at in range(min(stuck.at, len(stuck.tokens) - 1), max(stuck.at - 2, -1), -1):
        token = stuck.tokens[at]
        found = _JOINED.fullmatch(token.text) if token.type == "NAME" else None
        if found is None or not (found[3] == "" or found[3] in UNITS):
            continue
        places = [Span(token.span.start + first, token.span.start + end) for first, end in found.regs[1:]]
        kinds = (found[1].upper(), "INTEGER", "UNIT")
        parts = map(Token, kinds, found.groups(), places)
        meant = replaced(stuck, at, *(part for part in parts if part.text))
        if gets_further(stuck, meant):
            behind = stuck.tokens[at + 1 : at + 2]
            unit = found[3] or (behind[0].text if behind and behind[0].type == "UNIT" else "")
            place = Span(places[1].start, places[1].start)
            fix = Fix(place, " ", safe=bool(unit), name="add a space")
            message = f"a space is missing behind `{found[1]}`"
            advice = f"write `{f'{found[1]} {found[2]} {unit}'.strip()}`"
            return mistake("MS019", message, token.span, advice, fix, meant=meant)
    return None


def reserved_as_name(stuck: Stuck) -> Mistake | None:
    """`TALK with to`."""
    token = stuck.token(0)
    if token is None or "NAME" not in stuck.accepts or (token.type in JOINERS and stuck.type(-1) != "LET"):
        return None
    if token.text not in reserved_words(motion_script()):
        return None
    meant = replaced(stuck, stuck.at, replace(token, type="NAME"))
    if not gets_further(stuck, meant) or (token.type in ("FOR", "ONCE") and stuck.type(1) != "$END"):
        return None
    fix = Fix(token.span, f'"{token.text}"', safe=False)
    message = f"`{token.text}` is a word of the language, not a name"
    return mistake("MS018", message, token.span, "in quotes it is a name", fix)


def kept_for_later(stuck: Stuck) -> Mistake | None:
    """`Idle_01 to Walk_01`, `WALK facing north`."""
    word = stuck.token(0)
    if word is None or word.type not in _LATER or stuck.left < 2 or "$END" not in stuck.accepts:
        return None
    message = f"`{word.text}` is kept for a later version of the language; it says nothing in this one"
    before, start = stuck.tokens[: stuck.at], stuck.tokens[stuck.at - 1].span.end
    if word.type == "TO":
        advice = "what is played later stands on a line of its own, or after `;`"
        fix = Fix(Span(start, word.span.end), ";", safe=False)
        return mistake("MS018", message, word.span, advice, fix, meant=before)
    rest = range(stuck.at + 1, len(stuck.tokens))
    end = next((at for at in rest if stuck.tokens[at].type in CONTINUES), len(stuck.tokens))
    fix = Fix(Span(start, stuck.tokens[end - 1].span.end), "", safe=False)
    meant = (*before, *stuck.tokens[end:])
    return mistake("MS018", message, word.span, "leave it out, with what stands behind it", fix, meant=meant)


def head_without_body(stuck: Stuck) -> Mistake | None:
    """`repeat 3 WALK`, `repeat { ... }`, `repeat twice { ... }`."""
    first = stuck.tokens[0]
    if first.type == "REPEAT":
        if "INTEGER" in stuck.accepts:
            return _count_missing(stuck)
        return _after_count(stuck)
    if first.type == "CHOOSE":
        advice = "write `choose { ... | ... }`"
        message = f"`choose` is followed by its branches in `{{ }}`, found {found(stuck)}"
        return mistake("MS013", message, stuck.span, advice, brace=Brace.MISSING)
    return None


def _after_count(stuck: Stuck) -> Mistake:
    """Say what stands between `repeat 3` and its braces: `repeat 3 times {`, `repeat 3: {`, `repeat 3x {`."""
    count, word = stuck.tokens[1], stuck.token(0)
    message = f"`repeat {count.text}` is followed by its statements in `{{ }}`, found {found(stuck)}"
    advice = f"write `repeat {count.text} {{ ... }}`"
    if word is None or stuck.left > 1 or word.text.lower() not in _BEHIND_COUNT:
        return mistake("MS013", message, stuck.span, advice, brace=Brace.MISSING)
    fix = Fix(Span(count.span.end, word.span.end), "", safe=True)
    return mistake("MS013", message, word.span, advice, fix, meant=replaced(stuck, stuck.at))


def _in_parentheses(stuck: Stuck, number: Token) -> Mistake:
    """`repeat(3) {`, `repeat (3) times {`."""
    first, last = stuck.tokens[1], stuck.tokens[-1]
    span = across(first, last)
    fix = Fix(Span(stuck.tokens[0].span.end, span.end), f" {number.text}", safe=True)
    message = "how often is said without parentheses"
    advice = f"write `repeat {number.text} {{ ... }}`"
    return mistake("MS010", message, span, advice, fix, meant=(stuck.tokens[0], replace(number, span=span)))


def _count_missing(stuck: Stuck) -> Mistake:
    """Say what is missing in `repeat {`, `repeat 2.5 {`, `repeat twice {`."""
    number = stuck.token(0)
    if number is None:
        message = "`repeat` needs a number after it: how often"
        return mistake("MS010", message, stuck.tokens[0].span, "write `repeat 3 { ... }`")
    if [token.type for token in stuck.tokens[1:4]] == ["LEFT", "INTEGER", "RIGHT"] and (
        {token.text.lower() for token in stuck.tokens[4:]} <= _BEHIND_COUNT
    ):
        return _in_parentheses(stuck, stuck.tokens[2])
    message = f"`repeat` needs a whole number after it, found `{number.text}`"
    word = number.text.lower()
    count = IN_WORDS.get(word, word.removesuffix(".0").removeprefix("x"))
    if not count.isdigit() or stuck.left > 1:
        return mistake("MS010", message, number.span, "write `repeat 3 { ... }`")
    meant = replaced(stuck, stuck.at, replace(number, type="INTEGER", text=count))
    fix = Fix(number.span, count, safe=True)
    return mistake("MS010", message, number.span, f"write `repeat {count} {{ ... }}`", fix, meant=meant)
