"""One command and what may be playing before it -> what it can do, and what may be playing after it.

Rule 1: a part can leave a motion of the graph above only if that motion is on the part's own graph. It holds
from layer to layer of a command, and for the topmost layer against what plays above it already.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from mlmg_lang.catalog import Catalog
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import LeftOut
from mlmg_lang.planning.typed import Layer
from mlmg_lang.source import Span

Setter: TypeAlias = tuple[int, str]
"""The step, by its key (a number that sorts it among all steps), and the graph that it set."""
Origins: TypeAlias = Mapping[str, frozenset[Setter | None]]
"""By motion that may drive a graph, what may have set it; None for the start, or what could not be understood."""


@dataclass(frozen=True, slots=True)
class Part:
    """A graph that a command has named and none has ended since.

    Attributes
    ----------
    origins : the motions that may drive it, its own or its parent's.
    alone : whether it may run a motion other than its parent's.
    following : of the motions, those that can drive it only where it follows the graph above: then that plays them.
    """

    origins: Origins
    alone: bool
    following: frozenset[str] = frozenset()

    @property
    def motions(self) -> frozenset[str]:
        """Return the motions that may drive it."""
        return frozenset(self.origins)

    def setters(self, motions: Iterable[str]) -> frozenset[Setter | None]:
        """Return what may have set it to one of some motions."""
        return frozenset(setter for motion in motions for setter in self.origins[motion])


@dataclass(frozen=True, slots=True)
class State:
    """What may be playing between two statements.

    Attributes
    ----------
    parts : by graph; the root is always among them.
    certain : False after a statement that could not be understood: then anything may be playing.
    """

    parts: Mapping[str, Part]
    certain: bool = True


@dataclass(frozen=True, slots=True)
class Move:
    """What a command can do: by graph, highest first, the candidates, and why others were left out."""

    candidates: Mapping[str, tuple[str, ...]]
    left_out: Mapping[str, tuple[LeftOut, ...]]
    after: State


@dataclass(frozen=True, slots=True)
class Narrow:
    """Earlier commands have to do without some of their candidates, from which this one could not go on.

    Attributes
    ----------
    without : by what set them, the motions.
    graph : on which this one could not go on.
    """

    without: Mapping[Setter, frozenset[str]]
    graph: str


@dataclass(frozen=True, slots=True)
class Stopped:
    """A command that cannot be obeyed.

    Attributes
    ----------
    graph : on which nothing is left.
    span : of what it should do there.
    above : the graph whose motions stand in the way, `graph` itself if it runs already.
    motions : those motions.
    by_rule_1 : whether rule 1 forbids it; else nothing can be reached.
    setter : the earlier statement that the motions come from; None if they are this one's, or of the start.
    within : whether they are this command's own, or may be anything, as after a statement with a mistake.
    """

    graph: str
    span: Span
    above: str
    motions: tuple[str, ...]
    by_rule_1: bool
    setter: Setter | None
    within: bool


def begin(names: Names, motion: str) -> State:
    """Return the state at the start."""
    return State({names.root: Part({motion: frozenset((None,))}, True)})


def unknown(names: Names) -> State:
    """Return the state in which anything may be playing."""
    nobody: frozenset[Setter | None] = frozenset((None,))
    return State({names.root: Part(dict.fromkeys(names.motions(names.root), nobody), True)}, certain=False)


def joined(states: Iterable[State], names: Names) -> State:
    """Return the state in which any of some states may be: at least one."""
    first, *others = states
    for other in others:
        if other != first:
            first = _either(first, other, names)
    return first


def _either(a: State, b: State, names: Names) -> State:
    parts = {}
    for graph in names.graphs:
        own = [state.parts[graph] for state in (a, b) if graph in state.parts]
        if len(own) == 1:
            follows = b if graph in a.parts else a
            above = next(above for above in names.ancestors(graph) if above in follows.parts)
            origins = follows.parts[above].origins
            own = [replace(own[0], alone=True), Part(origins, False, frozenset(origins))]
        if own:
            running = frozenset(motion for part in own for motion in part.motions - part.following)
            origins = _merged(part.origins for part in own)
            parts[graph] = Part(origins, any(part.alone for part in own), frozenset(origins) - running)
    return State(parts, a.certain and b.certain)


def _merged(many: Iterable[Origins]) -> Origins:
    merged: dict[str, frozenset[Setter | None]] = {}
    for origins in many:
        for motion, setters in origins.items():
            merged[motion] = merged.get(motion, frozenset()) | setters
    return merged


def ended(state: State, graph: str, names: Names) -> State:
    """Return the state after a part, and with it all below it, has been given back to its parent."""
    gone = {graph, *names.below((graph,))}
    return replace(state, parts={name: part for name, part in state.parts.items() if name not in gone})


def move(
    chosen: Iterable[Layer],
    state: State,
    index: int,
    forbidden: Mapping[str, Mapping[str, LeftOut]],
    library: tuple[Names, Catalog],
    once: bool = False,
) -> Move | Narrow | Stopped:
    """Return what a command does.

    Parameters
    ----------
    chosen : one for each graph that it names.
    index : the key of its step.
    forbidden : by graph, the candidates that a later command has ruled out.
    once : whether the topmost of its graphs begins its motion anew: no way has to lead there, and it runs by itself.
    """
    names, catalog = library
    layers = {layer.graph: layer for layer in sorted(chosen, key=lambda layer: names.height(layer.graph))}
    begins = next(iter(layers)) if once else None
    return _Mover(names, catalog, state, index, layers, begins).run(forbidden)


@dataclass(slots=True)
class _Mover:
    """Works out one command.

    Attributes
    ----------
    begins : the graph that begins its motion anew, if one does.
    left : by graph, the candidates that are still in question.
    """

    names: Names
    catalog: Catalog
    state: State
    index: int
    layers: dict[str, Layer]
    begins: str | None
    left: dict[str, tuple[str, ...]] = field(default_factory=dict)
    out: dict[str, dict[str, LeftOut]] = field(default_factory=dict)
    parts: dict[str, Part] = field(default_factory=dict)

    def run(self, forbidden: Mapping[str, Mapping[str, LeftOut]]) -> Move | Narrow | Stopped:
        for graph, layer in self.layers.items():
            self.out[graph] = dict(forbidden.get(graph, {}))
            self.left[graph] = tuple(motion for motion in layer.motions if motion not in self.out[graph])
        hindered = self._ask_upwards()
        if hindered is not None:
            return hindered
        for graph in self.layers:
            hindered = self._enter(graph)
            if hindered is not None:
                return hindered
        left_out = {graph: tuple(reasons.values()) for graph, reasons in self.out.items()}
        return Move(self.left, left_out, self._after())

    # --- from the lowest to the highest: what does a layer ask of the one above? ---

    def _ask_upwards(self) -> Narrow | Stopped | None:
        """Leave out the candidates with which a layer below could not go on, until that leaves out no more."""
        before: dict[str, tuple[str, ...]] = {}
        while before != self.left:
            before = dict(self.left)
            for graph in reversed(self.layers):
                hindered = self._ask_above(graph)
                if hindered is not None:
                    return hindered
        return None

    def _ask_above(self, graph: str) -> Narrow | Stopped | None:
        """Leave out the candidates above with which a layer could not go on."""
        above = self._named_above(graph)
        if above is None:
            return None
        before = self.left[above]
        dead_ends = {motion: self._dead_ends(graph, above, motion) for motion in before if motion in self._on(graph)}
        for motion in before:
            if motion not in dead_ends:
                self._leave_out(above, motion, "rule 1", f"it is not on `{graph}`")
            elif dead_ends[motion]:
                source = "it" if motion in dead_ends[motion] else f"what `{graph}` may play with it"
                because = f"nothing asked of `{graph}` can be reached from {source}"
                self._leave_out(above, motion, "unreachable", because)
        if self.left[above]:
            return None
        for motion, ends in dead_ends.items():
            if motion not in ends:
                return self._hindered(graph, graph, ends)
        return Stopped(graph, self.layers[graph].span, above, before, not dead_ends, None, within=True)

    def _dead_ends(self, graph: str, above: str, motion: str) -> frozenset[str]:
        """Return from where a layer may have to set out, and cannot, if a motion is taken above it.

        If the motion is one of its own candidates, it can always follow. Where anything may be playing, one way out
        is enough.
        """
        if motion in self.left[graph]:
            return frozenset()
        own = self.state.parts.get(graph)
        sources = frozenset((motion,))
        if own is not None and motion in self._before(above) and self._may_stay(above):
            running = own.motions - own.following
            may_follow = own.following or self._may_move(above) or self._runs_between(graph, above)
            sources = running | sources if may_follow else running
        dead = frozenset(source for source in sources if not self._leads_on(graph, source))
        return dead if self.state.certain or dead == sources else frozenset()

    # --- if nothing above it changes, what drives a graph when its turn comes? ---

    def _before(self, graph: str) -> frozenset[str]:
        own, above = self.state.parts.get(graph), self._named_above(graph)
        if above is None:
            return self.state.parts[self._running_above(graph)].motions if own is None else own.motions
        followed = self._before(above) & frozenset(self.left[above])
        if own is None:
            return followed
        return own.motions | followed if self._runs_between(graph, above) else own.motions

    def _runs_between(self, graph: str, above: str) -> bool:
        """Return whether a part may run between two layers; it is ended, and so is what runs below it."""
        names = self.names.ancestors(graph)
        return any(between in self.state.parts for between in names[: names.index(above)])

    def _may_stay(self, graph: str) -> bool:
        """Return whether a layer, and all above it, may be satisfied as they are."""
        above = self._named_above(graph)
        return (above is None or self._may_stay(above)) and not self._before(graph).isdisjoint(self.left[graph])

    def _may_move(self, graph: str) -> bool:
        """Return whether a layer, or one above it, may change."""
        above = self._named_above(graph)
        if graph == self.begins or (above is not None and self._may_move(above)):
            return True
        return not self._before(graph) <= set(self.left[graph])

    # --- from the highest to the lowest: how does each get there? ---

    def _enter(self, graph: str) -> Narrow | Stopped | None:
        """Find what a layer can start from, and what of it can be reached."""
        above = self._named_above(graph)
        if above is None:
            found = self._sources_before(graph)
            if isinstance(found, Narrow | Stopped):
                return found
            sources, driving = found
        else:
            driving = self.parts[above].motions
            sources = driving | self._kept(graph, above)
        for motion in self.left[graph] if graph != self.begins else ():
            if motion not in sources | driving and not any(self._reaches(graph, source, motion) for source in sources):
                self._leave_out(graph, motion, "unreachable", "it cannot be reached")
        self.parts[graph] = self._arrived(graph, sources, driving)
        return None

    def _sources_before(self, graph: str) -> tuple[frozenset[str], frozenset[str]] | Narrow | Stopped:
        """Return what the topmost layer starts from, and what drives the graph above it."""
        above = graph if graph in self.state.parts else self._running_above(graph)
        motions = self.state.parts[above].motions
        followed = self.state.parts[self._running_above(graph)].motions if graph != self.names.root else motions
        can_follow = graph != self.names.root and followed <= set(self.left[graph])
        good = frozenset(m for m in motions & self._on(graph) if can_follow or self._leads_on(graph, m))
        hindered = self._hindered(graph, above, motions - good)
        return hindered or (good, followed)

    def _hindered(self, graph: str, above: str, bad: frozenset[str]) -> Narrow | Stopped | None:
        """Say of the motions that a layer may have to set out from, and cannot, which earlier commands set them.

        Parameters
        ----------
        above : the graph that they are on: its own, if it may run.
        """
        part = self.state.parts[above]
        good, blamed = part.motions - bad, part.setters(bad)
        if not good or (None in blamed and self.state.certain):
            at_fault = bad if not good else frozenset(m for m in bad if None in part.origins[m])
            return self._stopped(graph, above, at_fault, part.setters(at_fault))
        without = {setter: frozenset(m for m in bad if setter in part.origins[m]) for setter in filter(None, blamed)}
        return Narrow(without, graph) if without else None

    def _stopped(self, graph: str, above: str, at_fault: frozenset[str], setters: frozenset[Setter | None]) -> Stopped:
        """Say that the topmost layer could not start from some motions."""
        setter = min(filter(None, setters), default=None)
        above = above if setter is None else setter[1]
        known = dict.fromkeys(motion for higher in self.names.graphs for motion in self.names.motions(higher))
        motions = tuple(motion for motion in known if motion in at_fault)
        by_rule_1 = not at_fault & self._on(graph)
        return Stopped(graph, self.layers[graph].span, above, motions, by_rule_1, setter, not self.state.certain)

    def _kept(self, graph: str, above: str) -> frozenset[str]:
        """Return what a part plays already that is on its graph, if the one above may stay as it is."""
        own = self.state.parts.get(graph)
        return frozenset() if own is None or not self._may_stay(above) else own.motions & self._on(graph)

    def _arrived(self, graph: str, sources: frozenset[str], driving: frozenset[str]) -> Part:
        """Return what may drive a graph when it has arrived: any candidate.

        Where it is driven by a candidate already, it will stay; but which candidates a later command leaves
        is not known yet, so that is asked only to see whether the part runs alone.
        """
        motions = frozenset(self.left[graph])
        moves = not sources <= motions
        before = self.state.parts.get(graph)
        alone = moves or (before is not None and before.alone and bool(before.motions & sources))
        same = len(motions) == 1 and motions == driving
        here: frozenset[Setter | None] = frozenset(((self.index, graph),))
        return Part(dict.fromkeys(self.left[graph], here), (alone and not same) or graph == self.begins)

    def _after(self) -> State:
        """Return the state after the command: it ends what is below its graphs and not named."""
        gone = set(self.names.below(self.layers)) - set(self.layers)
        kept = {graph: part for graph, part in self.state.parts.items() if graph not in gone}
        return State({**kept, **self.parts}, self.state.certain or self.names.root in self.layers)

    # --- small questions ---

    def _named_above(self, graph: str) -> str | None:
        return next((above for above in self.names.ancestors(graph) if above in self.layers), None)

    def _running_above(self, graph: str) -> str:
        return next(above for above in self.names.ancestors(graph) if above in self.state.parts)

    def _on(self, graph: str) -> frozenset[str]:
        return self.names.motion_set(graph)

    def _leads_on(self, graph: str, source: str) -> bool:
        """Return whether from a motion a candidate can be reached; being one is enough."""
        left = self.left[graph]
        if graph == self.begins:
            return bool(left)
        return source in left or any(self._reaches(graph, source, motion) for motion in left)

    def _reaches(self, graph: str, source: str, target: str) -> bool:
        return self.catalog.can_reach(graph, source, target)

    def _leave_out(self, graph: str, motion: str, reason: str, because: str) -> None:
        self.left[graph] = tuple(other for other in self.left[graph] if other != motion)
        self.out[graph][motion] = LeftOut(motion, reason, because)
