"""Quotes without a partner -> the tokens that were probably meant, so that the rest of the line is still read.

To the tokenizer a quote that is never closed takes all of the line with it. Its name ends rather where a word of the
language or a sign stands; and a quote before a space, or behind a word, opens nothing at all.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby, islice
from typing import Final

from mlmg_lang.parsing.tokenize import MAX_TOKENS, scanned
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, Token
from mlmg_lang.source import Span

CURLY: Final = frozenset("\u201c\u201d\u201e\u201f\u00ab\u00bb\u2018\u2019\u201a\uff02")
"""What editors for prose make of quotes."""
ENDS_NAME: Final = re.compile(r"(?<!\s)(?:\s*#|\s+(?:with|and|or|for|once)(?!\S)|\s*[(){}|;:,=\"]|\s+[0-9]|\s*$)")
"""What stands rather behind a name whose closing quote was forgotten than in it, with all spaces before it."""
_MAX_LINE: Final = 200
_MAX_SIZE: Final = 2_000
"""The longest line that is looked into, in tokens and in code points."""
_MAX_CUTS: Final = 20
"""So often a line is cut anew: behind each such quote."""
_PRINTED: Final = re.compile(f"[{''.join(CURLY)}]")


def requoted(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return tokens with quotes that have no partner cut off where their names probably end; the very same if none.

    At most `MAX_TOKENS` are returned. What is left of such a quote is a token `UNCLOSED`: with the name, or the quote
    alone if there is none.
    """
    if not any(token.type == "UNCLOSED" for token in tokens):
        return tokens
    lines = groupby(tokens, key=lambda token: token.type == "NEWLINE")
    found = (token for is_end, line in lines for token in (line if is_end else _line(list(line))))
    return list(islice(found, MAX_TOKENS))


def without_lone(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return tokens without quotes that open nothing; the very same if there are none."""
    if not any(is_lone(token) for token in tokens):
        return tokens
    return [token for token in tokens if not is_lone(token)]


def is_lone(token: Token) -> bool:
    """Return whether a token is a quote that neither opens nor closes a name."""
    return token.type == "UNCLOSED" and token.text == '"'


def _line(tokens: Sequence[Token]) -> Iterator[Token]:
    """Yield the tokens of a line, cut anew from the first quote that has no partner."""
    n_cuts = 0 if tokens[-1].span.end - tokens[0].span.start <= _MAX_SIZE else _MAX_CUTS
    while n_cuts < _MAX_CUTS and len(tokens) <= _MAX_LINE and (at := _without_partner(tokens)) is not None:
        yield from tokens[:at]
        start, text = tokens[at].span.start, _text(tokens[at:])
        size = _size(text)
        yield Token("UNCLOSED", text[:size], Span(start, start + size))
        tokens = list(scanned(text[size:], start + size))
        n_cuts += 1
    yield from tokens


def _without_partner(tokens: Sequence[Token]) -> int | None:
    """Return where the first quote is that has no partner; those behind it may be paired the wrong way round."""
    last = next((at for at, token in enumerate(tokens) if token.type == "UNCLOSED"), None)
    if last is None:
        return None
    first = next((at + 1 for at in range(last - 1, -1, -1) if tokens[at].type in ENDS_PARENTHESES), 0)
    odd = (at for at in range(first, last) if tokens[at].type == "STRING" and _is_odd(tokens[at].text[1:-1]))
    return next(odd, last)


def _is_odd(inside: str) -> bool:
    """Return whether what stands between two quotes is rather what stands between two quoted names."""
    return inside != inside.strip()


def _size(text: str) -> int:
    """Return how much of a text that begins with a quote is the name that it opens, with the quote."""
    if not re.match(r'"[^\s(){}|;:,=#]', text):
        return 1
    printed = _PRINTED.search(text)
    ending = ENDS_NAME.search(text, 1)
    end = len(text) if ending is None else ending.start()
    return printed.end() if printed is not None and printed.start() < end else max(end, 1)


def _text(tokens: Sequence[Token]) -> str:
    """Return the text of tokens of one line, whatever stands between them as spaces."""
    pieces, end = [], tokens[0].span.start
    for token in tokens:
        pieces += [" " * (token.span.start - end), token.text]
        end = token.span.end
    return "".join(pieces)
