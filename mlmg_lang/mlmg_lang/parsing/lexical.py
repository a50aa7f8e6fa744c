"""What is wrong with a token by itself, whatever stands around it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from mlmg_grammar import is_name, reserved_words
from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing.build_syntax import bad_escapes, motion_script
from mlmg_lang.parsing.quotes import CURLY, ENDS_NAME, is_lone
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import listed


def join_quoted(tokens: Sequence[Token], source: Source) -> Sequence[Token]:
    """Return tokens with those between printed quotes in a line as one name, which then is told of as one mistake."""
    if not tokens or not any(sign in source.file(tokens[0].span.start)[0].text for sign in CURLY):
        return tokens
    joined: list[Token] = []
    opened: int | None = None
    for token in tokens:
        joined.append(token)
        if token.type == "NEWLINE":
            opened = None
        elif token.type == "NAME" and opened is None and token.text[0] in CURLY and token.text[-1] not in CURLY:
            opened = len(joined) - 1
        elif opened is not None and ((token.type == "NAME" and token.text[-1] in CURLY) or is_lone(token)):
            span = Span(joined[opened].span.start, token.span.end)
            joined[opened:] = [Token("NAME", source.slice(span), span)]
            opened = None
    return joined


def check_tokens(tokens: Iterable[Token]) -> Iterator[Diagnostic]:
    """Yield what is wrong with names and quoted names."""
    for token in tokens:
        if token.type == "UNCLOSED":
            yield _unclosed(token)
        elif token.type == "STRING":
            yield from _quoted(token)
        elif token.type == "NAME" and not is_name(token.text):
            yield _odd_name(token)


def _unclosed(token: Token) -> Diagnostic:
    if is_lone(token):
        message, fix = 'this `"` has no partner', Fix(token.span, "", safe=False)
        return Diagnostic("MS002", message, token.span, "take it out, or write the name between two", fixes=(fix,))
    if token.text[-1] in CURLY:
        return _curly_quotes(token)
    message = 'this name in quotes has no closing `"`'
    name = '"' + ENDS_NAME.split(token.text[1:], maxsplit=1)[0].rstrip()
    if name == '"' or name.endswith("\\"):
        return Diagnostic("MS002", message, token.span, help='write `"` where the name ends')
    fix = Fix(Span(token.span.start, token.span.start + len(name)), f'{name}"', safe=False)
    return Diagnostic("MS002", message, token.span, f'write `{name}"`', fixes=(fix,))


def _quoted(token: Token) -> Iterator[Diagnostic]:
    inside = token.text[1:-1]
    wrong = bad_escapes(inside)
    if wrong:
        doubled = "".join(part if part not in wrong else f"\\{part}" for part in _pieces(inside))
        message = f'{listed(wrong)} in a name in quotes: only `\\"` and `\\\\` mean something'
        help_ = "a backslash itself is written `\\\\`"
        yield Diagnostic("MS004", message, token.span, help_, fixes=(Fix(token.span, f'"{doubled}"', safe=False),))
    elif not inside.strip():
        yield Diagnostic("MS004", "a name cannot be empty", token.span, help="write a motion or tag between the quotes")


def _pieces(inside: str) -> Iterator[str]:
    """Yield the characters of a quoted name, escapes whole."""
    at = 0
    while at < len(inside):
        size = 2 if inside[at] == "\\" else 1
        yield inside[at : at + size]
        at += size


def _odd_name(token: Token) -> Diagnostic:
    if CURLY & set(token.text):
        return _curly_quotes(token)
    letters = dict.fromkeys(letter for letter in token.text if letter != "-")
    wrong = [_shown(letter) for letter in letters if not f"_{letter}".isidentifier()]
    does = f"hold {listed(wrong)}" if wrong else f"begin with `{_shown(token.text[0])}`"
    message = f"a name without quotes cannot {does}"
    if not token.text.isprintable():
        return _unseen(token, f"{message}, which cannot be seen")
    fix = Fix(token.span, f'"{token.text}"', safe=True)
    return Diagnostic("MS003", message, token.span, "write the name in double quotes", fixes=(fix,))


def _unseen(token: Token, message: str) -> Diagnostic:
    seen = "".join(letter for letter in token.text if letter.isprintable())
    fixes = (Fix(token.span, seen, safe=False),) if is_name(seen) else ()
    return Diagnostic("MS003", message, token.span, f"write `{seen}`" if fixes else "take it out", fixes=fixes)


def _curly_quotes(token: Token) -> Diagnostic:
    message = 'quotes are written `"` in Motion Script, not as they are printed'
    quotes = CURLY | {'"'}
    inside = token.text.strip("".join(quotes))
    if token.text[0] not in quotes or token.text[-1] not in quotes or quotes & set(inside) or not inside:
        return Diagnostic("MS003", message, token.span, 'write `"` in their place')
    right = script_name(inside)
    return Diagnostic("MS003", message, token.span, f"write `{right}`", fixes=(Fix(token.span, right, safe=True),))


def _shown(letter: str) -> str:
    return letter if letter.isprintable() else f"U+{ord(letter[0]):04X}"


def script_name(name: str) -> str:
    """Return a name as a script has to write it: in quotes if it could be taken for something else."""
    if is_name(name) and name not in reserved_words(motion_script()):
        return name
    return in_quotes(name)


def in_quotes(text: str) -> str:
    """Return a name or path as a script has it in quotes."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
