"""A command and where a character is -> what it could take on each graph, found out by trying each."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.planning.resolved import Command, Layer, LeftOut, Once, ResolvedPlan
from mlmg_lang.session.session import Session
from mlmg_runtime.errors import PlayError
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.timeline import Blend


@dataclass(frozen=True, slots=True)
class Candidate:
    """A motion that a command could take.

    Attributes
    ----------
    seconds : from now until it would have arrived; 0 if it plays already, None if it cannot be reached from here.
    cost : the sum over the transitions on its graph.
    of_usual : below the root, its Overall Motion Similarity to what the graph above plays then, over the usual one.
    taken : whether it is what the command would take.
    """

    motion: str
    seconds: float | None
    cost: float
    of_usual: float | None
    taken: bool


@dataclass(frozen=True, slots=True)
class LayerOutlook:
    """What a command could take on one graph, in the order in which that is tried."""

    graph: str
    candidates: tuple[Candidate, ...]
    left_out: tuple[LeftOut, ...]


def outlook(session: Session, plan: ResolvedPlan) -> tuple[LayerOutlook, ...]:
    """Return what the first command of a plan, which was resolved for what is playing, could take on each graph."""
    command = next((one for one in plan.statements if isinstance(one, Command)), None)
    return () if command is None else tuple(_Trier(session, plan.start, command).layers())


@dataclass(frozen=True, slots=True)
class _Trier:
    session: Session
    start: str
    command: Command

    def layers(self) -> list[LayerOutlook]:
        """Return what there is on each graph, from the highest to the lowest."""
        above: list[tuple[str, tuple[str, ...]]] = []
        found = []
        for layer in self.command.layers:
            taken = self._try((*above, (layer.graph, layer.candidates)))
            motion = None if taken is None else taken.motion(layer.graph)
            tried = [self._candidate(layer, one, above, one == motion) for one in layer.candidates]
            found.append(LayerOutlook(layer.graph, tuple(sorted(tried, key=_order)), layer.left_out))
            if motion is None:
                break
            above.append((layer.graph, (motion,)))
        return found

    def _candidate(self, layer: Layer, motion: str, above: list[tuple[str, tuple[str, ...]]], taken: bool) -> Candidate:
        library = self.session.library
        fit = None
        if above and (parent := library.parent(layer.graph)) is not None:
            driver = self._performer_after(above).motion(parent)
            fit = (
                library.unlikeness(layer.graph, driver, motion)
                if driver in library.by_name[layer.graph].index
                else None
            )
        tried = self._try((*above, (layer.graph, (motion,))))
        if tried is None:
            return Candidate(motion, None, 0.0, fit, taken)
        now = self.session.stage.performer.now
        seconds = (tried.now - now) / library.frame_rate
        return Candidate(motion, round(seconds, 3), round(_cost(tried, layer.graph, now), 3), fit, taken)

    def _performer_after(self, layers: list[tuple[str, tuple[str, ...]]]) -> Performer:
        tried = self._try(tuple(layers))
        assert tried is not None, "what is above has been tried before"
        return tried

    def _try(self, layers: tuple[tuple[str, tuple[str, ...]], ...]) -> Performer | None:
        """Return the character after it has been brought to some motions; None if it cannot be."""
        stage = self.session.stage_in(self.start)
        once = isinstance(self.command.duration, Once)
        try:
            stage.performer.bring(layers, from_start=once)
        except PlayError:
            return None
        return stage.performer


def _order(one: Candidate) -> tuple[bool, float, float, float]:
    """Return what sorts candidates: below the root by how they fit, on it by how soon they are reached."""
    soon = float("inf") if one.seconds is None else one.seconds
    return not one.taken, one.of_usual or 0.0, soon, one.cost


def _cost(performer: Performer, graph: str, since: int) -> float:
    segments = performer.timeline().tracks.get(graph, ())
    return sum(
        one.transition.cost
        for one in segments
        if isinstance(one, Blend) and one.transition is not None and one.begin >= since
    )
