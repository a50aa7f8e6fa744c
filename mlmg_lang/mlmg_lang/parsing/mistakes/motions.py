"""Mistakes in motion expressions: something is missing, or stands in the wrong place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from mlmg_lang.diagnostics import Brace, Fix
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, found, mistake, n_unread, replaced
from mlmg_lang.parsing.tokens import CONTINUES, JOINERS, NAMES, NUMBERS, Token
from mlmg_lang.source import Span
from mlmg_lang.spelling import listed

_MAX_TRIED: Final = 100
"""In so many places is a parenthesis tried that is missing."""


def no_motion_after(stuck: Stuck) -> Mistake | None:
    """A trailing `with`; `and and`; `( )`."""
    word, token = stuck.token(-1), stuck.token(0)
    if word is None or stuck.type(0) in NAMES | NUMBERS | {"UNKNOWN"} or "NAME" not in stuck.accepts:
        return None
    if token is not None and word.type == token.type and word.type in JOINERS - {"NOT"}:
        fix = Fix(Span(word.span.end, token.span.end), "", safe=True)
        message = f"`{token.text}` stands here twice"
        return mistake("MS014", message, token.span, "take one of them out", fix, meant=replaced(stuck, stuck.at))
    if word.type in JOINERS:
        message = f"`{word.text}` needs a motion after it, found {found(stuck)}"
        advice = f"write what comes after it, or take `{word.text}` out"
        return mistake("MS014", message, word.span, advice, meant=replaced(stuck, stuck.at - 1))
    if word.type == "LEFT" and token is not None and token.type == "RIGHT":
        span = across(word, token)
        return mistake("MS010", "there is nothing in the parentheses", span, "write a motion or tag in them")
    return None


def nothing_before(stuck: Stuck) -> Mistake | None:
    """`with TALK` where there is no line to go on with; the same for `for` and `once`."""
    word = stuck.token(0)
    if word is None or word.type not in CONTINUES or "NAME" not in stuck.accepts:
        return None
    message = f"`{word.text}` needs a motion before it"
    if word.type == "FOR":
        advice = "how long comes after what is played; to do it several times, write `repeat 3 { ... }`"
        return mistake("MS014", message, word.span, advice)
    meant = replaced(stuck, stuck.at) if word.type in JOINERS else None
    return mistake("MS014", message, word.span, "write a motion or tag before it", meant=meant)


def inside_parentheses(stuck: Stuck) -> Mistake | None:
    """`GREET(WALK for 2 sec)`, `(WALK with TALK once)`."""
    word = stuck.token(0)
    if word is None or word.type not in ("FOR", "ONCE") or not _open(stuck.tokens[: stuck.at]):
        return None
    if stuck.type(-1) not in NAMES | {"RIGHT"}:
        return None
    message = f"`{word.text}` stands at the end of a statement, not in parentheses"
    closing = next((at for at in range(stuck.at, len(stuck.tokens)) if stuck.tokens[at].type == "RIGHT"), None)
    n = 1 if word.type == "ONCE" else 3
    advice = "write it behind the `)`"
    if closing is None or closing != len(stuck.tokens) - 1 or closing != stuck.at + n:
        return mistake("MS010", message, word.span, advice, meant=replaced(stuck, stuck.at, n=n))
    last, inside = stuck.tokens[closing], stuck.tokens[stuck.at : closing]
    span = Span(stuck.tokens[stuck.at - 1].span.end, last.span.end)
    fix = Fix(span, f") {stuck.source.slice(across(inside[0], inside[-1]))}", safe=False)
    meant = replaced(stuck, stuck.at, last, *inside, n=n + 1)
    return mistake("MS010", message, word.span, advice, fix, meant=meant)


def not_after_graph(stuck: Stuck) -> Mistake | None:
    """`Upper-Body not TALK`."""
    word, graph = stuck.token(0), stuck.token(-1)
    if word is None or word.type != "NOT" or graph is None or graph.type not in NAMES:
        return None
    if stuck.type(1) not in NAMES | {"LEFT"}:
        return None
    span, name = across(graph, word), graph.text
    advice = f"if `{name}` is a graph, write `not {name} ...`; if it is a motion, `{name} and not ...`"
    # A `-` is what names of body parts have, and those of motions have not: nothing else tells them apart here.
    if "-" in name:
        right, meant = f"not {name}", replaced(stuck, stuck.at - 1, word, graph, n=2)
    else:
        right, meant = f"{name} and not", replaced(stuck, stuck.at, Token("AND", "and", word.span), word)
    return mistake("MS010", "`not` cannot stand directly after a name", span, advice,
                   Fix(span, right, safe=False), meant=meant)  # fmt: skip


def parenthesis(stuck: Stuck) -> Mistake | None:
    """`Upper-Body (TALK and IDLE`, `TALK)`."""
    token = stuck.token(0)
    if token is not None and token.type == "RIGHT" and not _open(stuck.tokens[: stuck.at]):
        return mistake("MS012", "this `)` closes nothing", token.span, "take it out, or write its `(`",
                       Fix(token.span, "", safe=False), meant=replaced(stuck, stuck.at),
                       brace=Brace.PARENTHESIS)  # fmt: skip
    opened = _open(stuck.tokens)
    if token is not None or not opened or "RIGHT" not in stuck.accepts:
        return None
    place, meant = _closed(stuck, opened[-1])
    fix = Fix(place, ")", safe=False)
    last = next(token for token in reversed(stuck.tokens) if token.span.end <= place.start)
    advice = "write `)` where it ends" if place == stuck.span else f"write `)` behind `{last.text}`"
    return mistake("MS012", "this `(` is never closed", opened[-1].span, advice, fix, meant=meant,
                   brace=Brace.OPEN_PARENTHESIS)  # fmt: skip


def _closed(stuck: Stuck, opening: Token) -> tuple[Span, tuple[Token, ...]]:
    """Return where a parenthesis makes all of a line readable, the last such place, and the line then; else its end."""
    first = stuck.tokens.index(opening) + 1
    for at in range(len(stuck.tokens), max(first, len(stuck.tokens) - _MAX_TRIED), -1):
        end = stuck.tokens[at - 1].span.end
        meant = replaced(stuck, at, Token("RIGHT", ")", Span(end, end)), n=0)
        if n_unread(stuck, meant) < 0:
            return Span(end, end), meant
    return stuck.span, (*stuck.tokens, Token("RIGHT", ")", stuck.span))


def _open(tokens: Sequence[Token]) -> list[Token]:
    """Return the parentheses that are open after some tokens."""
    opened: list[Token] = []
    for token in tokens:
        if token.type == "LEFT":
            opened.append(token)
        elif token.type == "RIGHT" and opened:
            opened.pop()
    return opened


def three_names(stuck: Stuck) -> Mistake | None:
    """`WALK Upper-Body TALK`: something is missing between two names."""
    token = stuck.token(0)
    if token is None or token.type not in NAMES or "WITH" not in stuck.accepts:
        return None
    advice = "join motions by `with`, `and` or `or`; what is played later stands on a line of its own"
    names = [*_names_before(stuck), token]
    if len(names) < 3:
        message = f"`{token.text}` cannot follow here: a word is missing before it"
        return mistake("MS010", message, token.span, advice)
    span = across(names[0], token)
    message = f"a word is missing between {listed(name.text for name in names)}"
    if len(names) > 3 or "-" not in names[1].text:
        return mistake("MS010", message, span, advice)
    # Names of graphs mostly have a hyphen. Whether it is one, nobody knows here.
    place = Span(names[1].span.start, names[1].span.start)
    right = f"{names[0].text} with {names[1].text} {token.text}"
    return mistake("MS010", message, span, f"for both at once, write `{right}`", Fix(place, "with ", safe=False))


def _names_before(stuck: Stuck) -> list[Token]:
    """Return the names that stand side by side before the one that does not fit."""
    first = stuck.at
    while first > 0 and stuck.tokens[first - 1].type in NAMES:
        first -= 1
    return list(stuck.tokens[first : stuck.at])


def after_the_end(stuck: Stuck) -> Mistake | None:
    """`WALK for 3 sec TALK`, `WALK for 3 sec 4`."""
    token = stuck.token(0)
    if token is None or stuck.accepts != {"$END"}:
        return None
    message = f"`{token.text}` cannot follow here: the statement ends before it"
    advice = "what is played later stands on a line of its own, or after `;`"
    if stuck.tokens[0].type == "USE":
        advice = "take it out: what the file defines is used by its own name"
    return mistake("MS010", message, token.span, advice)


def lone_number(stuck: Stuck) -> Mistake | None:
    """`WALK 3`, `Idle 01`."""
    number, before = stuck.token(0), stuck.token(-1)
    if number is None or number.type not in NUMBERS or before is None or before.type not in NAMES:
        return None
    if "FOR" not in stuck.accepts:
        return None
    if stuck.type(1) in NUMBERS:
        return _numbers(stuck, number)
    if number.type == "INTEGER" and number.text.startswith("0") and before.type == "NAME":
        right = f"{before.text}_{number.text}"
        span = across(before, number)
        meant = replaced(stuck, stuck.at - 1, Token("NAME", right, span), n=2)
        message = f"`{before.text} {number.text}` is no name: there is a space in it"
        return mistake("MS010", message, span, f"write `{right}`", Fix(span, right, safe=False), meant=meant)
    right = f"for {number.text} sec"
    fix = Fix(number.span, right, safe=False)
    return mistake("MS010", f"`{number.text}` cannot follow a name", number.span,
                   f"for how long it is played, write `{right}`", fix, meant=stuck.tokens[: stuck.at])  # fmt: skip


def _numbers(stuck: Stuck, first: Token) -> Mistake:
    """`OFFSET 0 0 0`."""
    end = next((at for at in range(stuck.at, len(stuck.tokens)) if stuck.tokens[at].type not in NUMBERS), None)
    span = across(first, stuck.tokens[-1 if end is None else end - 1])
    message = f"`{stuck.source.slice(span)}` cannot follow a name"
    advice = "a command is what is played, and how long: `WALK for 10 sec`"
    return mistake("MS010", message, span, advice, meant=stuck.tokens[: stuck.at])
