"""A character on stage: it executes the statements of plans, one after the other, and can go on from where it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, replace
from random import Random

from mlmg_lang.execution import Step, drawing, executed
from mlmg_lang.planning.resolved import Command, Cycles, End, Once, ResolvedPlan, Seconds, Wait
from mlmg_runtime.errors import FileError, PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.timeline import Timeline


class ScriptError(FileError):
    """A script that compiles, but that the library does not allow to be played."""


@dataclass(frozen=True, slots=True)
class Executed:
    """A statement as it was executed, in frames of the library's rate.

    Attributes
    ----------
    arrive : when all parts had arrived; where nothing moves, `begin`.
    motions : by graph that a command names, what drove it on arrival.
    """

    statement: Step
    begin: int
    arrive: int
    end: int
    motions: Mapping[str, str]


def begin(library: Library, start: str, seed: int) -> Stage:
    """Return a character in the first frame of a motion of the whole body.

    Parameters
    ----------
    seed : of what `choose` draws; the same seed always gives the same.
    """
    return Stage(Performer(library, start), drawing(seed), library.root.name)


@dataclass(slots=True)
class Stage:
    """A character, and what it needs to execute another statement.

    Attributes
    ----------
    draws : what `choose` draws from.
    counted : the graph whose cycles a `wait` counts.
    last : what was executed last.
    """

    performer: Performer
    draws: Random
    counted: str
    last: Executed | None = None

    def copy(self) -> Stage:
        """Return the same character, to go on by itself."""
        return replace(self, performer=self.performer.copy(), draws=copy(self.draws))

    def play(self, plan: ResolvedPlan, told: Callable[[], object] = lambda: None) -> tuple[Executed, ...]:
        """Execute all statements of a plan, which was resolved for what is playing now.

        Parameters
        ----------
        told : called after each.

        Raises
        ------
        ScriptError
            With the line of the statement that cannot be played; the stage is then of no more use.
        """
        steps = []
        for statement in executed(plan, self.draws):
            steps.append(self._execute(statement, plan))
            told()
        return tuple(steps)

    def finish(self) -> Timeline:
        """Play a last command that has neither `for` nor `once` to the end of its clip, and return all that is played.

        Something is always played, be it one frame.
        """
        match self.last:
            case Executed(Command(layers=layers, duration=None)):
                self.performer.play_out(layers[0].graph)
                self.last = replace(self.last, end=self.performer.now)
        if self.performer.now == 0:
            self.performer.hold(1)
        return self.performer.timeline()

    def _execute(self, statement: Step, plan: ResolvedPlan) -> Executed:
        begin = self.performer.now
        try:
            arrive = self._arrive(statement)
        except PlayError as error:
            line, _ = plan.source.position(statement.span.start)
            raise ScriptError(plan.source.name, line, str(error)) from None
        motions: dict[str, str] = {}
        if isinstance(statement, Command):
            self.counted = statement.layers[0].graph
            motions = {layer.graph: self.performer.motion(layer.graph) for layer in statement.layers}
        self.last = Executed(statement, begin, arrive, self.performer.now, motions)
        return self.last

    def _arrive(self, statement: Step) -> int:
        """Perform one statement; return the frame at which all of its parts have arrived."""
        performer = self.performer
        match statement:
            case Command(layers=layers, duration=duration):
                wanted = [(layer.graph, layer.candidates) for layer in layers]
                performer.bring(wanted, from_start=isinstance(duration, Once))
                arrive = performer.now
                if isinstance(duration, Once):
                    performer.play_pass(layers[0].graph)
                elif duration is not None:
                    performer.hold(self._n_frames(duration, layers[0].graph))
                return arrive
            case Wait(duration=duration):
                arrive = performer.now
                performer.hold(self._n_frames(duration, self.counted))
                return arrive
            case End(graph=graph):
                performer.end(graph)
        return performer.now

    def _n_frames(self, duration: Seconds | Cycles, counted: str) -> int:
        """Return how many frames a duration takes; a cycle is as long as the clip that drives a graph."""
        library = self.performer.library
        if isinstance(duration, Seconds):
            return round(duration.number * library.frame_rate)
        return round(duration.number * library.n_frames(self.performer.motion(counted)))
