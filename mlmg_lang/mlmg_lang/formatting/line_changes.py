"""A text and the same in canonical form -> the edits of whole lines between them, each as small as can be.

Formatting leaves the words of a text in their order, and tokens lie within lines. So both texts are read side by side,
and cut where both have a line end and the same words and comments before it: each stretch can then take its new form
without the others, and the script says the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Final

from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.source import Edit, Source, Span

_NO_WORDS: Final = frozenset({"NEWLINE", "SEMICOLON", "COMMENT"})


def line_changes(before: Source, after: str) -> list[Edit]:
    """Return what makes a text into its canonical form, in order; each change can be made by itself.

    Parameters
    ----------
    after : the canonical form; line ends may be others.
    """
    if before.text == after:
        return []
    found = []
    start = begin = 0
    for end, stop in _cuts(before.lines, Source(after).lines):
        if before.text[start:end] != after[begin:stop]:
            found.append(Edit(Span(start, end), after[begin:stop]))
        start, begin = end, stop
    return found


def changes_within_lines(before: Source, change: Edit) -> list[Edit]:
    """Return what of a change leaves lines and their indentation as they are: words, and the spaces between them.

    That can be made line by line where the change as a whole joins lines.
    """
    text = before.slice(change.span)
    old, new = tokenize(Source(text)), [token for token in tokenize(Source(change.replacement)) if _is_word(token)]
    if [_kind(token) for token in old if _is_word(token)] != [_kind(token) for token in new]:
        return []
    spans = iter([token.span for token in new])
    found = []
    for words in _words_by_line(old):
        places = [next(spans) for _ in words]
        written = change.replacement[places[0].start : places[-1].end]
        if len(Source(written).line_starts) == 1:
            start = change.span.start
            found.append(Edit(Span(start + words[0].span.start, start + words[-1].span.end), written))
    return [one for one in found if before.slice(one.span) != one.replacement]


def line_end_of(source: Source) -> str:
    """Return how the lines of a text end: CRLF if its first one does, else LF."""
    first = source.line_starts[1] if len(source.line_starts) > 1 else 0
    return "\r\n" if source.text[max(first - 2, 0) : first] == "\r\n" else "\n"


def with_line_ends(text: str, line_end: str) -> str:
    """Return a text whose lines end in LF, or CRLF, with such line ends."""
    return text if line_end == "\n" else text.replace("\r\n", "\n").replace("\n", line_end)


# --- stretches ---


def _cuts(old: Sequence[str], new: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield where both texts may be cut, up to their ends."""
    end = stop = at = other = 0
    while at < len(old) and other < len(new):
        n_old, n_new = _stretch(old, new, at, other)
        end += sum(map(len, old[at : at + n_old]))
        stop += sum(map(len, new[other : other + n_new]))
        at, other = at + n_old, other + n_new
        # A CR and the LF of an empty line below it would be one line end.
        if not (old[at - 1].endswith("\r") and new[other : other + 1] == ["\n"]):
            yield end, stop
    yield end + sum(map(len, old[at:])), stop + sum(map(len, new[other:]))


def _stretch(old: Sequence[str], new: Sequence[str], at: int, other: int) -> tuple[int, int]:
    """Return how many lines of each text become each other, from two on before which the same has been said."""
    if old[at] == new[other] or _signs(old[at]) == _signs(new[other]):
        return 1, 1
    if not _signs(old[at]).strip(";"):  # of empty lines the first stay
        return 1, 0
    one, like = _Read(old, at), _Read(new, other)
    while not (one.n_lines and like.n_lines and one.says_the_same_as(like)):
        first, second = (one, like) if one.size <= like.size else (like, one)
        if not (first.read() or second.read()):
            break
    return one.n_lines, like.n_lines


def _signs(line: str) -> str:
    return "".join(line.split())


@dataclass(slots=True)
class _Read:
    """What has been read of some lines, from one of them on.

    Attributes
    ----------
    parted : whether a `;` stands behind the last word.
    """

    lines: Sequence[str]
    begin: int
    n_lines: int = 0
    words: list[str] = field(default_factory=list)
    n_comments: int = 0
    parted: bool = False

    @property
    def size(self) -> tuple[int, int, int]:
        """Return how far this is."""
        return len(self.words), self.n_comments, self.n_lines > 0

    def read(self) -> bool:
        """Read one more line, if there is one."""
        if self.begin + self.n_lines == len(self.lines):
            return False
        for token in tokenize(Source(self.lines[self.begin + self.n_lines])):
            self.n_comments += token.type == "COMMENT"
            if _is_word(token):
                self.words.append(_kind(token))
            self.parted = token.type == "SEMICOLON" or (self.parted and not _is_word(token))
        self.n_lines += 1
        return True

    def says_the_same_as(self, canonical: _Read) -> bool:
        """Return whether the same is in both, and what has to be parted from what follows is so."""
        same = self.n_comments == canonical.n_comments and self.words == canonical.words
        return same and (self.parted or not canonical.parted)


def _is_word(token: Token) -> bool:
    return token.type not in _NO_WORDS


def _kind(token: Token) -> str:
    """Return of what kind a word is, as far as formatting leaves that as it is."""
    return "NAME" if token.type in NAMES else "NUMBER" if token.type in NUMBERS else token.type


def _words_by_line(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the words of each line that has some."""
    for is_end, line in groupby(tokens, lambda token: token.type == "NEWLINE"):
        words = [] if is_end else [token for token in line if _is_word(token)]
        if words:
            yield words
