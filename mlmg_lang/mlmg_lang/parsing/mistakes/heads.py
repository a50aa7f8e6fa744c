"""Mistakes in what begins with a word of its own: `let`, `use`, `end`, and `not`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from mlmg_lang.diagnostics import Fix
from mlmg_lang.parsing.foreign import other_word
from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes.mistake import Mistake, across, found, gets_further, mistake, replaced
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of


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


def use_meant(tokens: Sequence[Token]) -> Mistake | None:
    """`USE "gestures.ms"`, `ues "gestures.ms"`, `"gestures.ms" use`."""
    kinds = [token.type for token in tokens]
    path = next((token for token in tokens if token.type == "STRING" and token.text.endswith('.ms"')), None)
    if path is None or kinds not in (["NAME", "STRING"], ["STRING", "USE"]):
        return None
    word = tokens[kinds.index("STRING") - 1]
    meant = (Token("USE", "use", tokens[0].span), replace(path, span=tokens[1].span))
    if word.type == "USE":
        right = f"use {path.text}"
        fix = Fix(across(*tokens), right, safe=True)
        return mistake("MS010", "`use` stands before its file", fix.span, f"write `{right}`", fix, meant=meant)
    is_shouted = word.text.lower() == "use"
    if not is_shouted and not is_slip_of(word.text, "use") and not other_word(word.text, "use"):
        return None
    code, what = "MS019", f"`{word.text}` is not a word of the language"
    if is_shouted:
        code, what = "MS011", f"`{word.text}`: the words of the language are written in lower case"
    fix = Fix(word.span, "use", safe=is_shouted)
    return mistake(code, what, word.span, "write `use`", fix, meant=meant)


def definition(stuck: Stuck) -> Mistake | None:
    """`def GREET = WALK`, `GREET = WALK`, `let GREET := WALK`, `let GREET x = x`: what stands before what it means."""
    word = stuck.tokens[0] if _defines(stuck.tokens) else None
    at = _equals(stuck.tokens, word is not None)
    if at is None or at == (0 if word is None else 1):
        return None
    after = at + 1
    while after < len(stuck.tokens) and stuck.tokens[after].type == "EQUALS":
        after += 1
    names = stuck.tokens[0 if word is None else 1 : at - (stuck.tokens[at - 1].type == "COLON")]
    parameters = _parameters(names)
    if parameters is None:
        return None
    equals = Token("EQUALS", "=", stuck.tokens[at].span)
    meant = (Token("LET", "let", names[0].span), names[0], *parameters, equals, *stuck.tokens[after:])
    if [token.type for token in meant] == [token.type for token in stuck.tokens] or not gets_further(stuck, meant):
        return None
    return _definition(stuck, word, names, meant, across(stuck.tokens[at - (names[-1] is not stuck.tokens[at - 1])],
                                                        stuck.tokens[after - 1]))  # fmt: skip


def _defines(tokens: Sequence[Token]) -> bool:
    """Return whether the first word is `let`, or that of another language, or a slip of it before `NAME =`."""
    first = tokens[0]
    if first.type != "NAME":
        return first.type == "LET"
    is_head = [token.type for token in tokens[1:3]] in (["NAME", "EQUALS"], ["NAME", "LEFT"])
    return other_word(first.text, "let") or (is_head and is_slip_of(first.text, "let"))


def _equals(tokens: Sequence[Token], is_told: bool) -> int | None:
    """Return where the sign, or the word, stands between a name and what it means; `is_told`: that it is defined."""
    depth = 0
    for at, token in enumerate(tokens):
        depth += (token.type == "LEFT") - (token.type == "RIGHT")
        if depth == 0 and token.type == "EQUALS":
            return at
    if not is_told:
        return None
    says = ((at, token.type == "COLON" or token.text in ("as", "is", "be", "to")) for at, token in enumerate(tokens))
    return next((at for at, is_said in says if is_said and at > 1), None)


def _parameters(names: Sequence[Token]) -> tuple[Token, ...] | None:
    """Return the parameters behind a name, in parentheses; None if what stands there is something else."""
    if not names or names[0].type not in NAMES:
        return None
    rest = tuple(names[1:])
    if not rest or (rest[0].type == "LEFT" and rest[-1].type == "RIGHT"):
        return rest
    if any(token.type not in NAMES - {"STRING"} | {"COMMA"} for token in rest):
        return None
    bare = [token for token in rest if token.type != "COMMA"]
    place = across(rest[0], rest[-1])
    commas = [part for token in bare for part in (Token("COMMA", ",", token.span), token)]
    return (Token("LEFT", "(", place), *commas[1:], Token("RIGHT", ")", place))


def _definition(
    stuck: Stuck, word: Token | None, names: Sequence[Token], meant: Sequence[Token], sign: Span
) -> Mistake:
    """Say what is wrong with the head of a definition."""
    inside = ", ".join(token.text for token in names[1:] if token.type != "COMMA")
    is_bare = bool(inside) and names[1].type != "LEFT"
    head = f"{names[0].text}({inside})" if is_bare else stuck.source.slice(across(names[0], names[-1]))
    right = f"let {head} ="
    whole = Span(stuck.tokens[0].span.start, sign.end)
    if is_bare:
        message, span = "the parameters of a definition stand in parentheses", across(names[1], names[-1])
    elif word is None:
        message, span = "a definition begins with `let`", across(names[0], names[-1])
    elif word.type != "LET":
        message, span = f"a definition begins with `let`, not with `{word.text}`", word.span
    else:
        message, span = "`=` stands between a name and what it is to mean", sign
    # Names of graphs mostly have a hyphen; where no word says so, one that is a graph's is hardly to be defined.
    fix = Fix(whole, right, safe=not is_bare and (word is not None or "-" not in names[0].text))
    return mistake("MS010", message, span, f"write `{right} ...`", fix, meant=tuple(meant))


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


def number_defined(stuck: Stuck) -> Mistake | None:
    """`let pause = 3 sec`."""
    number = stuck.token(0)
    if number is None or number.type not in NUMBERS or stuck.tokens[0].type != "LET" or stuck.type(-1) != "EQUALS":
        return None
    if "NOT" not in stuck.accepts:
        return None
    advice = "a duration may be a parameter: `let STROLL(t = 3 sec) = WALK for t`"
    return mistake("MS010", "a definition stands for motions, not for a number", number.span, advice)


def _no_meaning(stuck: Stuck, advice: str) -> Mistake:
    return mistake("MS010", "this definition does not say what the name stands for", stuck.span, advice)


def comma_missing(stuck: Stuck) -> Mistake | None:
    """`let GREET(x t) = x for t`."""
    token = stuck.token(0)
    if token is None or token.type not in NAMES or not {"COMMA", "EQUALS"} <= stuck.accepts:
        return None
    before = stuck.tokens[stuck.at - 1]
    if before.text == token.text:
        fix, message = Fix(Span(before.span.end, token.span.end), "", safe=True), f"`{token.text}` stands here twice"
        return mistake("MS010", message, token.span, "take one of them out", fix, meant=replaced(stuck, stuck.at))
    needless = _needless_parameter(stuck, (stuck.at - 1, stuck.at))
    if needless is not None:
        word, meant = stuck.tokens[needless], replaced(stuck, needless)
        fix = Fix(_with_space(stuck, needless), "", safe=False)
        return mistake("MS010", f"`{word.text}` does not fit here", word.span, "take it out", fix, meant=meant)
    place = Span(before.span.end, before.span.end)
    meant = replaced(stuck, stuck.at, Token("COMMA", ",", place), n=0)
    message = f"`,` is missing before `{token.text}`"
    return mistake("MS010", message, token.span, "parameters are separated by `,`", Fix(place, ",", safe=True),
                   meant=meant)  # fmt: skip


def _needless_parameter(stuck: Stuck, places: Sequence[int]) -> int | None:
    """Return which of two names side by side is no parameter, as the definition does not use it, but the other."""
    said = {token.text for token in stuck.tokens[stuck.at + 1 :]}
    unused = [at for at in places if stuck.tokens[at].text not in said]
    return unused[0] if len(unused) == 1 else None


def _with_space(stuck: Stuck, at: int) -> Span:
    """Return the place of a token with the space that would be left over without it."""
    span = stuck.tokens[at].span
    return Span(span.start, stuck.tokens[at + 1].span.start) if at + 1 < len(stuck.tokens) else span


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
    ratio = Fraction(number.text).limit_denominator(100)
    here, others = f"`{ratio.numerator}:` here", f"`{ratio.denominator}:` where 1 is meant"
    advice = f"weights count against each other: write {here}, and {others}"
    return mistake("MS010", f"the weight of a branch is a whole number, found `{number.text}`", number.span, advice)


def _text(stuck: Stuck) -> str:
    """Return what stands before the place at which the parser is stuck."""
    return stuck.source.slice(Span(stuck.tokens[0].span.start, stuck.tokens[stuck.at - 1].span.end))
