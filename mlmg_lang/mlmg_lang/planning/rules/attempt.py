"""A command where it stands: what a rule may ask of it, of what may be playing before it, and of the library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from mlmg_lang.catalog import Catalog
from mlmg_lang.planning.flow import Setter, State
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import LeftOut
from mlmg_lang.planning.rules.ruling import Narrow, Out, Stopped
from mlmg_lang.planning.typed import Layer


@dataclass(frozen=True, slots=True)
class Attempt:
    """A command that is being worked out.

    Attributes
    ----------
    state : what may be playing before it.
    layers : by graph, highest first, what it asks for there.
    begins : the graph that begins its motion anew, if one does: no way has to lead there, and it runs by itself.
    ruled_out : by graph, the motions that later commands have ruled out, and why.
    left : by graph, the candidates that are still in question.
    out : by graph, the others.
    known : what has been found out of it: `sources`, by graph.
    """

    names: Names
    catalog: Catalog
    state: State
    layers: Mapping[str, Layer]
    begins: str | None
    ruled_out: Mapping[str, Mapping[str, str]]
    left: Mapping[str, tuple[str, ...]]
    out: Mapping[str, tuple[LeftOut, ...]]
    known: dict[str, frozenset[str]] = field(default_factory=dict, compare=False, repr=False)

    def without(self, outs: Iterable[Out], reason: str) -> Attempt:
        """Return the command when some candidates are out."""
        left, out = dict(self.left), dict(self.out)
        for one in outs:
            left[one.graph] = tuple(motion for motion in left[one.graph] if motion != one.motion)
            out[one.graph] = (*out[one.graph], LeftOut(one.motion, reason, one.because))
        return replace(self, left=left, out=out, known={})

    # --- the graphs ---

    def named_above(self, graph: str) -> str | None:
        """Return the nearest graph above one that the command names too."""
        return next((above for above in self.names.ancestors(graph) if above in self.layers), None)

    def running_above(self, graph: str) -> str:
        """Return the nearest graph above one that may run before the command."""
        return next(above for above in self.names.ancestors(graph) if above in self.state.parts)

    def runs_between(self, graph: str, above: str) -> bool:
        """Return whether a part may run between two layers; it is ended, and so is what runs below it."""
        names = self.names.ancestors(graph)
        return any(between in self.state.parts for between in names[: names.index(above)])

    def on(self, graph: str) -> frozenset[str]:
        """Return the motions that are on a graph."""
        return self.names.motion_set(graph)

    # --- ways ---

    def reaches(self, graph: str, source: str, target: str) -> bool:
        """Return whether a walk on a graph can lead from one of its motions to another."""
        return self.catalog.can_reach(graph, source, target)

    def leading_on(self, graph: str, sources: frozenset[str]) -> frozenset[str]:
        """Return the motions from which a candidate can be reached; being one is enough."""
        left = self.left[graph]
        if graph == self.begins:
            return sources if left else frozenset()
        rest = sources.difference(left)
        reaches = self.catalog.can_reach
        for motion in left:  # the first is most often enough for all, of which there are many where anything may play
            if not rest:
                break
            rest = frozenset(source for source in rest if not reaches(graph, source, motion))
        return sources - rest

    # --- what drives a graph when its turn comes, if nothing above it changes ---

    def before(self, graph: str) -> frozenset[str]:
        """Return the motions that may drive a layer's graph until it changes."""
        own, above = self.state.parts.get(graph), self.named_above(graph)
        if above is None:
            return self.state.parts[self.running_above(graph)].motions if own is None else own.motions
        followed = self.before(above) & frozenset(self.left[above])
        if own is None:
            return followed
        return own.motions | followed if self.runs_between(graph, above) else own.motions

    def may_stay(self, graph: str) -> bool:
        """Return whether a layer, and all above it, may be satisfied as they are."""
        above = self.named_above(graph)
        return (above is None or self.may_stay(above)) and not self.before(graph).isdisjoint(self.left[graph])

    def may_move(self, graph: str) -> bool:
        """Return whether a layer, or one above it, may change."""
        above = self.named_above(graph)
        if graph == self.begins or (above is not None and self.may_move(above)):
            return True
        return not self.before(graph) <= set(self.left[graph])

    # --- what a layer sets out from when its turn comes ---

    def driving(self, graph: str) -> frozenset[str]:
        """Return the motions that may drive the graph above a layer, or the layer's own if it is the root."""
        above = self.named_above(graph)
        if above is not None:
            return frozenset(self.left[above])
        return self.state.parts[graph if graph == self.names.root else self.running_above(graph)].motions

    def running(self, graph: str) -> frozenset[str]:
        """Return the motions that a layer's graph may run on its own, where nothing above it changes."""
        above, own = self.named_above(graph), self.state.parts.get(graph)
        if own is None or not own.alone or (above is not None and not self.may_stay(above)):
            return frozenset()
        return own.motions - own.following

    def sources(self, graph: str) -> frozenset[str]:
        """Return the motions that a layer may set out from, as far as it can."""
        if graph not in self.known:  # several rules ask, and where anything may be playing that takes long
            self.known[graph] = self._sources(graph)
        return self.known[graph]

    def _sources(self, graph: str) -> frozenset[str]:
        above, own = self.named_above(graph), self.state.parts.get(graph)
        if above is None:
            playing = self.driving(graph) if own is None else own.motions
            there = playing & self.on(graph)
            can_follow = graph != self.names.root and self.driving(graph) <= set(self.left[graph])
            return there if can_follow else self.leading_on(graph, there)
        kept = own.motions & self.on(graph) if own is not None and self.may_stay(above) else frozenset()
        return self.driving(graph) | kept

    def unreached(self, graph: str) -> tuple[str, ...]:
        """Return the candidates of a layer that no way leads to; what begins anew, or plays already, needs none."""
        if graph == self.begins:
            return ()
        sources = self.sources(graph)
        there = sources | self.driving(graph)
        return tuple(
            motion
            for motion in self.left[graph]
            if motion not in there and not any(self.reaches(graph, source, motion) for source in sources)
        )

    # --- what keeps the command from being obeyed ---

    def stopped(self, graph: str, above: str, motions: tuple[str, ...], by_rule_1: bool) -> Stopped:
        """Say that the command itself leaves nothing for a layer: `motions` of the layer above stand in the way."""
        span, wanted = self.layers[graph].span, self.left[graph]
        return Stopped(graph, span, wanted, above, motions, by_rule_1, setter=None, within=True)

    def hindered(self, graph: str, above: str, bad: frozenset[str]) -> Narrow | Stopped | None:
        """Say of the motions that a layer may have to set out from, and cannot, which earlier commands set them.

        Parameters
        ----------
        above : the graph that they are on: its own, if it may run.
        """
        part = self.state.parts[above]
        good, blamed = part.motions - bad, part.setters(bad)
        if not good or (None in blamed and self.state.certain):
            at_fault = bad if not good else frozenset(m for m in bad if None in part.origins[m])
            return self._stopped_by(graph, above, at_fault, part.setters(at_fault))
        without = {setter: frozenset(m for m in bad if setter in part.origins[m]) for setter in filter(None, blamed)}
        return Narrow(without, graph) if without else None

    def _stopped_by(
        self, graph: str, above: str, at_fault: frozenset[str], setters: frozenset[Setter | None]
    ) -> Stopped:
        """Say that a layer could not start from some motions that play before."""
        setter = min(filter(None, setters), default=None)
        above = above if setter is None else setter[1]
        known = dict.fromkeys(motion for higher in self.names.graphs for motion in self.names.motions(higher))
        motions = tuple(motion for motion in known if motion in at_fault)
        by_rule_1 = not at_fault & self.on(graph)
        span, wanted = self.layers[graph].span, self.left[graph]
        return Stopped(graph, span, wanted, above, motions, by_rule_1, setter, not self.state.certain)
