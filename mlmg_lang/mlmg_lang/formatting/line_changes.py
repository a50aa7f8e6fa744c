"""A text and the same in canonical form -> the stretches of whole lines that differ, each as small as can be.

Formatting leaves the words of a text in their order. So both may be cut between the same two words, or comments, where
both have a line end there: each stretch can then take its new form without the others, and the script says the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Final, TypeAlias

from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.source import Source, Span

_NO_WORDS: Final = frozenset({"NEWLINE", "SEMICOLON", "COMMENT"})
_Place: TypeAlias = tuple[int, int, bool]
"""How many words and comments stand before a line end, and whether a `;` that has to stay stands right before it."""


@dataclass(frozen=True, slots=True)
class Change:
    """A stretch of a text, and what is to take its place."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class _LineEnd:
    """Where a line begins, and how many of those at the same place come before it that are not taken out with a `;`."""

    offset: int
    number: int


def line_changes(before: Source, after: str) -> list[Change]:
    """Return what makes a text into its canonical form, in order; each change can be made by itself.

    Parameters
    ----------
    after : the canonical form; line ends may be others.
    """
    if before.text == after:
        return []
    found = pairwise(_cuts(before, after))
    changes = (Change(Span(start, end), after[begin:stop]) for (start, begin), (end, stop) in found)
    return [one for one in changes if before.slice(one.span) != one.text]


def changes_within_lines(before: Source, change: Change) -> list[Change]:
    """Return what of a change leaves lines and their indentation as they are: words, and the spaces between them.

    That can be made line by line where the change as a whole joins lines.
    """
    text = before.slice(change.span)
    old, new = tokenize(Source(text)), tokenize(Source(change.text))
    if _words(old) != _words(new):
        return []
    spans = iter([token.span for token in new if _is_word(token)])
    found = []
    for words in _lines(old):
        places = [next(spans) for _ in words]
        written = change.text[places[0].start : places[-1].end]
        if len(Source(written).line_starts) == 1:
            start = change.span.start
            found.append(Change(Span(start + words[0].span.start, start + words[-1].span.end), written))
    return [one for one in found if before.slice(one.span) != one.text]


def line_end_of(source: Source) -> str:
    """Return how the lines of a text end: CRLF if its first one does, else LF."""
    first = source.line_starts[1] if len(source.line_starts) > 1 else 0
    return "\r\n" if source.text[max(first - 2, 0) : first] == "\r\n" else "\n"


def with_line_ends(text: str, line_end: str) -> str:
    """Return a text whose lines end in LF, or CRLF, with such line ends."""
    return text if line_end == "\n" else text.replace("\r\n", "\n").replace("\n", line_end)


def _cuts(before: Source, after: str) -> Iterator[tuple[int, int]]:
    """Yield where both texts may be cut, their beginnings and ends too."""
    yield 0, 0
    if before.line_starts[1:2] not in ((), (len(before.text),)):
        for end, begin in _cuts_inside(tokenize(before), tokenize(Source(after))):
            # A CR and the LF of an empty line below it would be one line end.
            if before.text[end - 1 : end] != "\r" or after[begin : begin + 1] != "\n":
                yield end, begin
    yield len(before.text), len(after)


def _cuts_inside(old: Sequence[Token], new: Sequence[Token]) -> Iterator[tuple[int, int]]:
    if _words(old) != _words(new):  # quotes without a partner may have joined other words
        return
    stay = _before_semicolons(new)
    ends = _line_ends(new, stay)
    for place, olds in _line_ends(old, stay).items():
        if place in ends:
            news = ends[place]
            # Of empty lines the first stay.
            yield from ((one.offset, news[min(one.number, len(news) - 1)].offset) for one in olds)


def _is_word(token: Token) -> bool:
    return token.type not in _NO_WORDS


def _lines(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the words of each line that has some."""
    for is_end, line in groupby(tokens, lambda token: token.type == "NEWLINE"):
        words = [] if is_end else [token for token in line if _is_word(token)]
        if words:
            yield words


def _words(tokens: Sequence[Token]) -> list[str]:
    """Return of what kind the words are, as far as formatting leaves that as it is."""
    kinds = (token.type for token in tokens if _is_word(token))
    return ["NAME" if kind in NAMES else "NUMBER" if kind in NUMBERS else kind for kind in kinds]


def _before_semicolons(tokens: Sequence[Token]) -> set[int]:
    """Return how many words stand before each `;`."""
    found: set[int] = set()
    n_words = 0
    for token in tokens:
        if token.type == "SEMICOLON":
            found.add(n_words)
        n_words += _is_word(token)
    return found


def _line_ends(tokens: Sequence[Token], stay: set[int]) -> dict[_Place, list[_LineEnd]]:
    """Return the line ends at each place, and the beginning of the text, which is like one.

    Parameters
    ----------
    stay : behind how many words a `;` has to stay.
    """
    found: dict[_Place, list[_LineEnd]] = {(0, 0, False): [_LineEnd(0, 0)]}
    n_words = n_comments = 0
    parted = False
    before = ""  # of the line
    for token in tokens:
        match token.type:
            case "NEWLINE":
                ends = found.setdefault((n_words, n_comments, parted), [])
                goes = before == "SEMICOLON" and not parted
                ends.append(_LineEnd(token.span.end, ends[-1].number + (not goes) if ends else 0))
                before = ""
                continue
            case "COMMENT":
                n_comments += 1
            case "SEMICOLON":
                parted = n_words in stay
            case _:
                n_words, parted = n_words + 1, False
        before = before or token.type
    return found
