"""Mistakes in what stands before `{`: the words of other languages for `repeat`, `choose` and `let`."""

from __future__ import annotations

from collections.abc import Sequence

from mlmg_lang.diagnostics import Brace, Fix
from mlmg_lang.parsing.foreign import MEANT, NUMBERS
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, mistake
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of

_HAVE: str = "only `repeat` and `choose` are followed by `{`"


def other_head(head: Sequence[Token], brace: Span) -> Mistake | None:
    """`loop 3 {`, `3 times {`, `random {`, `function GREET() {`; None where nothing of the kind stands there."""
    misspelt = _misspelt(head[0]) if len(head) == 1 and head[0].type == "NAME" else None
    if misspelt is not None:
        return misspelt
    words = {word for token in head if token.type == "NAME" for word in MEANT.get(token.text.lower(), ())}
    if head[0].type == "LET" or "let" in words:
        name = next((token.text for token in head[1:] if token.type in NAMES), "NAME")
        advice = f"write `let {name} = ...`, for each command one"
        message = "a definition stands for one command, without braces"
        return mistake("MS013", message, brace, advice, brace=Brace.NEEDLESS)
    if "choose" in words:
        return _instead(head, "choose", Token("CHOOSE", "choose", across(head[0], head[-1])))
    counts = [token.text for token in head if token.type == "INTEGER"]
    count = max(counts, key=int, default=None)  # of `i = 0; i < 3` the 3
    if count is None:
        count = next((NUMBERS[token.text.lower()] for token in head if token.text.lower() in NUMBERS), None)
    if "repeat" not in words and head[0].type != "FOR" and (count is None or head[0].type != "INTEGER"):
        return None
    if count is None or not count.isdigit():
        advice = "write how often, as in `repeat 3 { ... }`"
        return mistake("MS013", _HAVE, across(head[0], head[-1]), advice, brace=Brace.LOOP)
    span = across(head[0], head[-1])
    return _instead(head, f"repeat {count}", Token("REPEAT", "repeat", span), Token("INTEGER", count, span))


def _misspelt(word: Token) -> Mistake | None:
    """`chose {`, `CHOOSE {`, `repaet {`."""
    if word.text.lower() == "choose":
        return _shouted(word)
    message = f"`{word.text}` is not a word of the language"
    if is_slip_of(word.text, "choose"):
        fix, meant = Fix(word.span, "choose", safe=False), (Token("CHOOSE", "choose", word.span),)
        return mistake("MS019", message, word.span, "did you mean `choose`?", fix, meant=meant)
    if is_slip_of(word.text, "repeat"):
        advice = "did you mean `repeat`? It says how often, as in `repeat 3 { ... }`"
        return mistake("MS019", message, word.span, advice)
    return None


def _shouted(word: Token) -> Mistake:
    """`CHOOSE {`."""
    message = f"`{word.text}`: the words of the language are written in lower case"
    fix, meant = Fix(word.span, "choose", safe=True), (Token("CHOOSE", "choose", word.span),)
    return mistake("MS011", message, word.span, "write `choose`", fix, meant=meant)


def _instead(head: Sequence[Token], right: str, *meant: Token) -> Mistake:
    span = across(head[0], head[-1])
    return mistake(
        "MS013", _HAVE, span, f"write `{right} {{ ... }}`", Fix(span, right, safe=False), meant=meant, brace=Brace.LOOP
    )
