"""Mistakes in durations: their numbers, their units, their place."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final

from mlmg_grammar import is_name
from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.amounts import SECONDS, UNITS, spelled
from mlmg_lang.parsing.foreign import NUMBERS as IN_WORDS
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, found, mistake, n_unread, replaced
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, OPENS_STATEMENT, Token
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of, nearest

_OTHER_NUMBER: Final = re.compile(r"[0-9]+(?:_[0-9]+)*(?:\.[0-9]+)?(?:[eE]-?[0-9]{1,3})?")
"""A number as other languages write it."""


def odd_number(stuck: Stuck) -> Mistake | None:
    """`.5 sec`, `1,5 sec`, `5. sec`, `-5 sec`."""
    sign, before, after = stuck.token(0), stuck.token(-1), stuck.token(1)
    if sign is None or sign.text not in (".", ",", "-", "+"):
        return None
    if after is not None and (after.type not in NUMBERS or after.span.start != sign.span.end):
        after = None
    if before is not None and before.type in NUMBERS and before.span.end == sign.span.start:
        return _odd_fraction(stuck, before, sign, after)
    return None if after is None else _odd_beginning(stuck, sign, after)


def _odd_fraction(stuck: Stuck, before: Token, sign: Token, after: Token | None) -> Mistake | None:
    """Say what is wrong with a number and a sign directly behind it."""
    if sign.text not in (".", ",") or any(part and part.type == "DECIMAL" for part in (before, after)):
        return None
    right = before.text if after is None else f"{before.text}.{after.text}"
    span = across(before, after or sign)
    meant = replaced(stuck, stuck.at - 1, _number(right, span), n=2 if after is None else 3)
    message = f"`{stuck.source.slice(span)}` is not a number"
    return mistake("MS017", message, span, f"write `{right}`", Fix(span, right, safe=False), meant=meant)


def _odd_beginning(stuck: Stuck, sign: Token, after: Token) -> Mistake | None:
    """Say what is wrong with a sign directly before a number."""
    span = across(sign, after)
    if sign.text in ("-", "+"):
        what = "how often something is repeated" if stuck.tokens[0].type == "REPEAT" else "a duration"
        what = "the weight of a branch" if stuck.tokens[-1].type == "COLON" else what
        message, right = f"{what} {'cannot be negative' if sign.text == '-' else 'has no sign'}", after.text
    elif after.type == "INTEGER":
        message, right = f"a number begins with a digit, not with `{sign.text}`", f"0.{after.text}"
    else:
        return None
    meant = replaced(stuck, stuck.at, _number(right, span), n=2)
    return mistake("MS017", message, span, f"write `{right}`", Fix(span, right, safe=sign.text == "."),
                   meant=meant)  # fmt: skip


def _number(text: str, span: Span) -> Token:
    return Token("DECIMAL" if "." in text else "INTEGER", text, span)


def number_of_other_languages(stuck: Stuck) -> Mistake | None:
    """`for 1e3 sec`, `repeat 1_000`."""
    number, name = stuck.token(-1), stuck.token(0)
    if number is None or number.type not in NUMBERS or name is None or name.span.start != number.span.end:
        return None
    span = across(number, name)
    written = stuck.source.slice(span)
    if not _OTHER_NUMBER.fullmatch(written) or not _can_be_number(stuck):
        return None
    right = spelled(float(written))
    if float(right) == 0 or len(right) > 12:
        return mistake("MS017", f"`{written}` is not a number", span, "write it in digits, as in `1000` or `0.25`")
    if stuck.left == 1 and stuck.type(-2) in ("FOR", "WAIT"):
        message = f"`{written}` is not a number in Motion Script, and its unit is missing"
        meant = replaced(stuck, stuck.at - 1, *_seconds("1", span), n=2)
        return mistake("MS017", message, span, f"for seconds, write `{right} sec`",
                       Fix(span, f"{right} sec", safe=False), meant=meant)  # fmt: skip
    meant = _with_harmless(stuck, right, span)
    return mistake("MS017", f"`{written}` is not a number in Motion Script", span, f"write `{right}`",
                   Fix(span, right, safe=True), meant=meant)  # fmt: skip


def _can_be_number(stuck: Stuck) -> bool:
    """Return whether a number may stand before the place, or only the name of a motion, which has digits too."""
    return stuck.type(-2) in ("FOR", "WAIT", "REPEAT") or stuck.type(1) in ("UNIT", "COLON")


def _with_harmless(stuck: Stuck, right: str, span: Span) -> tuple[Token, ...]:
    """Return the line with another number, if that may be far too large too: one message about it is enough."""
    unit = stuck.token(1)
    if unit is not None and unit.text.lower() in UNITS:
        return replaced(stuck, stuck.at - 1, *_seconds("1", span), n=3)
    is_count = stuck.tokens[0].type == "REPEAT"
    return replaced(stuck, stuck.at - 1, _number("1" if is_count else right, span), n=2)


def clock_time(stuck: Stuck) -> Mistake | None:
    """`for 1:30 min`, `for 5-10 sec`."""
    first, sign, second, unit = (stuck.token(offset) for offset in (-1, 0, 1, 2))
    if first is None or first.type not in NUMBERS or sign is None or sign.text not in (":", "-"):
        return None
    if second is None or second.type not in NUMBERS or stuck.type(-2) not in ("FOR", "WAIT"):
        return None
    has_unit = unit is not None and unit.text.lower() in UNITS
    span = across(first, unit if unit is not None and has_unit else second)
    meant = replaced(stuck, stuck.at - 1, *_seconds("1", span), n=4 if has_unit else 3)
    message = "a duration is one number and one unit"
    if sign.text == "-" or "." in first.text:
        return mistake("MS017", message, span, "write one number, as in `for 10 sec`", meant=meant)
    total = spelled(int(first.text) * 60 + float(second.text))
    fix = Fix(span, f"{total} sec", safe=False)
    return mistake("MS017", message, span, f"for minutes and seconds, write `{total} sec`", fix, meant=meant)


def _seconds(number: str, span: Span) -> tuple[Token, Token]:
    return _number(number, span), Token("UNIT", "sec", span)


def duration_first(stuck: Stuck) -> Mistake | None:
    """`3 sec WALK`, `3 sec`."""
    if stuck.at > 1 or len(stuck.tokens) < 2:
        return None
    number, unit, *rest = stuck.tokens
    if number.type not in NUMBERS or unit.text not in UNITS:
        return None
    amount = across(number, unit)
    written = stuck.source.slice(amount)
    if not rest:
        place = Span(amount.start, amount.start)
        advice = f"to let time pass, write `wait {written}`"
        return mistake("MS010", "a duration alone is no command", amount, advice, Fix(place, "wait ", safe=False))
    right = f"{stuck.source.slice(across(rest[0], rest[-1]))} for {written}"
    fix = Fix(across(number, rest[-1]), right, safe=False)
    meant = (*rest, Token("FOR", "for", amount), number, unit)
    return mistake("MS010", "how long comes last, after `for`", amount, f"write `{right}`", fix, meant=meant)


def time_of_beginning(stuck: Stuck) -> Mistake | None:
    """`at 5 sec WALK`, `after 5 sec WALK`."""
    if stuck.at > 1 or len(stuck.tokens) < 3:
        return None
    word, number, unit, *rest = stuck.tokens
    if word.text.lower() not in ("at", "after", "in") or number.type not in NUMBERS or unit.text not in UNITS:
        return None
    waits = f"wait {number.text} {unit.text}"
    span = across(word, unit)
    message = "a statement begins when the one before it has ended; no word says when"
    if not rest:
        return mistake("MS010", message, span, f"to let time pass, write `{waits}`", Fix(span, waits, safe=False))
    advice = f"to let time pass before it, write `{waits};`"
    return mistake("MS010", message, span, advice, Fix(span, f"{waits};", safe=False), meant=tuple(rest))


def two_quantities(stuck: Stuck) -> Mistake | None:
    """`1 min 30 sec`."""
    first, unit, second, unit_2 = (stuck.token(offset) for offset in (-2, -1, 0, 1))
    if first is None or unit is None or second is None or unit_2 is None:
        return None
    if first.type not in NUMBERS or second.type not in NUMBERS or unit_2.text not in UNITS:
        return None
    span, message = across(first, unit_2), "a duration is one number and one unit"
    kept = replaced(stuck, stuck.at, n=2)
    scales = [SECONDS.get(UNITS.get(name, "")) for name in (unit.text, unit_2.text)]
    if scales[0] is None or scales[1] is None:
        return mistake("MS017", message, span, "use one unit for all of it", meant=kept)
    total = spelled(float(first.text) * scales[0] + float(second.text) * scales[1])
    fix = Fix(span, f"{total} sec", safe=True)
    return mistake("MS017", message, span, f"write `{total} sec`", fix, meant=kept)


def unit_missing(stuck: Stuck) -> Mistake | None:
    """`for 10`, `for 10 secs`."""
    number, token = stuck.token(-1), stuck.token(0)
    if "UNIT" not in stuck.accepts or number is None or number.type not in NUMBERS:
        return None
    if token is not None and token.type == "NAME":
        return _unit_unknown(stuck, token)
    end = Span(number.span.end, number.span.end)
    fix = Fix(end, " sec", safe=False)
    meant = replaced(stuck, stuck.at, Token("UNIT", "sec", end), n=0)
    message = f"`{number.text}` of what? The unit is missing"
    return mistake("MS016", message, number.span, f"for seconds, write `{number.text} sec`", fix, meant=meant)


def _unit_unknown(stuck: Stuck, token: Token) -> Mistake:
    """Say that a word after a number is no unit."""
    message = f"`{token.text}` is not a unit of time"
    meant = replaced(stuck, stuck.at, replace(token, type="UNIT", text="sec"))
    likely = nearest(token.text, UNITS, limit=1)
    if not likely:
        return mistake("MS016", message, token.span, "the units are sec, ms, min, frames and cycles", meant=meant)
    unit = UNITS[likely[0]]
    fix = Fix(token.span, unit, safe=False)
    return mistake("MS016", message, token.span, f"did you mean `{unit}`?", fix, meant=meant)


def number_in_words(stuck: Stuck) -> Mistake | None:
    """`for ten sec`."""
    word = stuck.token(-1)
    if stuck.type(0) != "UNIT" or word is None or stuck.type(-2) not in ("FOR", "WAIT"):
        return None
    digits = IN_WORDS.get(word.text.lower())
    meant = replaced(stuck, stuck.at - 1, replace(word, type="INTEGER", text=digits or "1"))
    message = f"`{word.text}` is not a number"
    if digits is None:
        return mistake("MS017", message, word.span, "write the number in digits", meant=meant)
    fix = Fix(word.span, digits, safe=True)
    return mistake("MS017", "numbers are written in digits", word.span, f"write `{digits}`", fix, meant=meant)


def how_often(stuck: Stuck) -> Mistake | None:
    """`WALK 2 times`, `WALK 3x`."""
    at = next((stuck.at + offset for offset in (0, -1) if stuck.type(offset) == "INTEGER"), 0)
    number, word = stuck.tokens[at : at + 2] if 0 < at < len(stuck.tokens) - 1 else (None, None)
    if number is None or word is None or word.text.lower() not in ("times", "time", "x"):
        return None
    if stuck.tokens[0].type in OPENS_STATEMENT or stuck.tokens[at - 1].type in ("FOR", "LEFT", "EQUALS", "COMMA"):
        return None
    rest = (*stuck.tokens[:at], *stuck.tokens[at + 2 :])
    before, behind = (stuck.source.slice(across(part[0], part[-1])) if part else "" for part in
                      (stuck.tokens[:at], stuck.tokens[at + 2 :]))  # fmt: skip
    right = f"repeat {number.text} {{ {f'{before} {behind}'.strip()} }}"
    fix = Fix(across(stuck.tokens[0], stuck.tokens[-1]), right, safe=False)
    message = "how often something is played is said by `repeat`"
    return mistake("MS010", message, across(number, word), f"write `{right}`", fix, meant=rest)


def word_before_number(stuck: Stuck) -> Mistake | None:
    """`for about 10 sec`."""
    number, word = stuck.token(0), stuck.token(-1)
    if number is None or number.type not in NUMBERS or word is None or word.type != "NAME":
        return None
    if stuck.type(-2) not in ("FOR", "WAIT"):
        return None
    fix = Fix(Span(word.span.start, number.span.start), "", safe=False)
    message = "a duration is one number and one unit"
    return mistake("MS017", message, word.span, f"take `{word.text}` out", fix, meant=replaced(stuck, stuck.at - 1))


def for_missing(stuck: Stuck) -> Mistake | None:
    """`WALK 10 sec`."""
    number, unit = stuck.token(0), stuck.token(1)
    if number is None or number.type not in NUMBERS or "FOR" not in stuck.accepts:
        return None
    if unit is None or unit.text.lower() not in UNITS:
        return None
    at = Span(number.span.start, number.span.start)
    before = stuck.token(-1)
    is_sure = before is None or before.type != "NAME" or (is_name(before.text) and not is_slip_of(before.text, "for"))
    meant = replaced(stuck, stuck.at, Token("FOR", "for", at), n=0)
    advice = f"write `for {number.text} {unit.text.lower()}`"
    return mistake("MS010", "a duration stands after `for`", across(number, unit), advice,
                   Fix(at, "for ", safe=is_sure), meant=meant)  # fmt: skip


def for_too_much(stuck: Stuck) -> Mistake | None:
    """`wait for 10 sec`."""
    wait, token, after = stuck.token(-1), stuck.token(0), stuck.token(1)
    if wait is None or wait.type != "WAIT" or token is None or token.type != "FOR":
        return None
    if after is None:
        message = "`wait` needs a duration after it, found the end of the statement"
        return mistake("MS017", message, across(wait, token), "write how long, as in `wait 10 sec`")
    fix = Fix(Span(token.span.start, after.span.start), "", safe=True)
    advice = _waited(*stuck.tokens[stuck.at + 1 :])
    return mistake("MS010", "`wait` takes its duration without `for`", token.span, advice, fix,
                   meant=replaced(stuck, stuck.at))  # fmt: skip


def _waited(amount: Token, unit: Token | None = None, *rest: Token) -> str:
    """Return what to write instead of `wait for` and some tokens, as far as it is clear."""
    if rest or amount.type not in NAMES | NUMBERS:
        return "take `for` out"
    if amount.type in NAMES:
        return f"write `wait {amount.text}`"
    return f"write `wait {amount.text} {'sec' if unit is None else unit.text}`"


def amount_missing(stuck: Stuck) -> Mistake | None:
    """`WALK for`, `wait`."""
    word = stuck.token(-1)
    if word is None or word.type not in ("FOR", "WAIT") or "INTEGER" not in stuck.accepts:
        return None
    message = f"`{word.text}` needs a duration after it, found {found(stuck)}"
    return mistake("MS017", message, word.span, f"write how long, as in `{word.text} 10 sec`")


def for_not_last(stuck: Stuck) -> Mistake | None:
    """`WALK for 10 sec with Upper-Body TALK`."""
    tokens, word = stuck.tokens, stuck.token(0)
    at = next((at for at in range(stuck.at) if tokens[at].type == "FOR"), None)
    if word is None or word.type not in ("WITH", "AND", "OR") or at is None:
        return None
    if stuck.type(-1) == "FOR" or any(later.type in ("FOR", "ONCE") for later in tokens[stuck.at :]):
        return None
    if stuck.left == 1:
        fix = Fix(Span(tokens[stuck.at - 1].span.end, word.span.end), "", safe=False)
        message = f"`{word.text}` needs a motion after it, found the end of the statement"
        return mistake("MS014", message, word.span, f"take `{word.text}` out", fix, meant=tokens[: stuck.at])
    amount = across(tokens[at], tokens[stuck.at - 1])
    right = f"{stuck.source.slice(across(word, tokens[-1]))} {stuck.source.slice(amount)}"
    meant = (*tokens[:at], *tokens[stuck.at :], *tokens[at : stuck.at])
    fix = Fix(across(tokens[at], tokens[-1]), right, safe=n_unread(stuck, meant) < 0)
    message = "`for` comes last, after all that is to be played"
    return mistake("MS010", message, amount, f"write `{right}`", fix, meant=meant)


def for_and_once(stuck: Stuck) -> Mistake | None:
    """`WALK once for 10 sec`."""
    if stuck.type(0) not in ("FOR", "ONCE") or stuck.tokens[0].type in OPENS_STATEMENT - {"LET"}:
        return None
    if not any(token.type in ("FOR", "ONCE") for token in stuck.tokens[: stuck.at]):
        return None
    word = stuck.token(-1)
    if word is not None and word.type == "FOR" and stuck.type(0) == "ONCE":
        fix = Fix(Span(word.span.start, stuck.span.start), "", safe=True)
        meant = replaced(stuck, stuck.at - 1)
        return mistake("MS010", "`once` says how long by itself, without `for`", word.span, "write `once` alone", fix,
                       meant=meant)  # fmt: skip
    message = "a command takes one `for` or one `once`, not two"
    return mistake("MS010", message, stuck.span, "take one of them out", meant=stuck.tokens[: stuck.at])
