"""What only looks like signs and comments of the language -> the tokens that were meant, and what is wrong with them.

Keyboards for Chinese and Japanese write wide signs and digits, editors for prose make a dash of a hyphen, and other
languages have other comments. All of it would be parts of names, or strange signs in the midst of statements; told
apart before a script is cut into lines, it is one mistake each.
"""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from types import MappingProxyType
from typing import Final

from mlmg_grammar import is_name, reserved_words
from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.tokenize import MAX_TOKENS, scanned
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import listed

_SIGNS: Final[Mapping[str, str]] = MappingProxyType(
    {chr(0xFEE0 + ord(sign)): sign for sign in "(){}|;:,=#.!?&+/*-[]"}
    | dict.fromkeys("\u2010\u2011\u2012\u2013\u2014\u2015\u2212\ufe58\ufe63", "-")
    | dict.fromkeys("\u3001\uff64\u060c", ",")
    | dict.fromkeys("\u3002\uff61\u061b\u037e\u2026", ";")
)
"""Signs of other keyboards, and those of the language that they look like, or stand for."""
_WIDE: Final = r"[\uff21-\uff3a\uff41-\uff5a]|[^\D0-9]"
"""A letter or digit that could be one of ASCII in other width, or of another script."""
_ODD: Final = re.compile(rf"[{''.join(map(re.escape, _SIGNS))}]|\b\w*(?:{_WIDE})\w*")
"""A sign of another keyboard, or a word with such a letter or digit."""
_MAX_ODD: Final = 10_000
"""So many are told of in a line."""
_OPENS: Final = ("//", "--", "/*")
"""What comments begin with in other languages; the last goes on to `*/`."""


def lookalikes(tokens: Sequence[Token], narrow: Sequence[Token], source: Source) -> Iterator[Diagnostic]:
    """Yield what is wrong with such signs, once a line, and with such comments, each once.

    Parameters
    ----------
    narrow : the tokens as they are `narrowed`.
    """
    comments = [Span(narrow[first].span.start, narrow[last].span.end) for first, last in _comments(narrow)]
    if narrow is not tokens:
        for line in _odd_lines(tokens):
            odd = [token for token in line if not _is_inside(token.span, comments)]
            if odd:
                yield _wide(odd, source)
    for comment in comments:
        yield _comment(comment, source)


def _is_inside(span: Span, others: Sequence[Span]) -> bool:
    """Return whether a span lies in one of others, which are in the order of the text."""
    at = bisect_right(others, span.start, key=lambda other: other.start) - 1
    return at >= 0 and span.start < others[at].end


# --- signs -----------------------------------------------------------------------------------------------


def as_far_as_read(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return tokens up to where those `narrowed` could be more than `MAX_TOKENS`; the very same if they are not.

    Each code point of a name with signs of other keyboards could become a token.
    """
    if not tokens or tokens[-1].span.end - tokens[0].span.start <= MAX_TOKENS:
        return tokens
    room = MAX_TOKENS
    for at, token in enumerate(tokens):
        size = len(token.text) if _may_be_odd(token) else 1
        if size > room:
            end = token.span.start + room
            part = replace(token, text=token.text[:room], span=Span(token.span.start, end))
            return [*tokens[:at], *([part] if room else ())]
        room -= size
    return tokens


def _may_be_odd(token: Token) -> bool:
    return token.type == "NAME" and not token.text.isascii() and _ODD.search(token.text) is not None


def narrowed(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return tokens with those cut anew that hold signs of other keyboards; the very same if there are none."""
    if not any(token.type == "NAME" and not token.text.isascii() for token in tokens):
        return tokens
    found: list[Token] = []
    in_comment = is_odd = False
    for token in tokens:
        in_comment = in_comment and token.type != "NEWLINE"
        if not in_comment:
            parts = tuple(_cut(token))
            found += parts or (token,)
            is_odd = is_odd or bool(parts)
            in_comment = found[-1].type == "COMMENT"
    return found if is_odd else tokens


def _cut(token: Token) -> Iterator[Token]:
    """Yield what a name is that holds such signs, or is one; nothing for all other tokens."""
    if token.type != "NAME" or token.text.isascii():
        return
    narrow = _narrow(token.text)
    if narrow != token.text:
        yield from scanned(narrow, token.span.start)
    elif _is_sign(narrow):
        yield replace(token, type="UNKNOWN")


def _is_sign(text: str) -> bool:
    """Return whether what was taken for a name is nothing but arrows and signs of mathematics."""
    return all(unicodedata.category(letter) == "Sm" for letter in text)


def _narrow(text: str) -> str:
    """Return a name with what is no part of a name as the language writes it, character for character."""
    if is_name(text):
        return _narrow_word(text) if _ODD.search(text) else text
    return _ODD.sub(lambda odd: _SIGNS.get(odd[0]) or _narrow_word(odd[0]), text)


def _narrow_word(word: str) -> str:
    """Return a word in ASCII if it would be a number or a word of the language then."""
    plain = "".join(map(_plain, word))
    is_word = plain in UNITS or plain in reserved_words(motion_script())
    return plain if is_word or plain[0].isdigit() else word


def _plain(letter: str) -> str:
    digit = unicodedata.decimal(letter, None)
    if digit is not None:
        return str(digit)
    return chr(ord(letter) - 0xFEE0) if "\uff21" <= letter <= "\uff5a" else letter


def _odd_lines(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens with such signs, those of a line together, but not what stands in a comment then."""
    line: list[Token] = []
    in_comment = False
    for token in tokens:
        if token.type == "NEWLINE" and line:
            yield line
            line, in_comment = [], False
        elif not in_comment and len(line) < _MAX_ODD and _is_odd(token) and not _is_told_elsewhere(token):
            line.append(token)
            in_comment = "#" in _narrow(token.text)
    if line:
        yield line


def _is_odd(token: Token) -> bool:
    return token.type == "NAME" and not token.text.isascii() and _narrow(token.text) != token.text


def _is_told_elsewhere(token: Token) -> bool:
    """Return whether a sign is left that means nothing either, before a name or number at most: the line tells more."""
    rest = _cut(token)
    first = next(rest)
    return first.type == "UNKNOWN" and all(part.type in ("INTEGER", "DECIMAL", "NAME") for part in rest)


def _wide(tokens: Sequence[Token], source: Source) -> Diagnostic:
    """Say what is wrong with the signs of a line."""
    changes = list(islice((change for token in tokens for change in _changes(token)), _MAX_ODD))
    wrong = list(dict.fromkeys((source.slice(span), plain) for span, plain in changes))
    span = Span(changes[0][0].start, changes[-1][0].end)
    pieces, end = [], span.start
    for place, plain in changes:
        pieces += [source.slice(Span(end, place.start)), plain]
        end = place.end
    right = listed(dict.fromkeys(plain for _, plain in wrong))
    one = len(wrong) == 1
    message = (
        f"{listed(sign for sign, _ in wrong)} {'is' if one else 'are'} not the "
        f"{right} of Motion Script, but {'another character' if one else 'other characters'}"
    )
    return Diagnostic("MS003", message, span, f"write {right}", fixes=(Fix(span, "".join(pieces), safe=True),))


def _changes(token: Token) -> Iterator[tuple[Span, str]]:
    """Yield the stretches of a name that have to be written otherwise."""
    narrow = _narrow(token.text)
    narrow = narrow[: narrow.find("#") + 1] or narrow
    at = 0
    while at < len(narrow):
        end = at + 1
        if narrow[at] != token.text[at]:
            while end < len(narrow) and narrow[at].isalnum() and narrow[end].isalnum():
                end += 1
            yield Span(token.span.start + at, token.span.start + end), narrow[at:end]
        at = end


# --- comments --------------------------------------------------------------------------------------------


def without_comments(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return narrowed tokens without such comments; the very same if there are none."""
    kept: list[Token] = []
    end = 0
    for first, last in _comments(tokens):
        kept += tokens[end:first]
        end = last + 1
    return [*kept, *tokens[end:]] if end else tokens


def _comments(tokens: Sequence[Token]) -> Iterator[tuple[int, int]]:
    """Yield where a comment of another language begins and ends, as the indices of its first and last token."""
    last = -1
    unknown = [at for at, token in enumerate(tokens) if token.type == "UNKNOWN"]
    closing = [at for at in unknown if tokens[at].text.endswith("*/") and tokens[at].text != "/*/"]
    for at in unknown:
        if at > last and _opens(tokens, at):
            last = _end_of_comment(tokens, at, closing)
            yield at, last


def _opens(tokens: Sequence[Token], at: int) -> bool:
    text, before = tokens[at].text, tokens[at - 1] if at else None
    if not text.startswith(_OPENS):
        return False
    return before is None or before.type == "NEWLINE" or before.span.end < tokens[at].span.start


def _end_of_comment(tokens: Sequence[Token], first: int, closing: Sequence[int]) -> int:
    """Return the last token of a comment; `closing`: all that could be, of one that may go over lines."""
    last = first
    while last + 1 < len(tokens) and tokens[last + 1].type != "NEWLINE":
        last += 1
    if not tokens[first].text.startswith("/*"):
        return last
    at = bisect_left(closing, first)
    return closing[at] if at < len(closing) else last


def _comment(span: Span, source: Source) -> Diagnostic:
    """Say how comments are written."""
    text = source.slice(span)
    sign = text[:2]
    is_closed = sign == "/*" and text.endswith("*/")
    inside = text[2:-2] if is_closed else text[2:]
    right = re.sub(r"(\r\n|\r|\n)[ \t]*\*?", r"\1#", f"#{inside.rstrip()}")
    file, base = source.file(span.start)
    goes_on = is_closed and re.match(r"[^\S\r\n]*[^\s#]", file.text[span.end - base :]) is not None
    fixes = () if goes_on else (Fix(span, right, safe=True, name="write it behind `#`"),)
    place = Span(span.start, span.start + 2)
    advice = "a comment begins with `#`" + (" and goes to the end of the line" if goes_on or is_closed else "")
    return Diagnostic("MS003", f"`{sign}` means nothing in Motion Script", place, advice, fixes=fixes)


def opens_or_closes(narrow: Sequence[Token]) -> bool:
    """Return whether there is a sign among narrowed tokens that could make a comment of other lines."""
    return any(token.type == "UNKNOWN" and ("/*" in token.text or "*/" in token.text) for token in narrow)


def has_other_comments(tokens: Sequence[Token]) -> bool:
    """Return whether some of the tokens are meant to be comments, and are none."""
    narrow = narrowed(as_far_as_read(tokens))
    return any(_comments(narrow)) or any(token.type == "NAME" and "#" in _narrow(token.text) for token in tokens)
