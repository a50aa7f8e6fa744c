"""An analysis -> what each token of its text is to a reader, by what the names mean in the library.

The grammar's roles say what a name is for; the library and the script's definitions, what it means. Both are found
piece by piece, by its text alone, and kept for the next text: places are counted from where a piece begins.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import pairwise
from types import MappingProxyType
from typing import Final

from mlmg_grammar.roles import Role, roles
from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import WholeBlock
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.structure import is_sub
from mlmg_lang.parsing.syntax import Name
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.pieces import Piece
from mlmg_lang.planning.names import Kind as LibraryKind
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal


class Kind(StrEnum):
    """What a token is; `NAME` where no library says what it means."""

    MOTION = "motion"
    TAG = "tag"
    NAME = "name"
    GRAPH = "graph"
    DEFINITION = "definition"
    PARAMETER = "parameter"
    KEYWORD = "keyword"
    NUMBER = "number"
    UNIT = "unit"
    STRING = "string"
    COMMENT = "comment"


@dataclass(frozen=True, slots=True)
class Mark:
    """What a stretch of text is.

    Attributes
    ----------
    declaration : whether it is defined here.
    """

    span: Span
    kind: Kind
    declaration: bool = False


@dataclass(frozen=True, slots=True)
class Painted:
    """The marks of a piece, places counted from its beginning; `names`: what was looked up for them, in NFC."""

    text: str
    marks: tuple[Mark, ...]
    names: frozenset[str]


@dataclass(frozen=True, slots=True)
class Painting:
    """The marks of a text, in pieces: pieces of one text, here or before an edit, are one object.

    Attributes
    ----------
    starts : where the pieces begin; last, where the text ends.
    """

    parts: tuple[Painted, ...]
    starts: Sequence[int]
    _against: _Meanings

    def marks(self) -> Iterator[Mark]:
        """Yield all marks, in the order of the text."""
        for start, part in zip(self.starts, self.parts, strict=False):
            yield from (_further(mark, start) for mark in part.marks)

    def within(self, span: Span) -> Iterator[Mark]:
        """Yield the marks that touch a stretch of the text."""
        at = max(0, bisect_right(self.starts, span.start) - 1)
        while at < len(self.parts) and self.starts[at] < span.end:
            moved = (_further(mark, self.starts[at]) for mark in self.parts[at].marks)
            yield from (mark for mark in moved if mark.span.start < span.end and mark.span.end > span.start)
            at += 1


def paint(analysis: Analysis, previous: Painting | None = None) -> Painting:
    """Return what the tokens of a script are. Whatever it says, this does not fail.

    Parameters
    ----------
    previous : of an earlier text of the same script, if there is one: what an edit has left alone is taken from it.
    """
    made = analysis.made
    against = _Meanings(analysis.question.names, frozenset(made.gathered.definitions.lets))
    if previous is not None and previous._against == against:
        against = previous._against
    kept = _kept(previous, against)
    parts = []
    for piece, (start, end) in zip(made.pieces, pairwise(made.places.starts), strict=True):
        text = made.source.text[start:end]
        if text not in kept:
            kept[text] = _painted(text, piece, against)
        parts.append(kept[text])
    return Painting(tuple(parts), tuple(made.places.starts), against)


@dataclass(frozen=True, slots=True)
class _Meanings:
    """What decides what names mean; what was asked is kept."""

    names: Names | None
    lets: frozenset[str]
    _known: dict[tuple[str, bool, Role], Kind] = field(default_factory=dict, compare=False)

    def of(self, name: Name, role: Role) -> Kind:
        """Return what a name is."""
        key = (name.text, name.quoted, role)
        if key not in self._known:
            self._known[key] = self._of(name, role)
        return self._known[key]

    def _of(self, name: Name, role: Role) -> Kind:
        if role is not Role.GRAPH and normal(name.text) in self.lets:
            return Kind.DEFINITION
        if self.names is None:
            return _UNREAD.get(role, Kind.NAME)
        if role in _UNREAD:
            return Kind.GRAPH if is_sub(name) or self.names.graph(name.text) is not None else _UNREAD[role]
        return _of_motions(name.text, self.names)


def _of_motions(name: str, names: Names) -> Kind:
    """Return what a name is that stands for motions; a graph's cannot, but is known."""
    matches = (names.find_unqualified(graph, name) for graph in names.graphs)
    match = next((one for one in matches if one is not None), None)
    if match is not None:
        return Kind.MOTION if match.entry.kind is LibraryKind.MOTION else Kind.TAG
    return Kind.GRAPH if names.graph(name) is not None else Kind.NAME


_UNREAD: Final[Mapping[Role, Kind]] = MappingProxyType({Role.GRAPH: Kind.GRAPH, Role.CALL: Kind.DEFINITION})
"""What a name is for its place alone."""

_KINDS: Final[Mapping[Role, Kind]] = MappingProxyType(
    {
        Role.COMMENT: Kind.COMMENT,
        Role.DECLARATION: Kind.KEYWORD,
        Role.IMPORT: Kind.KEYWORD,
        Role.STATEMENT: Kind.KEYWORD,
        Role.JOINER: Kind.KEYWORD,
        Role.CLAUSE: Kind.KEYWORD,
        Role.RESERVED: Kind.KEYWORD,
        Role.NUMBER: Kind.NUMBER,
        Role.UNIT: Kind.UNIT,
    }
)
"""What a token is that is no name."""


def _kept(previous: Painting | None, against: _Meanings) -> dict[str, Painted]:
    """Return, by the text of its piece, what is still right of an earlier painting."""
    if previous is None:
        return {}
    before = previous._against
    if before.names is not against.names:
        return {}
    changed = before.lets ^ against.lets
    return {part.text: part for part in previous.parts if changed.isdisjoint(part.names)}


def _painted(text: str, piece: Piece | WholeBlock, against: _Meanings) -> Painted:
    marks: list[Mark] = []
    names: set[str] = set()
    parameters = _parameters(piece.tokens)
    before = ""
    for token, role in roles(piece.tokens):
        span = token.span.shifted(-piece.address)
        if token.type == "STRING" and before == "USE":
            marks.append(Mark(span, Kind.STRING))
        elif token.type in NAMES and role is not Role.UNIT:
            name = name_from_token(token)
            names.add(normal(name.text))
            marks.append(_named(name, role, span, parameters.get(token.span.start, {}), against))
        elif token.type == "UNCLOSED":
            marks.append(Mark(span, Kind.STRING))
        elif role in _KINDS:
            marks.append(Mark(span, _KINDS[role]))
        before = token.type
    return Painted(text, tuple(marks), frozenset(names))


def _named(name: Name, role: Role, span: Span, parameters: Mapping[str, int], against: _Meanings) -> Mark:
    """Return the mark of a name; `parameters`: those of its definition, each with where it is declared."""
    if role is Role.DEFINED:
        return Mark(span, Kind.DEFINITION, declaration=True)
    if role is Role.PARAMETER or (role is not Role.GRAPH and normal(name.text) in parameters):
        at = parameters.get(normal(name.text))
        return Mark(span, Kind.PARAMETER, declaration=at == span.start)
    return Mark(span, against.of(name, Role.NAME if role is Role.QUOTED else role))


def _parameters(tokens: Sequence[Token]) -> dict[int, Mapping[str, int]]:
    """Return, by the beginning of each token of a definition, its parameters and where they are declared."""
    if all(token.type != "LET" for token in tokens):
        return {}
    first = tokens[0].span.start
    lines = (line for line in _lines(lay_out(tokens).items) if line[0].type == "LET")
    found = ((line, _declared(line, first)) for line in lines)
    return {token.span.start: declared for line, declared in found for token in line}


def _lines(items: Sequence[Line | Block]) -> Iterator[tuple[Token, ...]]:
    for item in items:
        if isinstance(item, Line):
            yield item.tokens
        else:
            yield from (line for branch in item.branches for line in _lines(branch))


def _declared(line: Sequence[Token], first: int) -> dict[str, int]:
    """Return the parameters in the head of a definition, with their places from the first token of the piece."""
    declared: dict[str, int] = {}
    for (token, role), before in zip(roles(line[2:]), line[1:], strict=False):
        if token.type == "RIGHT" or (token.type == "EQUALS" and not declared):
            break
        if before.type in ("LEFT", "COMMA") and token.type in ("NAME", "UNIT") and role is not Role.UNIT:
            declared.setdefault(normal(token.text), token.span.start - first)
    return declared


def _further(mark: Mark, distance: int) -> Mark:
    return Mark(mark.span.shifted(distance), mark.kind, mark.declaration)
