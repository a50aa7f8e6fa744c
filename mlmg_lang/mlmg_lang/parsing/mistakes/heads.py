"""Mistakes in what begins with a word of its own: `let`, `use`, `end`, and `not`."""

from __future__ import annotations

from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, found, mistake, replaced
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Span


def graph_missing(stuck: Stuck) -> Mistake | None:
    """`end`."""
    end = stuck.token(-1)
    if end is None or end.type != "END" or "NAME" not in stuck.accepts:
        return None
    message = f"`end` needs the name of a graph after it, found {found(stuck)}"
    return mistake("MS010", message, end.span, "write which part of the body, as in `end Upper-Body`")


def path_missing(stuck: Stuck) -> Mistake | None:
    """`use`, `use gestures`."""
    use, name = stuck.token(-1), stuck.token(0)
    if use is None or use.type != "USE" or "STRING" not in stuck.accepts:
        return None
    if name is None or name.type not in NAMES or stuck.left > 1:
        message = f"`use` needs a file in double quotes after it, found {found(stuck)}"
        return mistake("MS010", message, use.span, 'write the path of the file, as in `use "gestures.ms"`')
    quoted = f'"{name.text}.ms"'
    message = "the file behind `use` stands in double quotes"
    return mistake("MS010", message, name.span, f"write `use {quoted}`", Fix(name.span, quoted, safe=False))


def name_missing(stuck: Stuck) -> Mistake | None:
    """`let = WALK`."""
    let = stuck.token(-1)
    if let is None or let.type != "LET" or "NAME" not in stuck.accepts:
        return None
    message = f"`let` needs a name after it, found {found(stuck)}"
    return mistake("MS010", message, let.span, "write what it is to be called, as in `let STROLL = ...`")


def equals_missing(stuck: Stuck) -> Mistake | None:
    """`let STROLL WALK`."""
    token = stuck.token(0)
    if stuck.tokens[0].type != "LET" or "EQUALS" not in stuck.accepts or "COMMA" in stuck.accepts:
        return None
    if token is None:
        return _no_meaning(stuck, f"write it behind `=`, as in `{_text(stuck)} = WALK`")
    if token.type not in NAMES | {"LEFT", "NOT"}:
        return None
    place = Span(token.span.start, token.span.start)
    meant = replaced(stuck, stuck.at, Token("EQUALS", "=", place), n=0)
    advice = f"write `{_text(stuck)} = {token.text}{' ...' if stuck.left > 1 else ''}`"
    message = "`=` is missing between the name and what it stands for"
    return mistake("MS010", message, token.span, advice, Fix(place, "= ", safe=False), meant=meant)


def meaning_missing(stuck: Stuck) -> Mistake | None:
    """`let STROLL =`."""
    if stuck.left or stuck.tokens[0].type != "LET" or stuck.type(-1) != "EQUALS":
        return None
    return _no_meaning(stuck, f"write it behind `=`, as in `{_text(stuck)} WALK`")


def _no_meaning(stuck: Stuck, advice: str) -> Mistake:
    return mistake("MS010", "this definition does not say what the name stands for", stuck.span, advice)


def comma_missing(stuck: Stuck) -> Mistake | None:
    """`let GREET(x t) = x for t`."""
    token = stuck.token(0)
    if token is None or token.type not in NAMES or not {"COMMA", "EQUALS"} <= stuck.accepts:
        return None
    place = Span(stuck.tokens[stuck.at - 1].span.end, stuck.tokens[stuck.at - 1].span.end)
    meant = replaced(stuck, stuck.at, Token("COMMA", ",", place), n=0)
    message = f"`,` is missing before `{token.text}`"
    return mistake("MS010", message, token.span, "parameters are separated by `,`", Fix(place, ",", safe=True),
                   meant=meant)  # fmt: skip


def not_behind_name(stuck: Stuck) -> Mistake | None:
    """`WALK not`."""
    word, name = stuck.token(0), stuck.token(-1)
    if word is None or word.type != "NOT" or name is None or "AND" not in stuck.accepts:
        return None
    message = "`not` stands before a motion or tag, and is joined to others by `and`"
    return mistake("MS014", message, word.span, f"write `{name.text} and not ...`, or take `not` out")


def weight_not_whole(stuck: Stuck) -> Mistake | None:
    """`choose { 1.5: WALK | IDLE }`."""
    number = stuck.token(0)
    if number is None or number.type != "DECIMAL" or stuck.at or stuck.type(1) != "COLON":
        return None
    advice = "weights count against each other: `3: ... | 2: ...` is as 1.5 to 1"
    return mistake("MS010", f"the weight of a branch is a whole number, found `{number.text}`", number.span, advice)


def _text(stuck: Stuck) -> str:
    """Return what stands before the place at which the parser is stuck."""
    return stuck.source.slice(Span(stuck.tokens[0].span.start, stuck.tokens[stuck.at - 1].span.end))
