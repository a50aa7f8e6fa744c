"""Mistakes in characters: signs that mean nothing, or nothing here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from mlmg_lang.diagnostics import Brace, Fix
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, mistake, replaced
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.source import Span

_MEANT: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "+": ("WITH", "with"),
        "&": ("AND", "and"),
        "&&": ("AND", "and"),
        "!": ("NOT", "not "),
        "[": ("LEFT", "("),
        "]": ("RIGHT", ")"),
    }
)
"""Signs of other languages: the token that they stand for, and how it is written."""

_LATER: Final = ("->", "=>", ">", ">>", "-->", "\u2192", "\u21d2", "\u27f6")
"""What leads from one thing to the next in other languages."""

_ELSEWHERE: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "EQUALS": ("`=` stands in a definition alone", "write `let NAME = ...`"),
        "COLON": (
            "`:` stands after the weight of a branch alone",
            "weights are whole numbers in `choose { }`",
        ),
    }
)
"""Signs of the language: where they belong, and what to write instead."""


def single_quotes(stuck: Stuck) -> Mistake | None:
    """`'WALK'`, `'hand on hip'`."""
    opening = stuck.token(0)
    if opening is None or opening.text not in ("'", "`"):
        return None
    behind = range(stuck.at + 1, len(stuck.tokens))
    at = next((at for at in behind if stuck.tokens[at].text == opening.text), None)
    inside = "" if at is None else stuck.source.slice(Span(opening.span.end, stuck.tokens[at].span.start))
    if at is None or not inside.strip() or '"' in inside or "\\" in inside:
        return None
    span, right = across(opening, stuck.tokens[at]), script_name(inside)
    name = Token("STRING" if right.startswith('"') else "NAME", right, span)
    message, fix = f"`{opening.text}` means nothing in Motion Script", Fix(span, right, safe=True)
    meant = replaced(stuck, stuck.at, name, n=at - stuck.at + 1)
    return mistake("MS003", message, span, f"write `{right}`", fix, meant=meant)


def stray_character(stuck: Stuck) -> Mistake | None:
    """`WALK & TALK`, `[TALK]`, `Upper--Body`."""
    token = stuck.token(0)
    if token is None or token.type != "UNKNOWN":
        return None
    if token.text == "[" and (closing := _square(stuck)) is not None:
        return _in_square(stuck, closing)
    written = stuck.source.slice(token.span)  # it may be one of another keyboard
    shown = f"`{written}`" if written.isprintable() else f"the character U+{ord(written[0]):04X}"
    message = f"{shown} means nothing in Motion Script"
    if token.text in _MEANT:
        kind, text = _MEANT[token.text]
        meant = replaced(stuck, stuck.at, replace(token, type=kind, text=text))
        fix = Fix(token.span, text, safe=False)
        return mistake("MS003", message, token.span, f"did you mean `{text.strip()}`?", fix, meant=meant)
    advice = "a name with other signs than letters, digits, `_` and `-` needs double quotes"
    return (
        _other_language(stuck, message, token)
        or _part_of_name(stuck, message, token)
        or mistake("MS003", message, token.span, advice)
    )


def _square(stuck: Stuck) -> int | None:
    """Return where the partner of `[` stands."""
    depth = 0
    for at in range(stuck.at, len(stuck.tokens)):
        depth += (stuck.tokens[at].text == "[") - (stuck.tokens[at].text == "]")
        if not depth:
            return at
    return None


def _in_square(stuck: Stuck, closing: int) -> Mistake:
    """`EXPLAIN[WALK]`."""
    first, last = stuck.tokens[stuck.at], stuck.tokens[closing]
    if [token.type for token in stuck.tokens[stuck.at + 1 : closing]] == ["INTEGER"]:
        return _index(stuck, first, last)
    right = f"({stuck.source.slice(Span(first.span.end, last.span.start))})"
    left = replace(first, type="LEFT", text="(")
    inside = stuck.tokens[stuck.at + 1 : closing]
    meant = replaced(stuck, stuck.at, left, *inside, replace(last, type="RIGHT", text=")"), n=len(inside) + 2)
    span = across(first, last)
    message = "`[ ]` mean nothing in Motion Script"
    return mistake("MS003", message, span, f"did you mean `{right}`?", Fix(span, right, safe=False), meant=meant)


def _index(stuck: Stuck, first: Token, last: Token) -> Mistake:
    """`WALK[0]`."""
    span = across(first, last)
    message = "`[ ]` mean nothing in Motion Script: which motion of a tag is played is found out"
    advice = "take it out, or write the name of one motion"
    return mistake("MS003", message, span, advice, Fix(span, "", safe=False), meant=replaced(stuck, stuck.at, n=3))


def _other_language(stuck: Stuck, message: str, token: Token) -> Mistake | None:
    """Tell how it is written here what other languages, or sentences, write with a sign."""
    if token.text in _LATER:
        advice = "what is played later stands on a line of its own, or after `;`"
        return mistake("MS003", message, token.span, advice, Fix(token.span, ";", safe=False))
    if token.text in (".", "!", "?") and stuck.left == 1 and stuck.at:
        fix = Fix(token.span, "", safe=True)
        return mistake("MS003", message, token.span, "take it out", fix, meant=replaced(stuck, stuck.at))
    if token.text == "\\":
        advice = "take it out: a line goes on where the next begins with `with`, `and`, `or`, `for` or `once`"
        fix = Fix(token.span, "", safe=True)
        return mistake("MS003", message, token.span, advice, fix, meant=replaced(stuck, stuck.at))
    if token.text == "%" and stuck.type(-1) in NUMBERS:
        fix = Fix(token.span, "", safe=True)
        return mistake("MS003", message, token.span, "weights are whole numbers: take it out", fix)
    if token.text in ("'", "`"):
        return mistake("MS003", message, token.span, 'a name is quoted with `"`')
    return None


def _part_of_name(stuck: Stuck, message: str, token: Token) -> Mistake | None:
    """Take a sign directly between two names to be meant as a part of one name."""
    before, after = stuck.token(-1), stuck.token(1)
    if before is None or before.type not in ("NAME", "UNIT") or before.span.end != token.span.start:
        return None
    last = token
    if after is not None and after.type in NAMES | NUMBERS and after.span.start == token.span.end:
        last = after
    span = across(before, last)
    if set(token.text) == {"-"} and last is not token:
        right = f"{before.text}-{last.text}"
        meant = replaced(stuck, stuck.at - 1, Token("NAME", right, span), n=3)
        return mistake("MS003", message, token.span, f"write `{right}`", Fix(token.span, "-", safe=False), meant=meant)
    if token.text == "." and "-" in before.text and last.type == "NAME":
        # Names of graphs mostly have a hyphen.
        fix = Fix(token.span, " ", safe=False, name="write a space")
        advice = f"write `{before.text} {last.text}`"
        return mistake("MS003", message, token.span, advice, fix, meant=replaced(stuck, stuck.at))
    quoted = f'"{stuck.source.slice(span)}"'
    if not token.text.isprintable() or "\\" in quoted or last.type == "STRING":
        return None
    # Not the quoted name, which the library hardly has: that would be a second message.
    name = Token("NAME", stuck.source.slice(span), span)
    meant = replaced(stuck, stuck.at - 1, name, n=2 if last is token else 3)
    advice = f"as a part of a name, write `{quoted}`"
    return mistake("MS003", message, token.span, advice, Fix(span, quoted, safe=False), meant=meant)


def bar_for_or(stuck: Stuck) -> Mistake | None:
    """`WALK | TALK`, `WALK || TALK`."""
    bar = stuck.token(0)
    if bar is None or bar.type != "BAR":
        return None
    n = 2 if stuck.type(1) == "BAR" else 1
    span = across(bar, stuck.tokens[stuck.at + n - 1])
    message, advice = "`|` stands between the branches of `choose { }` alone", "for one or the other, write `or`"
    if "OR" not in stuck.accepts or stuck.type(n) not in NAMES | {"LEFT", "NOT"}:
        return mistake("MS010", message, span, advice, brace=Brace.OUTSIDE)
    meant = replaced(stuck, stuck.at, Token("OR", "or", span), n=n)
    fix = Fix(span, "or", safe=False)
    return mistake("MS010", message, span, advice, fix, meant=meant, brace=Brace.OUTSIDE)


def stray_sign(stuck: Stuck) -> Mistake | None:
    """`=`, `:` and `,` where they have no business."""
    token = stuck.token(0)
    if token is not None and token.type == "COMMA":
        return _comma(stuck, token)
    if token is None or token.type not in _ELSEWHERE:
        return None
    if token.type == "EQUALS" and stuck.tokens[0].type == "LET":
        return None
    message, advice = _ELSEWHERE[token.type]
    before, after = stuck.token(-1), stuck.token(1)
    is_between = before is not None and after is not None and before.type in NAMES and after.type in NAMES
    if is_between and before and after and (token.type == "COLON" or stuck.at > 1):
        fix = Fix(token.span, "", safe=False)
        right = f"{before.text} {after.text}"
        return mistake("MS010", message, token.span, f"write `{right}`", fix, meant=replaced(stuck, stuck.at))
    if token.type == "COLON" and stuck.left == 1 and stuck.at:
        fix = Fix(token.span, "", safe=False)
        return mistake("MS010", message, token.span, "take it out", fix, meant=replaced(stuck, stuck.at))
    return mistake("MS010", message, token.span, advice)


def or_for_bar(stuck: Stuck) -> Mistake | None:
    """`choose { 3: WALK or 1: IDLE }`."""
    at = next((stuck.at + offset for offset in (0, -1) if stuck.type(offset) == "OR"), None)
    if at is None or not stuck.in_choose:
        return None
    if [token.type for token in stuck.tokens[at + 1 : at + 3]] != ["INTEGER", "COLON"]:
        return None
    word = stuck.tokens[at]
    fix = Fix(word.span, "|", safe=False)
    message = "branches are separated by `|`, not by `or`"
    return mistake("MS010", message, word.span, "write `|`", fix, meant=stuck.tokens[:at])


def _comma(stuck: Stuck, token: Token) -> Mistake:
    """Say what `WALK, IDLE` is, and `choose { WALK, IDLE }`."""
    message = "`,` stands between arguments alone"
    if stuck.left == 1 and stuck.at:
        fix = Fix(token.span, "", safe=True)
        return mistake("MS010", message, token.span, "take it out", fix, meant=replaced(stuck, stuck.at))
    before = stuck.tokens[: stuck.at]
    if stuck.in_choose:
        fix = Fix(token.span, " |", safe=False)
        return mistake("MS010", message, token.span, "branches are separated by `|`", fix, meant=before)
    advice = "for one after the other, write `;` or a new line; for both at once, `with`"
    fixes = (Fix(token.span, ";", safe=False),) if {"$END", "WITH"} & stuck.accepts else ()
    return mistake("MS010", message, token.span, advice, *fixes, meant=before if fixes else None)
