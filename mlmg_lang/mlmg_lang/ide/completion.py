"""What is being written at a place, and what may be playing there -> what could be written there, the best first.

What the grammar accepts comes from the parser itself; the graphs whose names are offered, from what is in `reach`; and
the names of each, and their order, from what the library `offers`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice
from math import inf
from typing import Final, TypeAlias

from mlmg_lang.definitions.gather import Definitions, Kind
from mlmg_lang.ide.arguments import argument_at, names_of_definition, parameter_kinds
from mlmg_lang.ide.combining import Partners
from mlmg_lang.ide.cursor import Cursor
from mlmg_lang.ide.next_words import next_units, next_words
from mlmg_lang.ide.offers import Completion, Offers, What, best_fit
from mlmg_lang.ide.reach import Below, Reach, expression, left_of_with
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.lexical import in_quotes, script_name
from mlmg_lang.parsing.line_parser import accepted
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import counted, joined, normal

Place: TypeAlias = tuple[str, str | None]
"""A graph that a name is on, and the one beside it that what stands left of `and` is on, if any."""
_BEFORE_OWN: Final = 10
"""So many names of the library stand before the script's own where nothing has been written yet."""


@dataclass(frozen=True, slots=True)
class Offered:
    """What could be written at a place.

    Attributes
    ----------
    span : the stretch that it takes the place of.
    found : the best first.
    fits : by graph, and the graph beside it as in `Completion`, how well its motions go with what is playing; see
        `offers.Fits`.
    """

    span: Span
    found: tuple[Completion, ...]
    fits: Mapping[Place, Mapping[str, float]] = field(default_factory=dict)

    def fit(self, one: Completion) -> float | None:
        """Return how well the best motion of a completion goes with what is playing; None if that is not known."""
        return None if one.graph is None else best_fit(one, self.fits[one.graph, one.beside])


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a text is completed against.

    Attributes
    ----------
    state : what may be playing before the statement.
    paths : gives the paths of files that could be used, from the beginning of one.
    """

    names: Names
    definitions: Definitions
    state: State
    offers: Offers
    paths: Callable[[str], Iterable[str]] = lambda _: ()


def complete(cursor: Cursor | None, offset: int, around: Surroundings) -> Offered:
    """Return what could be written at a cursor, the best first; nothing without one.

    Nothing is left out for what has been written of the word: that is up to `matches`; nor for what stands behind it,
    or for what a definition says: that is up to `trying`.

    Parameters
    ----------
    offset : of the cursor.
    """
    if cursor is None:
        return Offered(Span(offset, offset), ())
    completer = _Completer(
        around,
        cursor,
        Reach(around.names, around.definitions, around.state),
        names_of_definition(cursor.before, around.definitions),
    )
    found = chain.from_iterable(completer.all())
    return Offered(cursor.span, tuple(_in_quotes(found) if cursor.quoted else found), completer.fits)


def _in_quotes(found: Iterable[Completion]) -> Iterator[Completion]:
    """Yield what can stand in quotes, in quotes: names."""
    for one in found:
        if one.what not in (What.WORD, What.UNIT, What.ARGUMENT) and one.name != SUB:
            text = one.text if one.text.startswith('"') else f'"{one.text}"'
            yield Completion(text, *one[1:])


@dataclass(frozen=True, slots=True)
class _Completer:
    """Finds what could be written, in stretches: there may be thousands of names, kept as they are offered.

    Attributes
    ----------
    own : what the definition that is being written gives a meaning in it: see `names_of_definition`.
    """

    around: Surroundings
    cursor: Cursor
    reach: Reach
    own: frozenset[str]
    fits: dict[Place, Mapping[str, float]] = field(default_factory=dict)

    def all(self) -> Iterator[Iterable[Completion]]:
        before = self.cursor.before
        types = accepted(before)
        if types is None:
            return
        if before and before[-1].type in ("INTEGER", "DECIMAL"):
            yield next_units(types)
            return
        if types & NAMES:
            yield from self._names(before)
        if not before or self.reach.qualifier(expression(before)) is None or before[-1].type not in NAMES:
            yield next_words(types, self.cursor, self.reach)

    # --- names ---

    def _names(self, before: tuple[Token, ...]) -> Iterator[Iterable[Completion]]:
        match [token.type for token in before]:
            case ["LET", *rest] if "EQUALS" not in rest:
                return
            case ["USE"]:
                yield map(_path, self.around.paths(self.cursor.word))
            case ["END"]:
                yield self._ends()
            case [*_, "WAIT" | "FOR"]:
                yield self._parameters_of(before, Kind.DURATION)
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
        own = expression(before)
        argument = argument_at(own, self.around.definitions)
        if argument is not None:
            yield (_named(parameter, argument.owner) for parameter in argument.nameable)
            if argument.kind is Kind.DURATION:
                yield self._parameters_of(before, Kind.DURATION)
            if not argument.takes_motion:
                return
        qualifier = self.reach.qualifier(own)
        if qualifier is not None:
            is_right_behind = own[-1].type in NAMES
            joined = own[:-1] if is_right_behind else own
            graphs = self.around.names.all_levels() if is_right_behind else qualifier
            partners = self.reach.partners(joined, graphs, qualifier, whole=not is_right_behind)
            if partners is not None:
                yield from chain(*self._beside(partners))
            else:
                meant = [(graph, above) for graph in qualifier if (above := self.reach.above(graph, own))]
                yield from self._unqualified(meant, set())
            return
        if own and own[-1].type in NAMES | {"RIGHT"}:
            return  # A word comes next.
        left = left_of_with(own)
        if left is not None and not self.reach.leaves_room(left):
            return
        rooms = None if left is None else self.reach.rooms_below(left)
        graphs = self.around.names.all_levels() if rooms is None else tuple(graph for graph, _ in rooms)
        partners = self.reach.partners(own, graphs, graphs, whole=False)
        if partners is not None:
            yield from self._behind_and(before, partners)
        elif rooms is None:
            yield from self._anywhere(before)
        else:
            yield from self._below(before, rooms)

    def _behind_and(self, before: Sequence[Token], partners: Partners) -> Iterator[Iterable[Completion]]:
        """Yield what may stand behind an `and`: what has motions in common first, then what is shared out."""
        common, shared = self._beside(partners)
        yield from self._with_own(common, before)
        graphs = dict.fromkeys(partner.graph for partner, motions in partners.left.items() if motions)
        yield self._graphs([graph for graph in graphs if graph != self.around.names.root])
        yield self._sub(before)
        yield from shared

    def _beside(self, partners: Partners) -> tuple[list[list[Completion]], list[list[Completion]]]:
        """Return the names that have motions in common with what stands left of `and`, and those that are shared out.

        What they do there counts alone: the best of their motions that go with it come first.
        """
        found: tuple[list[list[Completion]], list[list[Completion]]] = ([], [])
        for partner, own in partners.names.items():
            motions = partners.left[partner]
            names = self._on(partner.graph, partners.above[partner], partner.beside)
            fits = self.fits[partner.graph, partner.beside]
            here = [_within(one, motions) for one in names if one.name in own]
            best = [best_fit(one, fits) for one in here]
            order = sorted((at for at in range(len(here)) if best[at] < inf), key=best.__getitem__)
            found[partner.beside is not None].append([here[at] for at in order])
        return found

    def _below(self, before: Sequence[Token], rooms: Sequence[Below]) -> Iterator[Iterable[Completion]]:
        """Yield what may stand behind a `with`."""
        yield from self._with_own(self._unqualified(rooms, set()), before)
        yield self._graphs([graph for graph, _ in rooms])
        yield self._sub(before)

    def _anywhere(self, before: Sequence[Token]) -> Iterator[Iterable[Completion]]:
        """Yield what a command may begin with: what the whole body does first, then what parts may do as it is."""
        names = self.around.names
        yield from self._with_own([self._on(names.root, self.reach.playing(names.root))], before)
        allowed = [graph for graph in names.all_levels()[1:] if self.reach.playing(graph) & names.motion_set(graph)]
        yield self._graphs(allowed)
        rooms = [(graph, self.reach.playing(graph)) for graph in allowed]
        yield from self._unqualified(rooms, set(names.spellings_on(names.root)))

    def _with_own(
        self, library: Iterable[Iterable[Completion]], before: Sequence[Token]
    ) -> Iterator[Iterable[Completion]]:
        """Yield names of the library with the script's own: where a word is begun, these first, so that none is lost.

        Else the best of the library come first.
        """
        found = chain.from_iterable(library)
        yield tuple(islice(found, 0 if self.cursor.word else _BEFORE_OWN))
        yield self._parameters_of(before, Kind.MOTION)
        yield self._definitions(before)
        yield found

    def _unqualified(self, rooms: Sequence[Below], known: set[str]) -> Iterator[Iterable[Completion]]:
        """Yield the names on some graphs that mean these without a graph's name: each on the first that has it."""
        for number, (graph, above) in enumerate(rooms, start=1):
            own = self._on(graph, above)
            if known:
                own = tuple([one for one in own if one.name not in known])
            yield own
            if number < len(rooms):
                known |= {one.name for one in own}

    def _on(self, graph: str, above: Collection[str], beside: str | None = None) -> Sequence[Completion]:
        """Return the names on a graph that mean what they mean there, and note how well its motions fit."""
        found, self.fits[graph, beside] = self.around.offers.on(graph, above, beside)
        definitions = self.around.definitions
        hidden = self.around.names.spelt(graph, {*definitions.lets, *definitions.unread, *self.own})
        return [one for one in found if one.name not in hidden] if hidden else found

    def _graphs(self, graphs: Iterable[str]) -> Iterator[Completion]:
        return (_graph(graph, _part_says(graph, self.around.names)) for graph in graphs)

    def _sub(self, before: Sequence[Token]) -> Iterator[Completion]:
        left = left_of_with(expression(before))
        if left is None:
            return
        graphs, names = self.reach.sub(left), self.around.names
        if graphs:
            yield _graph(SUB, f"the part below: {joined(graphs, 'or')}")
        elif not names.motions(names.root):  # Without a library nobody knows of graphs.
            yield _graph(SUB, "the part below")

    def _parameters_of(self, before: Sequence[Token], kind: Kind) -> Iterator[Completion]:
        """Yield the parameters of the definition that is being written, of a kind or of one that is not known."""
        for name, known in parameter_kinds(before, self.around.definitions).items():
            if known in (None, kind):
                owner = normal(name_from_token(before[1]).text)
                yield Completion(script_name(name), name, What.PARAMETER, owner=owner)

    def _definitions(self, before: Sequence[Token]) -> Iterator[Completion]:
        definitions = self.around.definitions
        for name, let in definitions.lets.items():
            signature = definitions.signatures.get(name)
            if name in self.own or (before and signature is not None and signature.lasts):
                continue  # What says how long is a whole statement.
            says = "defined here" if let.parameters is None else f"takes {len(let.parameters)}"
            yield Completion(script_name(name), name, What.DEFINITION, says=says)


def _path(path: str) -> Completion:
    return Completion(in_quotes(path), path, What.FILE, says="a script")


def _named(parameter: syntax.Parameter, owner: str) -> Completion:
    name = parameter.name.text
    return Completion(f"{script_name(name)} = ", f"{name} = ", What.ARGUMENT, owner=owner)


def _within(one: Completion, motions: frozenset[str]) -> Completion:
    """Return a name as what it does right of an `and`: it stands for some motions alone."""
    if motions.issuperset(one.motions):
        return one
    return one._replace(motions=tuple(filter(motions.__contains__, one.motions)))


def _graph(graph: str, says: str) -> Completion:
    return Completion(script_name(graph), graph, What.GRAPH, says=says)


def _part_says(graph: str, names: Names) -> str:
    return f"a part of the body: {counted(len(names.motions(graph)), 'motion')}"
