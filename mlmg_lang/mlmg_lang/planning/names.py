"""Which graphs, motions and tags a library has, and which of them a written name means."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

from mlmg_lang.catalog import Catalog
from mlmg_lang.spelling import Vocabulary, folded, normal

_MOST_KEPT = 4096


class Kind(StrEnum):
    """What a name in a library stands for."""

    MOTION = "motion"
    TAG = "tag"


@dataclass(frozen=True, slots=True)
class Entry:
    """A name on a graph.

    Attributes
    ----------
    name : the library's own spelling.
    motions : the motion itself, or those that have the tag, in configuration order.
    """

    name: str
    kind: Kind
    motions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Match:
    """What a written name means on a graph.

    Attributes
    ----------
    others : entries that the spelling fits as well; none if it is exact.
    """

    entry: Entry
    exact: bool
    others: tuple[Entry, ...] = ()


@dataclass(frozen=True, slots=True)
class _Graph:
    """The names on one graph, by their exact and by their folded spelling."""

    motions: tuple[str, ...]
    motion_set: frozenset[str]
    order: Mapping[str, int]
    entries: tuple[Entry, ...]
    spellings: tuple[str, ...]
    tags: tuple[str, ...]
    exact: Mapping[str, Entry]
    inexact: Mapping[str, tuple[Entry, ...]]


class Names:
    """An index of a library's names. Nothing that it tells changes after it is made."""

    def __init__(self, catalog: Catalog) -> None:
        """Read all names of a library."""
        self.graphs = tuple(catalog.graphs)
        self.root = self.graphs[0]
        self._parent = {graph: catalog.parent(graph) for graph in self.graphs}
        self._children = {graph: self._right_below(graph) for graph in self.graphs}
        self._ancestors = {graph: tuple(self._upwards(graph)) for graph in self.graphs}
        self._levels = (self.root, *self.below((self.root,)))
        self._order = {graph: at for at, graph in enumerate(self.graphs)}
        self._names = {graph: _index(catalog, graph) for graph in self.graphs}
        self._graphs_exact = {normal(graph): graph for graph in self.graphs}
        self._graphs_inexact = {folded(graph): graph for graph in reversed(self.graphs)}
        self._tags: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._vocabularies: dict[tuple[str, ...], Vocabulary] = {}
        self._near: dict[tuple[str, tuple[str, ...]], tuple[str, ...]] = {}
        self._anywhere = frozenset(name for index in self._names.values() for name in index.exact)

    # --- the tree of graphs ---

    def parent(self, graph: str) -> str | None:
        """Return the graph above, or None for the root."""
        return self._parent[graph]

    def _right_below(self, graph: str) -> tuple[str, ...]:
        return tuple(child for child in self.graphs if self._parent[child] == graph)

    def children(self, graph: str) -> tuple[str, ...]:
        """Return the graphs right below one, in configuration order."""
        return self._children[graph]

    def _upwards(self, graph: str) -> Iterator[str]:
        above = self._parent[graph]
        while above is not None:
            yield above
            above = self._parent[above]

    def ancestors(self, graph: str) -> tuple[str, ...]:
        """Return the graphs above one, nearest first."""
        return self._ancestors[graph]

    def below(self, tops: Iterable[str]) -> tuple[str, ...]:
        """Return the graphs below some, nearest first, those of a level in configuration order."""
        found: list[str] = []
        level = tuple(tops)
        while level:
            children = {child for graph in level for child in self.children(graph)}
            level = tuple(graph for graph in self.graphs if graph in children)
            found += [graph for graph in level if graph not in found]
        return tuple(found)

    def all_levels(self) -> tuple[str, ...]:
        """Return all graphs, the root first, then level by level."""
        return self._levels

    def height(self, graph: str) -> tuple[int, int]:
        """Return what sorts graphs from the highest to the lowest, ties in configuration order."""
        return len(self.ancestors(graph)), self._order[graph]

    # --- what names mean ---

    def motions(self, graph: str) -> tuple[str, ...]:
        """Return the motions on a graph."""
        return self._names[graph].motions

    def motion_set(self, graph: str) -> frozenset[str]:
        """Return the motions on a graph, to ask whether one is among them."""
        return self._names[graph].motion_set

    def in_order(self, graph: str, motions: Iterable[str]) -> tuple[str, ...]:
        """Return those of some motions that are on a graph, in configuration order."""
        order = self._names[graph].order
        return tuple(sorted(order.keys() & motions, key=order.__getitem__))

    def graph(self, written: str) -> str | None:
        """Return the graph that a written name means, or None."""
        return self._graphs_exact.get(normal(written)) or self._graphs_inexact.get(folded(written))

    def find(self, graph: str, written: str, exactly: bool = False) -> Match | None:
        """Return what a written name means on one graph, or None."""
        index = self._names[graph]
        entry = index.exact.get(normal(written))
        if entry is not None:
            return Match(entry, exact=True)
        entries = () if exactly else index.inexact.get(folded(written), ())
        alike = tuple(other for other in entries if other.kind is entries[0].kind)
        return Match(alike[0], exact=False, others=alike[1:]) if alike else None

    def find_unqualified(self, graph: str, written: str) -> Match | None:
        """Return what a name without a graph means on one: inexactly spelt only if no name is spelt so."""
        return self.find(graph, written, exactly=normal(written) in self._anywhere)

    def places(self, written: str) -> tuple[str, ...]:
        """Return the graphs on which a written name means something."""
        return tuple(graph for graph in self.graphs if self.find_unqualified(graph, written) is not None)

    def spellings_of(self, written: str) -> Iterator[str]:
        """Yield what a written name could mean, as it is spelt: on each graph, and once more where it fits several."""
        for graph in self.graphs:
            match = self.find_unqualified(graph, written)
            if match is not None:
                yield from (entry.name for entry in (match.entry, *match.others))

    def written_apart(self, words: Sequence[str]) -> tuple[str, ...]:
        """Return the graphs, tags and motions that some words in a row are, however these are joined in them."""
        if len(words) > self._most_letters:  # each word has one at least
            return ()
        return self._without_spaces.get("".join(map(_without_spaces, words)), ())

    @cached_property
    def _most_letters(self) -> int:
        return max(map(len, self._without_spaces), default=0)

    @cached_property
    def _without_spaces(self) -> Mapping[str, tuple[str, ...]]:
        found: dict[str, list[str]] = {}
        for name in self._everything.names:
            found.setdefault(_without_spaces(name), []).append(name)
        return {letters: tuple(names) for letters, names in found.items()}

    def entries(self, graph: str) -> tuple[Entry, ...]:
        """Return what the tags on a graph stand for, then its motions."""
        return self._names[graph].entries

    def spellings_on(self, graph: str) -> tuple[str, ...]:
        """Return the tags on a graph, then its motions."""
        return self._names[graph].spellings

    def spelt(self, graph: str, words: Collection[str]) -> frozenset[str]:
        """Return the names on a graph, as the library has them, that some words in NFC spell exactly."""
        exact = self._names[graph].exact
        return frozenset(exact[word].name for word in words if word in exact)

    def nearest(self, written: str, graphs: Iterable[str]) -> tuple[str, ...]:
        """Return the names on some graphs that look most like a written one, the most like first.

        What was asked is kept: while somebody types, the same unknown names are compared with all others at each key.
        """
        key = (written, tuple(graphs))
        found = self._near.get(key)
        if found is None:
            if len(self._near) >= _MOST_KEPT:
                self._near.clear()
            found = self._near[key] = self._vocabulary(key[1]).nearest(written)
        return found

    def _vocabulary(self, graphs: tuple[str, ...]) -> Vocabulary:
        """Return the names on some graphs, kept: comparing is quick, making them ready for it is not."""
        if graphs not in self._vocabularies:
            self._vocabularies[graphs] = Vocabulary(word for graph in graphs for word in self.spellings_on(graph))
        return self._vocabularies[graphs]

    def nearest_graph(self, written: str) -> str | None:
        """Return the graph that looks most like a written name, if no motion or tag looks more like it."""
        near = self._everything.nearest(written, limit=1)
        return near[0] if near and near[0] in self._parent else None

    @cached_property
    def _everything(self) -> Vocabulary:
        return Vocabulary((*self.graphs, *self.spellings()))

    def tags(self, graphs: Iterable[str]) -> tuple[str, ...]:
        """Return every tag on some graphs, once."""
        key = tuple(graphs)
        if key not in self._tags:
            self._tags[key] = tuple(dict.fromkeys(tag for graph in key for tag in self._names[graph].tags))
        return self._tags[key]

    def spellings(self) -> tuple[str, ...]:
        """Return every motion and tag, once."""
        return tuple(dict.fromkeys(name for graph in self.graphs for name in self.spellings_on(graph)))


def _without_spaces(name: str) -> str:
    return "".join(folded(name).split())


def _index(catalog: Catalog, graph: str) -> _Graph:
    motions = tuple(catalog.motions(graph))
    tagged: dict[str, list[str]] = {}
    for motion in motions:
        for tag in catalog.tags(graph, motion):
            tagged.setdefault(tag, []).append(motion)
    entries = [Entry(motion, Kind.MOTION, (motion,)) for motion in motions]
    entries += [Entry(tag, Kind.TAG, tuple(having)) for tag, having in tagged.items()]
    inexact: dict[str, tuple[Entry, ...]] = {}
    for entry in entries:
        key = folded(entry.name)
        inexact[key] = (*inexact.get(key, ()), entry)
    exact = {normal(entry.name): entry for entry in reversed(entries)}
    exact = dict(reversed(exact.items()))
    listed = tuple(sorted(exact.values(), key=lambda entry: entry.kind is Kind.MOTION))
    spellings = tuple(entry.name for entry in listed)
    tags = tuple(entry.name for entry in exact.values() if entry.kind is Kind.TAG)
    order = {motion: at for at, motion in enumerate(motions)}
    return _Graph(motions, frozenset(motions), order, listed, spellings, tags, exact, inexact)
