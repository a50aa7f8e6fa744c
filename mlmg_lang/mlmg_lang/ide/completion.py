"""A text, a place in it and what may be playing there -> what could be written there, the best first.

What the grammar accepts comes from the parser itself; which of a library's names are offered, from the stages that
would read the finished statement: the graphs that a `with` leaves, rule 1, and what is playing.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import chain, pairwise
from math import inf
from typing import Final, NamedTuple, Protocol, TypeAlias

from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.ide.cursor import Cursor, cursor_at
from mlmg_lang.ide.words import WORDS
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.line_parser import accepted, read
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.names import Entry, Kind, Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.planning.select import select
from mlmg_lang.planning.typed import Layering
from mlmg_lang.source import Source, Span

_NAMES: Final = frozenset({"NAME", "STRING", "UNIT"})
_UNITS: Final = ("sec", "ms", "min", "frames", "cycles")
_STATEMENT_WORDS: Final = frozenset({"WAIT", "END", "REPEAT", "CHOOSE", "LET", "USE"})
_TOP_LEVEL: Final = frozenset({"LET", "USE"})


Below: TypeAlias = tuple[str, Collection[str]]
"""A graph that could be named, and what may be played above it then."""


class What(StrEnum):
    """What a completion is."""

    MOTION = "motion"
    TAG = "tag"
    GRAPH = "graph"
    DEFINITION = "definition"
    PARAMETER = "parameter"
    WORD = "word"
    UNIT = "unit"


class Completion(NamedTuple):
    """Something that could be written.

    Attributes
    ----------
    text : as it is written, in quotes if it must be or a quote has been written. name : as it is called.
    graph : that the motions of a name are on, or None.
    motions : that it stands for.
    says : a few words about it.
    """

    text: str
    name: str
    what: What
    graph: str | None = None
    motions: tuple[str, ...] = ()
    says: str = ""


@dataclass(frozen=True, slots=True)
class Offered:
    """What could be written at a place.

    Attributes
    ----------
    span : the stretch that it takes the place of.
    found : the best first.
    fits : by graph, how well its motions go with what is playing; see `Fits`.
    """

    span: Span
    found: tuple[Completion, ...]
    fits: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def fit(self, one: Completion) -> float | None:
        """Return how well the best motion of a completion goes with what is playing; None if that is not known."""
        return None if one.graph is None else _best(one, self.fits[one.graph])


class Fits(Protocol):
    """What goes how well with what is playing."""

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        """Return, by motion of a graph that can be had, how well it fits; the smaller, the better.

        Parameters
        ----------
        above : the motions that the graph above it may play then; of the root, those that it may play itself.
        """


class Ranked(NamedTuple):
    """The names on a graph whose motions can be had, the best first, and how well the motions fit."""

    found: tuple[Completion, ...]
    fits: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Offers:
    """What the names of a library are worth while something is playing. What was asked is kept.

    Attributes
    ----------
    uses : by name, how often it has been used.
    """

    names: Names
    fits: Fits
    uses: Mapping[str, int] = field(default_factory=dict)
    _known: dict[tuple[str, frozenset[str]], Ranked] = field(default_factory=dict)
    _listed: dict[str, tuple[Completion, ...]] = field(default_factory=dict)

    def on(self, graph: str, above: Collection[str]) -> Ranked:
        """Return the names on a graph whose motions can be had, what fits best first, then what is used most."""
        key = (graph, frozenset(above))
        found = self._known.get(key)
        if found is None:
            if graph not in self._listed:
                self._listed[graph] = tuple(_named(entry, graph) for entry in self.names.entries(graph))
            fits = self.fits.fits(graph, above)
            found = self._known[key] = Ranked(self._ranked(self._listed[graph], fits), fits)
        return found

    def _ranked(self, listed: Sequence[Completion], fits: Mapping[str, float]) -> tuple[Completion, ...]:
        best = [_best(one, fits) for one in listed]
        order = [at for at in sorted(range(len(listed)), key=best.__getitem__) if best[at] < inf]
        if self.uses:
            order.sort(key=lambda at: (best[at], -self.uses.get(listed[at].name, 0)))
        return tuple([listed[at] for at in order])


def _named(entry: Entry, graph: str) -> Completion:
    what = What.MOTION if entry.kind is Kind.MOTION else What.TAG
    return Completion(script_name(entry.name), entry.name, what, graph, entry.motions)


def _best(one: Completion, fits: Mapping[str, float]) -> float:
    """Return how well the best motion of a name fits; infinity if none can be had."""
    motions = one.motions
    if len(motions) == 1:
        return fits.get(motions[0], inf)
    return min((fits[motion] for motion in motions if motion in fits), default=inf)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a text is completed against; `state`: what may be playing before the statement."""

    names: Names
    definitions: Definitions
    state: State
    offers: Offers


def complete(tokens: Sequence[Token], offset: int, around: Surroundings) -> Offered:
    """Return what could be written at an offset, the best first.

    Nothing is left out for what has been written of the word: that is up to `fuzzy.matching`.

    Parameters
    ----------
    tokens : of the text, or of the lines around the offset.
    """
    cursor = cursor_at(tokens, offset)
    if cursor is None:
        return Offered(Span(offset, offset), ())
    completer = _Completer(around, cursor)
    found = chain.from_iterable(completer.all())
    return Offered(cursor.span, tuple(_in_quotes(found) if cursor.quoted else found), completer.fits)


def _in_quotes(found: Iterable[Completion]) -> Iterator[Completion]:
    """Yield what can stand in quotes, in quotes: names."""
    for one in found:
        if one.what not in (What.WORD, What.UNIT) and one.name != SUB:
            text = one.text if one.text.startswith('"') else f'"{one.text}"'
            yield Completion(text, *one[1:])


@dataclass(frozen=True, slots=True)
class _Completer:
    """Finds what could be written, in stretches: there may be thousands of names, kept as they are offered."""

    around: Surroundings
    cursor: Cursor
    fits: dict[str, Mapping[str, float]] = field(default_factory=dict)

    def all(self) -> Iterator[Iterable[Completion]]:
        before = self.cursor.before
        types = accepted(before)
        if types is None:
            return
        if before and before[-1].type in ("INTEGER", "DECIMAL"):
            yield (Completion(unit, unit, What.UNIT) for unit in _UNITS if "UNIT" in types)
            return
        if types & _NAMES:
            yield from self._names(before)
        if not before or self._qualifier(_expression(before)) is None or before[-1].type not in _NAMES:
            yield self._words(types)

    # --- words ---

    def _words(self, types: Collection[str]) -> Iterator[Completion]:
        continuing = accepted(self.cursor.last) or frozenset() if self.cursor.last else frozenset()
        for terminal, says in WORDS.items():
            if terminal in _TOP_LEVEL and self.cursor.nested:
                continue
            if terminal in types or (terminal in continuing and terminal not in _STATEMENT_WORDS):
                if terminal == "WITH" and not self._leaves_room(self.cursor.before or self.cursor.last):
                    continue
                yield Completion(terminal.lower(), terminal.lower(), What.WORD, says=says)

    def _leaves_room(self, motion: Sequence[Token]) -> bool:
        """Return whether a `with` behind a motion would leave a graph to speak of."""
        return bool(self._rooms_below(_expression(motion)))

    # --- names ---

    def _names(self, before: tuple[Token, ...]) -> Iterator[Iterable[Completion]]:
        match [token.type for token in before]:
            case ["LET", *rest] if "EQUALS" not in rest:
                return
            case ["USE"]:
                return
            case ["END"]:
                yield self._ends()
            case [*_, "WAIT" | "FOR"]:
                yield self._parameters_of(before)
            case _:
                yield from self._motions(before)

    def _ends(self) -> Iterator[Completion]:
        running = [graph for graph in self.around.names.graphs if graph in self.around.state.parts]
        for graph in running:
            if graph != self.around.names.root:
                motions = tuple(self.around.state.parts[graph].motions)
                yield _graph(graph, f"plays {', '.join(motions)}" if len(motions) == 1 else "runs on its own")

    def _motions(self, before: Sequence[Token]) -> Iterator[Iterable[Completion]]:
        """Yield what could begin or go on with a motion expression."""
        own = _expression(before)
        graph = self._qualifier(own)
        if graph is not None:
            yield self._on(graph, self._above(graph, own))
            return
        if own and own[-1].type in _NAMES | {"RIGHT"}:
            return  # A word comes next.
        left = _left_of_with(own)
        if left is None:
            yield from self._anywhere(before)
            return
        rooms = self._rooms_below(left)
        yield from self._unqualified(rooms, set())
        yield self._parameters_of(before)
        yield self._definitions()
        yield (_graph(graph, _part_says(graph, self.around.names)) for graph, _ in rooms)
        if rooms:
            yield (_graph(SUB, f"the part below: {rooms[0][0]}"),)

    def _anywhere(self, before: Sequence[Token]) -> Iterator[Iterable[Completion]]:
        """Yield what a command may begin with: what the whole body does first, then what parts may do as it is."""
        names = self.around.names
        yield self._on(names.root, self._playing(names.root))
        yield self._parameters_of(before)
        yield self._definitions()
        allowed = [graph for graph in names.all_levels()[1:] if self._playing(graph) & names.motion_set(graph)]
        yield (_graph(graph, _part_says(graph, names)) for graph in allowed)
        rooms = [(graph, self._playing(graph)) for graph in allowed]
        yield from self._unqualified(rooms, set(names.spellings_on(names.root)))

    def _unqualified(self, rooms: Sequence[Below], known: set[str]) -> Iterator[Iterable[Completion]]:
        """Yield the names on some graphs that mean these without a graph's name: each on the first that has it."""
        for number, (graph, above) in enumerate(rooms, start=1):
            own = self._on(graph, above)
            if known:
                own = tuple([one for one in own if one.name not in known])
            yield own
            if number < len(rooms):
                known |= {one.name for one in own}

    def _on(self, graph: str, above: Collection[str]) -> Sequence[Completion]:
        """Return the names on a graph, and note how well its motions fit."""
        found, self.fits[graph] = self.around.offers.on(graph, above)
        return found

    def _parameters_of(self, before: Sequence[Token]) -> Iterator[Completion]:
        return (Completion(script_name(name), name, What.PARAMETER) for name in _parameters(before))

    def _definitions(self) -> Iterator[Completion]:
        for name, let in self.around.definitions.lets.items():
            says = "defined here" if let.parameters is None else f"takes {len(let.parameters)}"
            yield Completion(script_name(name), name, What.DEFINITION, says=says)

    # --- graphs ---

    def _qualifier(self, own: Sequence[Token]) -> str | None:
        """Return the graph whose name stands before the cursor, or before the innermost group around it."""
        depth = 0
        for at in range(len(own) - 1, -1, -1):
            kind = own[at].type
            if kind == "RIGHT":
                depth += 1
            elif kind == "LEFT" and depth:
                depth -= 1
            elif kind == "LEFT" or at == len(own) - 1:
                named = at - 1 if kind == "LEFT" and at else at
                graph = self._graph_of(own[named], own[:named])
                if graph is not None:
                    return graph
            elif kind == "WITH" and not depth:
                return None
        return None

    def _graph_of(self, token: Token, before: Sequence[Token]) -> str | None:
        if token.type not in _NAMES:
            return None
        if token.text != SUB:
            return self.around.names.graph(_plain(token))
        left = _left_of_with(before)
        return None if left is None else next((graph for graph, _ in self._rooms_below(left)), None)

    def _above(self, graph: str, own: Sequence[Token]) -> Collection[str]:
        """Return what may be played above a graph that is named in an expression."""
        left = _left_of_with(own)
        rooms = [] if left is None else self._rooms_below(left)
        return next((above for room, above in rooms if room == graph), self._playing(graph))

    def _playing(self, graph: str) -> frozenset[str]:
        """Return what may drive the graph above one; of the root, what may drive it."""
        parts, names = self.around.state.parts, self.around.names
        above = names.ancestors(graph) or (graph,)
        return next(parts[one].motions for one in above if one in parts)

    def _way(self, motion: Sequence[Token]) -> Layering | None:
        """Return what finished part of a command does."""
        node = read(Source(""), tuple(motion))
        if not isinstance(node, syntax.Command):
            return None
        if any(isinstance(part, syntax.Call) for part in syntax.walk(node)):
            return None
        known = all(self._is_known(part.name) for part in syntax.walk(node) if isinstance(part, syntax.Reference))
        ways = select(node.motion, self.around.names, Source("")) if known else ()
        return None if isinstance(ways, Diagnostic) or not ways else ways[0]

    def _is_known(self, name: syntax.Name) -> bool:
        return bool(self.around.names.places(name.text))

    def _rooms_below(self, motion: Sequence[Token]) -> list[Below]:
        """Return the graphs that a `with` behind a motion leaves; if that is not known, all but the root."""
        way, names = self._way(motion), self.around.names
        if way is not None:
            return list(self._rooms(way))
        return [
            (graph, names.motions(parent))
            for graph in names.all_levels()
            if (parent := names.parent(graph)) is not None
        ]

    def _rooms(self, way: Layering) -> Iterator[Below]:
        """Yield the graphs that a `with` leaves, and what may be played above each: what rule 1 lets it leave."""
        names = self.around.names
        layers = {layer.graph: layer for layer in way.layers}
        tops = tuple(graph for graph in layers if not set(names.ancestors(graph)) & set(layers))
        for graph in Room(tuple(layers), tops, way.layers[-1].graph).allowed(names):
            above = next(layers[one] for one in names.ancestors(graph) if one in layers)
            motions = [motion for motion in above.motions if motion in names.motion_set(graph)]
            if motions:
                yield graph, motions


def _graph(graph: str, says: str) -> Completion:
    return Completion(script_name(graph), graph, What.GRAPH, says=says)


def _part_says(graph: str, names: Names) -> str:
    return f"a part of the body: {len(names.motions(graph))} motions"


def _expression(before: Sequence[Token]) -> Sequence[Token]:
    """Return the motion expression that tokens end with, without the head of a definition before it."""
    if before and before[0].type == "LET":
        depth = 0
        for at, token in enumerate(before):
            depth += (token.type == "LEFT") - (token.type == "RIGHT")
            if token.type == "EQUALS" and depth == 0:
                return before[at + 1 :]
    return before


def _left_of_with(own: Sequence[Token]) -> Sequence[Token] | None:
    """Return what stands left of the `with` that tokens come after, in the same group; None if there is none."""
    depth, with_at = 0, None
    for at in range(len(own) - 1, -1, -1):
        kind = own[at].type
        if kind == "RIGHT":
            depth += 1
        elif kind == "LEFT" and depth == 0:
            return own[at + 1 : with_at] if with_at is not None else _left_of_with(own[:at])
        elif kind == "LEFT":
            depth -= 1
        elif kind == "WITH" and depth == 0 and with_at is None:
            with_at = at
    return None if with_at is None else own[:with_at]


def _parameters(before: Sequence[Token]) -> Iterable[str]:
    """Return the parameters of the definition that tokens are of."""
    if len(before) < 3 or [token.type for token in (before[0], before[2])] != ["LET", "LEFT"]:
        return ()
    inside: list[str] = []
    for token, after in pairwise(before[2:]):
        if token.type in ("LEFT", "COMMA") and after.type in ("NAME", "UNIT"):
            inside.append(after.text)
        if token.type == "RIGHT":
            break
    return inside


def _plain(token: Token) -> str:
    """Return what a name says, without quotes."""
    return token.text[1:-1].replace('\\"', '"').replace("\\\\", "\\") if token.type == "STRING" else token.text
