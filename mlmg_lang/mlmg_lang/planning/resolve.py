"""The typed plan -> the resolved plan: what each command can do where it stands in the script.

Statements are taken one after the other. Where a later command asks for it, an earlier one is narrowed and
all from there is worked out again; if that leaves something empty, the later command is at fault.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic, Fix, Note
from mlmg_lang.planning import flow, resolved, typed
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.resolved import LeftOut
from mlmg_lang.source import Source
from mlmg_lang.spelling import listed, nearest, some


@dataclass(frozen=True, slots=True)
class Resolution:
    """A resolved plan with what is wrong with the script as it would be played.

    Attributes
    ----------
    states : what may be playing before each statement of the script, those with mistakes too, and after the last.
    """

    plan: resolved.ResolvedPlan
    diagnostics: tuple[Diagnostic, ...]
    states: tuple[flow.State, ...]


def resolve(
    plan: typed.TypedPlan, names: Names, catalog: Catalog, source: Source, start: str | None = None
) -> Resolution:
    """Return what a script plays; statements that cannot be played are reported and left out.

    Parameters
    ----------
    start : the motion of the root graph to start in; without it, the script or the library says which.
    """
    motion, wrong = _start(plan, names, catalog, start)
    resolver = _Resolver(names, catalog, plan.statements, source, motion)
    statements = resolver.run()
    told = (diagnostic for _, diagnostic in sorted(resolver.told.items()))
    playable = resolved.ResolvedPlan(source, motion, statements)
    return Resolution(playable, (*wrong, *told), tuple(resolver.states))


def _start(
    plan: typed.TypedPlan, names: Names, catalog: Catalog, given: str | None
) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return the motion to start in, and what is wrong with the one given."""
    of_library = catalog.start
    if of_library not in names.motion_set(names.root):
        of_library = next(iter(names.motions(names.root)), of_library)
    if given is not None:
        match = names.find(names.root, given)
        if match is not None and match.entry.kind is Kind.MOTION and not match.others:
            return match.entry.name, ()
        message = f"there is no motion `{given}` on `{names.root}` to start in"
        near = nearest(given, names.motions(names.root))
        return of_library, (Diagnostic("MS044", message, None, f"there is {listed(near)}" if near else None),)
    first = next((statement for statement in plan.statements if isinstance(statement, typed.Command)), None)
    return (first and first.start) or of_library, ()


@dataclass(slots=True)
class _Trial:
    """A narrowing of earlier commands for the sake of statement `index`, and how things were before."""

    index: int
    stopped: flow.Stopped
    states: list[flow.State]
    done: dict[int, resolved.Statement]
    told: dict[int, Diagnostic]
    forbidden: dict[int, dict[str, dict[str, LeftOut]]]


@dataclass(slots=True)
class _Resolver:
    """Goes through the statements.

    Attributes
    ----------
    states : what may be playing before each statement that has been reached, and after the last of them.
    done : by statement, what is to be played.
    told : by statement, what is wrong with it.
    forbidden : by statement and graph, the candidates that later commands have ruled out.
    ways : by statement, how many of the ways to understand it have failed.
    first_stop : by statement, why the first of them has.
    """

    names: Names
    catalog: Catalog
    statements: tuple[typed.Statement, ...]
    source: Source
    start: str
    states: list[flow.State] = field(default_factory=list)
    done: dict[int, resolved.Statement] = field(default_factory=dict)
    told: dict[int, Diagnostic] = field(default_factory=dict)
    forbidden: dict[int, dict[str, dict[str, LeftOut]]] = field(default_factory=dict)
    ways: dict[int, int] = field(default_factory=dict)
    first_stop: dict[int, flow.Stopped] = field(default_factory=dict)
    trial: _Trial | None = None

    def run(self) -> tuple[resolved.Statement, ...]:
        self.states = [flow.begin(self.names, self.start)]
        while len(self.states) <= len(self.statements):
            self._step(len(self.states) - 1)
        return tuple(self.done[index] for index in sorted(self.done))

    def _step(self, index: int) -> None:
        """Take the next statement, or go back to an earlier one that has to be narrowed."""
        statement, state = self.statements[index], self.states[index]
        match statement:
            case typed.Command():
                self._command(index, statement)
            case typed.Wait(duration, span):
                if duration.seconds is not None:
                    self.done[index] = resolved.Wait(duration.seconds, span)
                self.states.append(state)
            case typed.End():
                self._end(index, statement)
            case _:
                self.states.append(flow.unknown(self.names))

    # --- commands ---

    def _command(self, index: int, command: typed.Command) -> None:
        way = command.ways[self.ways.get(index, 0)]
        forbidden = self.forbidden.get(index, {})
        library = (self.names, self.catalog)
        outcome = flow.move(way.layers, self.states[index], index, forbidden, library)
        if isinstance(outcome, flow.Move):
            self._accept(index, command, way, outcome)
        elif isinstance(outcome, flow.Narrow):
            self._narrow(index, command, way, outcome)
        elif self.trial is not None and self.trial.index >= index:
            self._take_back(self.trial)
        else:
            self._refuse(index, command, outcome)

    def _accept(self, index: int, command: typed.Command, way: typed.Layering, move: flow.Move) -> None:
        spans = {layer.graph: layer.span for layer in way.layers}
        layers = tuple(
            resolved.Layer(graph, candidates, spans[graph], move.left_out[graph])
            for graph, candidates in move.candidates.items()
        )
        seconds = None if command.duration is None else command.duration.seconds
        self.done[index] = resolved.Command(layers, seconds, command.span)
        self.states.append(move.after)
        if self.trial is not None and self.trial.index == index:
            self.trial = None

    def _refuse(self, index: int, command: typed.Command, stopped: flow.Stopped) -> None:
        """Try the next way to understand a command; if there is none, say why the first cannot be obeyed."""
        first = self.first_stop.setdefault(index, stopped)
        self.ways[index] = self.ways.get(index, 0) + 1
        if self.ways[index] == len(command.ways):
            self.told[index] = self._reason(first)
            self.states.append(flow.unknown(self.names))

    def _narrow(self, index: int, command: typed.Command, way: typed.Layering, narrow: flow.Narrow) -> None:
        """Take candidates away from an earlier command, and go back to it."""
        setter, graph = narrow.setter
        if self.trial is None:
            stopped = self._as_stop(way, narrow)
            self.trial = _Trial(index, stopped, self.states[:], dict(self.done), dict(self.told), self.forbidden)
        line, _ = self.source.position(command.span.start)
        because = f"what line {line} asks of `{narrow.graph}` cannot begin in it"
        here = {motion: LeftOut(motion, "later command", because) for motion in sorted(narrow.without)}
        of_setter = self.forbidden.get(setter, {})
        of_graph = {**of_setter.get(graph, {}), **here}
        self.forbidden = {**self.forbidden, setter: {**of_setter, graph: of_graph}}
        del self.states[setter + 1 :]

    def _as_stop(self, way: typed.Layering, narrow: flow.Narrow) -> flow.Stopped:
        """Return what stops a command if the earlier one cannot be narrowed for it."""
        span = next(layer.span for layer in way.layers if layer.graph == narrow.graph)
        above = narrow.setter[1]
        motions = tuple(motion for motion in self.names.motions(above) if motion in narrow.without)
        by_rule_1 = not any(motion in self.names.motion_set(narrow.graph) for motion in motions)
        return flow.Stopped(narrow.graph, span, above, motions, by_rule_1, narrow.setter, within=False)

    def _take_back(self, trial: _Trial) -> None:
        """Undo a narrowing that leaves nothing to an earlier command: the later one is refused."""
        self.states, self.done, self.told = trial.states, trial.done, trial.told
        self.forbidden, self.trial = trial.forbidden, None
        command = self.statements[trial.index]
        assert isinstance(command, typed.Command)
        self._refuse(trial.index, command, trial.stopped)

    # --- ends ---

    def _end(self, index: int, end: typed.End) -> None:
        state, graph = self.states[index], end.graph
        self.states.append(state if graph == self.names.root else flow.ended(state, graph, self.names))
        if graph == self.names.root:
            advice = "name what it shall do next, or a part to give back"
            message = f"`{graph}` is the whole body: there is nothing to give it back to"
            self.told[index] = Diagnostic("MS042", message, end.span, advice)
            return
        self.done[index] = resolved.End(graph, end.span)
        self.told.pop(index, None)
        part = state.parts.get(graph)
        if state.certain and (part is None or not part.alone):
            message = f"`{graph}` does not run on its own here, so there is nothing to end"
            self.told[index] = Diagnostic("MS043", message, end.span, fixes=(Fix(end.span, "", safe=False),))

    # --- what to say ---

    def _reason(self, stopped: flow.Stopped) -> Diagnostic:
        """Say why a command cannot be obeyed."""
        motions = some(stopped.motions)
        notes = tuple(self._origin(stopped))
        if not stopped.by_rule_1:
            message = f"from {motions}, nothing asked of `{stopped.graph}` can be reached on that graph"
            return Diagnostic("MS041", message, stopped.span, notes=notes)
        graph, above = stopped.graph, stopped.above
        verb = "is" if len(stopped.motions) == 1 else "are"
        message = f"`{graph}` cannot leave {motions}, which {verb} not on it"
        free = [motion for motion in self.names.motions(above) if motion in self.names.motion_set(graph)]
        advice = f"it can leave these of `{above}`: {some(free)}" if free else None
        return Diagnostic("MS040", message, stopped.span, advice, notes)

    def _origin(self, stopped: flow.Stopped) -> Iterator[Note]:
        """Yield where the motions come from that stand in the way, if it is not this command itself."""
        if stopped.setter is not None:
            yield Note(f"`{stopped.above}` is set here", self.statements[stopped.setter[0]].span)
        elif not stopped.within:
            yield Note(f"the character starts in `{self.start}`")
