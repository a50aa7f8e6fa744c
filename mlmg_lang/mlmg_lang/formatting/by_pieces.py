"""A script in pieces -> each in canonical form, as `format_source` writes it; what has not changed is kept.

A piece is written the same by itself, given what the script defines. It is not where parentheses or braces without a
partner make others be kept as written, or a `;` that stands first: then the whole has to be written.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import Statement, WholeBlock
from mlmg_lang.diagnostics import has_errors
from mlmg_lang.formatting.pieces import statements
from mlmg_lang.formatting.printing import Printer
from mlmg_lang.formatting.reading import read_lines
from mlmg_lang.formatting.words import Words, words_of
from mlmg_lang.parsing.layout import lay_out
from mlmg_lang.parsing.lookalikes import has_other_comments
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source

_NO_WORDS = Words(frozenset(), False)
_MOST_KEPT = 4
"""So many times as many texts as there are pieces are kept."""


class _Reach(Enum):
    """What other pieces may be written otherwise because of one: none, those that have the same trouble, or all."""

    NONE = 0
    ALIKE = 1
    ALL = 2


@dataclass(frozen=True, slots=True)
class _Form:
    piece: Statement
    words: Words
    reach: _Reach


@dataclass(frozen=True, slots=True)
class Forms:
    """The pieces of a script, ready to be written.

    Attributes
    ----------
    alone : whether each is written by itself as in the whole.
    """

    alone: bool
    _texts: tuple[str, Sequence[int]]
    _forms: Sequence[_Form]
    _words: Words
    _sound: dict[tuple[str, ...], bool] = field(default_factory=dict)
    _written: dict[str, str] = field(default_factory=dict)

    def text(self, number: int) -> str:
        """Return a piece as it is."""
        text, starts = self._texts
        return text[starts[number] : starts[number + 1]]

    def written(self, number: int) -> str:
        """Return a piece as it is to be, with the empty line before it if there is to be one."""
        text = self.text(number)
        if text not in self._written:
            self._written[text] = self._print(text)
        written, tokens = self._written[text], self._forms[number].piece.tokens
        parted = number > 0 and bool(written) and tokens[0].type == "NEWLINE"
        return f"\n{written}" if parted else written

    def _print(self, text: str) -> str:
        source = Source(text)
        tokens = tokenize(source)
        layout, strays = read_lines(tokens)
        return Printer(source, tokens, layout, self._words, self._sound, strays).script()


def forms_of(analysis: Analysis, previous: Forms | None = None) -> Forms:
    """Return the pieces of a script, ready to be written.

    Parameters
    ----------
    previous : of an earlier text of the same script: what is known from it is taken over.
    """
    made = analysis.made
    kept = {id(form.piece): form for form in (previous._forms if previous else ())}
    forms = [kept.get(id(piece)) or _form(piece) for piece in made.pieces]
    words = _all_words(form.words for form in forms)
    sound = previous._sound if previous else {}
    same = previous is not None and previous._words == words and len(previous._written) <= _MOST_KEPT * len(forms)
    written = previous._written if previous and same else {}
    reaches = [form.reach for form in forms if form.reach is not _Reach.NONE]
    alone = _Reach.ALL not in reaches and len(reaches) < 2
    return Forms(alone, (made.source.text, tuple(made.places.starts)), forms, words, sound, written)


def _form(piece: Statement) -> _Form:
    types = {token.type for token in piece.tokens}
    words = words_of(statements(lay_out(piece.tokens).items)) if types & {"LET", "USE"} else _NO_WORDS
    return _Form(piece, words, _reach(piece, types))


def _reach(piece: Statement, types: set[str]) -> _Reach:
    first = next((token.type for token in piece.tokens if token.type not in ("NEWLINE", "COMMENT")), "")
    if first == "SEMICOLON" or has_other_comments(piece.tokens):
        return _Reach.ALL
    if not _is_wrong(piece) or types.isdisjoint(("LEFT", "RIGHT", "OPEN", "CLOSE")):
        return _Reach.NONE
    return _Reach.ALIKE if types.isdisjoint(("OPEN", "CLOSE")) else _Reach.ALL


def _is_wrong(piece: Statement) -> bool:
    """Return whether some of a piece may be kept as written."""
    if isinstance(piece, WholeBlock):
        return has_errors(piece.told_as_whole) or any(map(_is_wrong, piece.lines))
    return bool(piece.misread) or piece.broken


def _all_words(parts: Iterable[Words]) -> Words:
    some = [words for words in parts if words is not _NO_WORDS]
    return Words(frozenset().union(*(words.defined for words in some)), any(words.uses for words in some))
