"""The names in a script and in the files that it uses: where each stands, and what it stands for.

A script is asked statement by statement, and what does not hold a name is not looked at: there may be very many.
What is given out has offsets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.statements import Statement, statements_at, statements_naming
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.structure import SUB, is_sub
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import NAMES
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import normal


class Sort(StrEnum):
    """What a name stands for; `UNKNOWN`: for nothing, as far as that can be told."""

    DEFINITION = "definition"
    PARAMETER = "parameter"
    MOTION = "motion"
    TAG = "tag"
    GRAPH = "graph"
    SUB = "sub"
    FILE = "file"
    UNKNOWN = "unknown"


RENAMED: Final = frozenset({Sort.DEFINITION, Sort.PARAMETER})
"""What a script itself gives names to."""


@dataclass(frozen=True, slots=True)
class Symbol:
    """What a name stands for.

    Attributes
    ----------
    name : in NFC; of a library, as that spells it; of a file, its path as written.
    owner : of a parameter, the definition that it belongs to.
    """

    sort: Sort
    name: str
    owner: str = ""


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A name where it stands.

    Attributes
    ----------
    declares : whether it gets its meaning here.
    label : whether it says which parameter an argument is for.
    use : the use of a definition that it is the name of, with addresses.
    broken : whether its statement could not be read, so that it only seems to stand for that.
    """

    span: Span
    symbol: Symbol
    declares: bool = False
    label: bool = False
    use: syntax.Reference | syntax.Call | None = None
    broken: bool = False


@dataclass(frozen=True, slots=True)
class Place:
    """A stretch of a file; offsets count from the beginning of that."""

    file: str
    span: Span


def place_of(source: Source, span: Span) -> Place:
    """Return where a span is, counted in its own file."""
    file, base = source.file(span.start)
    return Place(file.name, span.shifted(-base))


def occurrence_at(analysis: Analysis, offset: int) -> Occurrence | None:
    """Return the name that an offset is in or at an end of; of two that touch, the one that begins there."""
    read = reader_of(analysis)
    found = [
        one
        for statement in statements_at(analysis.made, offset)
        for one in read(statement)
        if one.span.start <= offset <= one.span.end
    ]
    return max(found, key=lambda one: (one.span.start, -one.span.end), default=None)


def occurrences_of(analysis: Analysis, symbol: Symbol) -> Iterator[Occurrence]:
    """Yield where something is named, in the order of the text, then in the files that are used."""
    read, last = reader_of(analysis), None
    # A parameter is named in its definition, and where that is used.
    hint = Symbol(Sort.DEFINITION, symbol.owner) if symbol.sort is Sort.PARAMETER else symbol
    for statement in statements_naming(analysis.made, hint.name, defined=hint.sort in RENAMED):
        if statement.item is not last:
            last = statement.item
            yield from (one for one in read(statement) if one.symbol == symbol)


def reader_of(analysis: Analysis) -> Callable[[Statement], Iterator[Occurrence]]:
    """Return what yields the names in a statement, those too of one that could not be read."""
    lets, names = analysis.made.gathered.definitions.lets, analysis.question.names
    known: dict[str, Symbol] = {}
    return lambda statement: _Reader(lets, names, known, statement).item(statement.item)


# --- what names stand for --------------------------------------------------------------------------------


def _naming(node: syntax.Node) -> Iterator[syntax.Node]:
    """Yield the nodes of a command or an expression that may hold names, as `syntax.walk` does, but sooner."""
    waiting = [node]
    while waiting:
        part = waiting.pop()
        match part:
            case syntax.Reference() | syntax.Wait():
                yield part
            case syntax.Command(motion) | syntax.Qualified(motion=motion):
                yield part
                waiting.append(motion)
            case syntax.Call(arguments=arguments):
                yield part
                waiting.extend(argument.value for argument in reversed(arguments))
            case syntax.With(operands) | syntax.And(operands) | syntax.Or(operands):
                waiting.extend(reversed(operands))
            case syntax.Group(inner) | syntax.Not(inner):
                waiting.append(inner)


@dataclass(frozen=True, slots=True)
class _Reader:
    """Reads the names of a statement. `known`: what has been found out of those of the library."""

    lets: Mapping[str, syntax.Let]
    names: Names | None
    known: dict[str, Symbol]
    statement: Statement

    def item(self, item: syntax.Item) -> Iterator[Occurrence]:
        match item:
            case syntax.Let():
                yield from self._let(item)
            case syntax.Use(path):
                yield self._one(path, Symbol(Sort.FILE, path.text))
            case syntax.End(graph):
                yield self._one(graph, self._graph(graph))
            case syntax.Broken():
                yield from self._broken(item)
            case _:
                yield from self._uses(item, frozenset(), "")

    def _let(self, let: syntax.Let) -> Iterator[Occurrence]:
        owner = normal(let.name.text)
        # What cannot be a name is not defined.
        yield self._one(let.name, Symbol(Sort.DEFINITION if owner in self.lets else Sort.UNKNOWN, owner), declares=True)
        for parameter in let.parameters or ():
            name = normal(parameter.name.text)
            yield self._one(parameter.name, Symbol(Sort.PARAMETER, name, owner), declares=True)
            if parameter.default is not None:
                yield from self._uses(parameter.default, frozenset(), "")
        own = frozenset(normal(parameter.name.text) for parameter in let.parameters or ())
        yield from self._uses(let.command, own, owner)

    def _uses(self, node: syntax.Node, own: frozenset[str], owner: str) -> Iterator[Occurrence]:
        """Yield the names in commands and expressions; `own`: the parameters of the definition that they are in."""
        for part in _naming(node):
            match part:
                case syntax.Reference(name):
                    yield self._used(part, name, own, owner)
                case syntax.Call(name):
                    yield self._used(part, name, own, owner)
                    yield from self._labels(part)
                case syntax.Qualified(graph):
                    yield self._one(graph, self._graph(graph))
                case syntax.Command(duration=syntax.Name() as name) | syntax.Wait(syntax.Name() as name):
                    known = normal(name.text) in own
                    yield self._one(name, Symbol(Sort.PARAMETER if known else Sort.UNKNOWN, normal(name.text), owner))

    def _used(
        self, use: syntax.Reference | syntax.Call, name: syntax.Name, own: frozenset[str], owner: str
    ) -> Occurrence:
        word = normal(name.text)
        if word in own:
            return self._one(name, Symbol(Sort.PARAMETER, word, owner))
        if word in self.lets:
            return self._one(name, Symbol(Sort.DEFINITION, word), use=use)
        return self._one(name, self._graph(name) if isinstance(use, syntax.Call) else self._motion(name))

    def _labels(self, use: syntax.Call) -> Iterator[Occurrence]:
        """Yield the names of arguments."""
        owner = normal(use.name.text)
        let = self.lets.get(owner)
        known = {normal(parameter.name.text) for parameter in (let.parameters if let else None) or ()}
        for argument in use.arguments:
            if argument.name is not None and normal(argument.name.text) in known:
                symbol = Symbol(Sort.PARAMETER, normal(argument.name.text), owner)
                yield self._one(argument.name, symbol, label=True)

    def _broken(self, item: syntax.Broken) -> Iterator[Occurrence]:
        """Yield the names of a statement that could not be read; which is whose parameter, is not known."""
        text = self.statement.source.slice(self.statement.at(item.span))
        for token in tokenize(Source(text)):
            if token.type in NAMES:
                span = token.span.shifted(item.span.start)
                name = name_from_token(token)
                yield replace(self._one(replace(name, span=span), self._any(name)), broken=True)

    def _any(self, name: syntax.Name) -> Symbol:
        if normal(name.text) in self.lets:
            return Symbol(Sort.DEFINITION, normal(name.text))
        found = self._motion(name)
        return self._graph(name) if found.sort is Sort.UNKNOWN and self.names is not None else found

    def _graph(self, name: syntax.Name) -> Symbol:
        if is_sub(name):
            return Symbol(Sort.SUB, SUB)
        graph = None if self.names is None else self.names.graph(name.text)
        if self.names is not None and graph is None:
            return Symbol(Sort.UNKNOWN, normal(name.text))
        return Symbol(Sort.GRAPH, graph or normal(name.text))

    def _motion(self, name: syntax.Name) -> Symbol:
        if name.text not in self.known:
            self.known[name.text] = self._looked_up(name)
        return self.known[name.text]

    def _looked_up(self, name: syntax.Name) -> Symbol:
        places = () if self.names is None else self.names.places(name.text)
        match = self.names.find_unqualified(places[0], name.text) if self.names is not None and places else None
        if match is None:
            return Symbol(Sort.UNKNOWN, normal(name.text))
        return Symbol(Sort.MOTION if match.entry.kind is Kind.MOTION else Sort.TAG, match.entry.name)

    def _one(
        self,
        name: syntax.Name,
        symbol: Symbol,
        declares: bool = False,
        label: bool = False,
        use: syntax.Reference | syntax.Call | None = None,
    ) -> Occurrence:
        return Occurrence(self.statement.at(name.span), symbol, declares, label, use)
