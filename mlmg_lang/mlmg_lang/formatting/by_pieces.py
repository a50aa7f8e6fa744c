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
from mlmg_lang.formatting.line_changes import line_changes, line_end_of, with_line_ends
from mlmg_lang.formatting.pieces import statements
from mlmg_lang.formatting.printing import Printer
from mlmg_lang.formatting.reading import read_lines
from mlmg_lang.formatting.words import Words, words_of
from mlmg_lang.parsing.layout import lay_out
from mlmg_lang.parsing.lookalikes import has_other_comments
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Edit, Source

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
    _line_end: str
    _sound: dict[tuple[str, ...], bool] = field(default_factory=dict)
    _changes: dict[tuple[str, bool], Sequence[Edit]] = field(default_factory=dict)

    def changes(self, number: int) -> Sequence[Edit]:
        """Return what makes a piece into its canonical form; places are counted from its beginning."""
        text, starts = self._texts
        is_first = number == 0  # there is no empty line before it, then
        known = text[starts[number] : starts[number + 1]], is_first
        if known not in self._changes:
            self._changes[known] = self._found(*known)
        return self._changes[known]

    def _found(self, text: str, is_first: bool) -> Sequence[Edit]:
        source = Source(text)
        tokens = tokenize(source)
        layout, strays = read_lines(tokens)
        written = Printer(source, tokens, layout, self._words, self._sound, strays).script()
        is_parted = not is_first and bool(written) and tokens[0].type == "NEWLINE"
        after = f"\n{written}" if is_parted else written
        return line_changes(source, with_line_ends(after, self._line_end))


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
    line_end = line_end_of(made.source)
    same = previous is not None and (previous._words, previous._line_end) == (words, line_end)
    changes = previous._changes if previous and same and len(previous._changes) <= _MOST_KEPT * len(forms) else {}
    reaches = [form.reach for form in forms if form.reach is not _Reach.NONE]
    alone = _Reach.ALL not in reaches and len(reaches) < 2
    return Forms(alone, (made.source.text, tuple(made.places.starts)), forms, words, line_end, sound, changes)


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
