"""A name in a script -> what there is to say of what it stands for, in the script or in the library."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

from mlmg_lang.analysis import Analysis
from mlmg_lang.catalog import Catalog
from mlmg_lang.ide.layers import graph_at
from mlmg_lang.ide.markdown import Part, code, shortened, some
from mlmg_lang.ide.meaning import motions_of_use
from mlmg_lang.ide.occurrences import Occurrence, Sort, Symbol
from mlmg_lang.ide.sayings import Understood, state_before, understood
from mlmg_lang.ide.signature import described
from mlmg_lang.ide.statements import Statement
from mlmg_lang.ide.written import written
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import spelled
from mlmg_lang.parsing.structure import without_groups
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import joined, normal

_MOST_COMPARED: Final = 5_000
"""So many pairs of motions are compared; where there are more, they stay in the order of the configuration."""


class Anatomy(Protocol):
    """What is told of a library beyond its names."""

    def joints(self, graph: str) -> Sequence[str]:
        """Return the joints of a graph."""

    def transitions(self, graph: str, motion: str) -> Mapping[str, int]:
        """Return, by motion, how many transitions of a graph lead there from a motion."""


def told_of_name(
    analysis: Analysis, found: Occurrence, statements: Sequence[Statement], anatomy: Anatomy | None
) -> Iterator[Part]:
    """Return what there is to say of a name in one of some statements; nothing if it means nothing.

    Parameters
    ----------
    anatomy : without it, joints and transitions are left out.
    """
    return _Teller(analysis, anatomy, statements).of(found)


@dataclass(frozen=True, slots=True)
class _Teller:
    """Tells of a name in one of some statements."""

    analysis: Analysis
    anatomy: Anatomy | None
    statements: Sequence[Statement]

    @property
    def _library(self) -> tuple[Names, Catalog] | None:
        question = self.analysis.question
        return None if question.names is None or question.catalog is None else (question.names, question.catalog)

    def of(self, found: Occurrence) -> Iterator[Part]:
        symbol = found.symbol
        match symbol.sort:
            case Sort.DEFINITION:
                yield from self._definition(found)
            case Sort.PARAMETER:
                yield from self._parameter(symbol)
            case Sort.SUB:
                yield from self._sub(found)
            case Sort.MOTION | Sort.TAG | Sort.GRAPH if self._library is not None:
                tell = {Sort.MOTION: self._motion, Sort.TAG: self._tag, Sort.GRAPH: self._graph}[symbol.sort]
                yield from tell(symbol.name, *self._library)

    # --- of a library ---

    def _motion(self, motion: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        n_frames = catalog.n_frames(motion)
        yield Part(f"motion {code(motion)}: {spelled(round(n_frames / catalog.frame_rate, 2))} sec, {n_frames} frames")
        for graph in names.graphs:
            if motion in names.motion_set(graph):
                tags = catalog.tags(graph, motion)
                said = joined(map(code, tags)) if tags else "no tags"
                yield Part(f"- on {code(graph)}: {said}{self._ways_on(graph, motion)}")

    def _ways_on(self, graph: str, motion: str) -> str:
        """Return where the transitions of a motion lead."""
        if self.anatomy is None:
            return ""
        numbers = {other: n for other, n in self.anatomy.transitions(graph, motion).items() if n}
        if not numbers:
            return "; no transitions lead on"
        most = sorted(numbers, key=lambda other: -numbers[other])
        listed = some([f"{code(other)} ({numbers[other]})" for other in most])
        n_all = sum(numbers.values())
        return f"; {n_all} transition{'' if n_all == 1 else 's'} to {listed}"

    def _tag(self, tag: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        yield Part(f"tag {code(tag)}")
        for graph in names.graphs:
            match = names.find(graph, tag, exactly=True)
            if match is not None:
                motions, ranked = self._by_fit(graph, match.entry.motions, names, catalog)
                best = ", by likeness to what may play before" if ranked else ""
                yield Part(f"- on {code(graph)}: {some(list(map(code, motions)))}{best}")

    def _by_fit(self, graph: str, motions: Sequence[str], names: Names, catalog: Catalog) -> tuple[Sequence[str], bool]:
        """Return motions by how like they are to what may drive a graph before, and whether that is known."""
        before = self._driving(graph, names)
        known = [one for one in before if one in names.motion_set(graph)]
        if len(motions) < 2 or not 0 < len(known) * len(motions) <= _MOST_COMPARED:
            return motions, False
        return sorted(motions, key=lambda one: min(catalog.unlikeness(graph, other, one) for other in known)), True

    def _driving(self, graph: str, names: Names) -> Iterable[str]:
        """Return what may drive a graph when the statement comes to it: what it says above it, or what plays before."""
        for statement in self.statements:
            state = state_before(self.analysis, statement)
            if state is None or not state.certain or not isinstance(statement.item, syntax.Command):
                continue
            way = understood(self.analysis, statement.item).way
            layers = {} if way is None else {layer.graph: layer.motions for layer in way.layers}
            for above in names.ancestors(graph):
                if above in layers:
                    return layers[above]
            driving = (one for one in (graph, *names.ancestors(graph)) if one in state.parts)
            return state.parts[next(driving)].motions
        return ()

    def _graph(self, graph: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        parent, children = names.parent(graph), names.children(graph)
        where = "the whole body" if parent is None else f"below {code(parent)}"
        above = f"; above {joined(map(code, children))}" if children else ""
        yield Part(f"graph {code(graph)}: {where}{above}")
        if self.anatomy is not None:
            joints = self.anatomy.joints(graph)
            yield Part(f"- {len(joints)} joint{'' if len(joints) == 1 else 's'}: {some(list(map(code, joints)))}")
        motions = names.motions(graph)
        yield Part(f"- {len(motions)} motion{'' if len(motions) == 1 else 's'}: {some(list(map(code, motions)))}")

    def _sub(self, found: Occurrence) -> Iterator[Part]:
        meant = graph_at(self.analysis, found.span)
        says = "the graph below the one that is named before `with`"
        yield Part(f"`Sub`: {says}" if meant is None else f"`Sub` is {code(meant)} here: {says}")
        if meant is not None and self._library is not None:
            yield from self._graph(meant, *self._library)

    # --- of the script ---

    def _definition(self, found: Occurrence) -> Iterator[Part]:
        made = self.analysis.made
        let = made.gathered.definitions.lets[found.symbol.name]
        yield Part(shortened(" ".join(made.addressed.slice(let.span).split())), code=True)
        signature = made.gathered.definitions.signatures.get(found.symbol.name)
        if signature is not None:
            yield Part(_type(let.command))
        for parameter in described(let, signature, made)[1]:
            yield Part(f"- {code(parameter.name)}{': ' if parameter.says else ''}{parameter.says}")
        use = found.use or syntax.Reference(let.name, let.name.span)
        alone = understood(self.analysis, syntax.Command(use, None, None, use.span))
        yield from _put_in(let, alone)
        yield from self._meant(found, alone)

    def _meant(self, found: Occurrence, alone: Understood) -> Iterator[Part]:
        """Yield the graphs and motions that a definition stands for where it is used; alone, where it is defined."""
        if found.use is None:
            layers = () if alone.way is None else alone.way.layers
            meant: Mapping[str, Sequence[str]] = {layer.graph: layer.motions for layer in layers}
        else:
            meant = motions_of_use(self.analysis, [one.item for one in self.statements], found.use)
        for graph, motions in meant.items():
            yield Part(f"- on {code(graph)}: {some(list(map(code, motions)))}")

    def _parameter(self, symbol: Symbol) -> Iterator[Part]:
        made = self.analysis.made
        let = made.gathered.definitions.lets.get(symbol.owner)
        own = () if let is None else let.parameters or ()
        parameter = next((one for one in own if normal(one.name.text) == symbol.name), None)
        if let is None or parameter is None:
            return
        signature = made.gathered.definitions.signatures.get(symbol.owner)
        kind = None if signature is None else signature.kinds.get(symbol.name)
        says = f"parameter {code(parameter.name.text)} of {code(let.name.text)}"
        yield Part(says if kind is None else f"{says}: a {kind}")
        if parameter.default is not None:
            default = " ".join(made.addressed.slice(parameter.default.span).split())
            yield Part(f"without it, {code(shortened(default))}")


def _type(command: syntax.Command) -> str:
    """Return what a definition is, in words."""
    if command.once is not None:
        return "a whole statement, which plays once"
    return (
        "a motion" if command.duration is None else f"a whole statement, which lasts {code(written(command.duration))}"
    )


def _put_in(let: syntax.Let, use: Understood) -> Iterator[Part]:
    """Yield what a definition says in one use of it, if that is not what is written."""
    if use.expanded is None:
        return
    text = written(replace(use.expanded, motion=without_groups(use.expanded.motion)))
    if text != written(replace(let.command, motion=without_groups(let.command.motion))):
        yield Part("which stands here for")
        yield Part(shortened(text), code=True)
