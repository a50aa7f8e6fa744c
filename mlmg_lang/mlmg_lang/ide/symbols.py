"""An analysis -> what its script consists of: an outline of one, and the definitions of several to search in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import chain
from typing import Final

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import Statement
from mlmg_lang.ide.fuzzy import matching
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Source, Span

_LONGEST: Final = 60
"""In code points, of what a line of an outline says."""


class Kind(StrEnum):
    """What a symbol is."""

    DEFINITION = "definition"
    PARAMETER = "parameter"
    FILE = "file"
    BLOCK = "block"
    BRANCH = "branch"
    COMMAND = "command"


@dataclass(frozen=True, slots=True)
class Symbol:
    """A line of an outline.

    Attributes
    ----------
    detail : a few words more, or none.
    span : of all of it. selection : of what to show of it, inside `span`.
    children : what is in it, in the order of the text.
    """

    name: str
    detail: str
    kind: Kind
    span: Span
    selection: Span
    children: tuple[Symbol, ...] = ()


@dataclass(frozen=True, slots=True)
class Found:
    """A symbol, and the name of the file that it is in."""

    symbol: Symbol
    file: str


def document_symbols(analysis: Analysis) -> tuple[Symbol, ...]:
    """Return the outline of a script: its definitions, used files, blocks and commands. What is broken is left out."""
    made = analysis.made
    outline: list[Symbol] = []
    for piece, start in zip(made.pieces, made.places.starts, strict=False):
        outline += _Outliner(made.source, start - piece.address).items(piece.items)
    return tuple(outline)


def piece_symbols(piece: Statement, text: str) -> tuple[Symbol, ...]:
    """Return what of an outline is in a piece, with places counted from its beginning; `text`: of the piece."""
    return tuple(_Outliner(Source(text), -piece.address).items(piece.items))


@dataclass(frozen=True, slots=True)
class LibraryName:
    """A tag or a motion of a library."""

    name: str
    is_tag: bool


def workspace_symbols(
    analyses: Iterable[Analysis], query: str, libraries: Iterable[LibraryName] = (), most: int | None = None
) -> list[Found | LibraryName]:
    """Return the definitions of several scripts whose names have the letters of a query, the likeliest first.

    A file that several of the scripts are, or use, is listed once.

    Parameters
    ----------
    libraries : further names to look among. most : so many at most, the likeliest.
    """
    defined = ((analysis, let) for analysis in analyses for let in analysis.made.gathered.definitions.lets.values())
    named: Iterable[tuple[Analysis, syntax.Let] | LibraryName] = chain(defined, libraries)
    once: dict[object, Found | LibraryName] = {}
    for one in matching(query, named, lambda one: one.name if isinstance(one, LibraryName) else one[1].name.text):
        found = one if isinstance(one, LibraryName) else _defined(*one)
        key = found if isinstance(found, LibraryName) else (found.file, found.symbol.selection)
        once.setdefault(key, found)
        if most is not None and len(once) >= most:
            break
    return list(once.values())


def _defined(analysis: Analysis, addressed: syntax.Let) -> Found:
    """Return a definition of a script; places are counted from the beginning of the file that it is in."""
    source, let = analysis.source, analysis.made.now(addressed)
    file, base = source.file(let.span.start)
    return Found(_Outliner(source, -base, base).let(let), file.name)


@dataclass(frozen=True, slots=True)
class _Outliner:
    """Makes symbols of items whose places are `further` on; of the text, `base` on from these."""

    source: Source
    further: int
    base: int = 0

    def items(self, items: Iterable[syntax.Item]) -> Iterator[Symbol]:
        for item in items:
            if not isinstance(item, syntax.Broken):
                yield self._item(item)

    def _item(self, item: syntax.Item) -> Symbol:
        match item:
            case syntax.Let():
                return self.let(item)
            case syntax.Use(path):
                return Symbol(path.text, "use", Kind.FILE, self._at(item), self._at(path))
            case syntax.Repeat(head, body):
                children = tuple(self.items(body))
                return Symbol(self._text(head), "", Kind.BLOCK, self._at(item), self._at(head), children)
            case syntax.Choose(head, branches):
                children = tuple(self._branch(n, branch) for n, branch in enumerate(branches, start=1))
                return Symbol(self._text(head), "", Kind.BLOCK, self._at(item), self._at(head), children)
        return Symbol(self._text(item), "", Kind.COMMAND, self._at(item), self._at(item))

    def let(self, let: syntax.Let) -> Symbol:
        """Return the symbol of a definition, with its parameters."""
        parameters = tuple(
            Symbol(one.name.text, self._default(one), Kind.PARAMETER, self._at(one), self._at(one.name))
            for one in let.parameters or ()
        )
        detail = self._text(let.command)
        return Symbol(let.name.text, detail, Kind.DEFINITION, self._at(let), self._at(let.name), parameters)

    def _default(self, parameter: syntax.Parameter) -> str:
        return "" if parameter.default is None else f"= {self._text(parameter.default)}"

    def _branch(self, number: int, branch: syntax.Branch) -> Symbol:
        weight = "" if branch.weight is None else f"weight {branch.weight.number}"
        span = self._at(branch)
        return Symbol(f"branch {number}", weight, Kind.BRANCH, span, span, tuple(self.items(branch.body)))

    def _at(self, node: syntax.Node) -> Span:
        return node.span.shifted(self.further)

    def _text(self, node: syntax.Node) -> str:
        at = self._at(node)
        said = self.source.slice(at.shifted(self.base))
        line = " ".join(said.split())
        return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3].rstrip()}..."
