"""The typed plan -> the resolved plan: what each command can do where it stands in the script.

Statements are taken one after the other, those of a loop again until nothing new can come before them. Where a later
command asks for it, an earlier one is narrowed and all from there is worked out again; if that leaves something
empty, the later command is at fault.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mlmg_lang.catalog import Catalog
from mlmg_lang.definitions.expand import told_from
from mlmg_lang.diagnostics import Diagnostic, Fix, Note
from mlmg_lang.planning import flow, resolved, typed
from mlmg_lang.planning.chart import chart
from mlmg_lang.planning.move import Move, move
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.narrowing import Narrowings, Trial
from mlmg_lang.planning.recalling import Made, Recall
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.rules.ruling import Narrow, Stopped
from mlmg_lang.planning.stops import reason
from mlmg_lang.planning.walking import Walk
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import listed, nearest

GAP = 1 << 200
"""How far apart the keys of steps are at first, so that there is room for others between them."""


class ReachesBack(Exception):
    """A step needs one that stands before those that are resolved."""

    def __init__(self, key: int) -> None:
        """Say the key of the one that is needed."""
        super().__init__(key)
        self.key = key


def resolve(
    plan: typed.TypedPlan,
    names: Names,
    catalog: Catalog,
    source: Source,
    start: str | None = None,
    state: flow.State | None = None,
) -> Resolution:
    """Return what a script plays; statements that cannot be played are reported and left out.

    Parameters
    ----------
    start : the motion of the root graph to start in; without it, the script or the library says which.
    state : what is playing already; None if nothing is.
    """
    motion, wrong = start_of(plan.statements, names, catalog, start)
    n_steps = len(steps := chart(plan.statements))
    keys = range(GAP, (n_steps + 1) * GAP, GAP)
    walk = Walk(names, steps, state or flow.begin(names, motion))
    resolver = _Resolver((names, catalog), walk, source, motion, keys)
    resolver.has_begun = state is not None
    resolver.run()
    return _resolution(plan.statements, resolver, wrong)


def resolve_part(
    statements: Sequence[typed.Statement],
    library: tuple[Names, Catalog],
    source: Source,
    before: tuple[str, flow.State],
    keys: Sequence[int],
    known: Mapping[int, flow.State],
    recall: Recall,
) -> Resolution:
    """Return what some statements of a script play, as far as is not known from an earlier time.

    Parameters
    ----------
    before : the motion that the script starts in, and what may be playing before these statements.
    keys : by step, what sorts it among all steps of the script.
    known : by steps that stand in no block, with what before them all from there is as it was.
    recall : what commands have done earlier.

    Raises
    ------
    ReachesBack
        If what stands before these statements would have to be resolved again, or to be told of.
    """
    start, state = before
    walk = Walk(library[0], chart(statements), state)
    resolver = _Resolver(library, walk, source, start, keys, known, recall)
    resolver.run()
    return _resolution(statements, resolver, ())


def _resolution(
    statements: Sequence[typed.Statement], resolver: _Resolver, wrong: tuple[Diagnostic, ...]
) -> Resolution:
    walk = resolver.walk
    playable = resolved.ResolvedPlan(resolver.source, resolver.start, _rebuilt(statements, resolver.done))
    states = {
        step.statement.span: state
        for step, state in zip(walk.steps, walk.entered, strict=True)
        if step.statement is not None and state is not None
    }
    told, moves = resolver.told, resolver.recall.made
    return Resolution(playable, wrong, told, states, walk.reached, walk.sound, moves, resolver.joins)


def _rebuilt(
    statements: Iterable[typed.Statement], done: Mapping[Span, resolved.Statement]
) -> tuple[resolved.Statement, ...]:
    """Return what is to be played as it is written, each statement in the body that it stands in."""
    found: list[resolved.Statement] = []
    for statement in statements:
        match statement:
            case typed.Repeat(count, body, span):
                found.append(resolved.Repeat(count, _rebuilt(body, done), span))
            case typed.Choose(branches, span):
                rebuilt = (resolved.Branch(one.weight, _rebuilt(one.body, done), one.span) for one in branches)
                found.append(resolved.Choose(tuple(rebuilt), span))
            case _ if statement.span in done:
                found.append(done[statement.span])
    return tuple(found)


def start_of(
    statements: Iterable[typed.Statement], names: Names, catalog: Catalog, given: str | None
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
        return of_library, (Diagnostic("MS044", message, None, f"there is {listed(near, 'or')}" if near else None),)
    first = next((one for one in statements if not isinstance(one, typed.Wait | typed.End)), None)
    return (first.start if isinstance(first, typed.Command) else None) or of_library, ()


@dataclass(slots=True)
class _Resolver:
    """Takes the steps of a script, and finds out what each does and what is wrong with it.

    Attributes
    ----------
    done : by span, what is to be played.
    told : by step, what is wrong with it.
    ways : by step, how many of the ways to understand it have failed.
    first_stop : by step, why the first of them has.
    has_begun : whether something has been played before the first step.

    For `keys`, `known`, `recall` and `joins` see `resolve_part` and `Resolution`.
    """

    library: tuple[Names, Catalog]
    walk: Walk
    source: Source
    start: str
    keys: Sequence[int]
    known: Mapping[int, flow.State] = field(default_factory=dict)
    recall: Recall = field(default_factory=Recall)
    narrowings: Narrowings = field(default_factory=Narrowings)
    done: dict[Span, resolved.Statement] = field(default_factory=dict)
    told: dict[int, Diagnostic] = field(default_factory=dict)
    ways: dict[int, int] = field(default_factory=dict)
    first_stop: dict[int, Stopped] = field(default_factory=dict)
    joins: int | None = None
    has_begun: bool = False

    @property
    def names(self) -> Names:
        return self.library[0]

    def run(self) -> None:
        walk, number = self.walk, 0
        while number < len(walk.steps):
            state = walk.enter(number)
            if number == len(walk.reached) and self._joins_known(number, state):
                walk.entered[number] = None
                self.joins = number
                return
            number = self._step(number, state)

    def _joins_known(self, number: int, state: flow.State) -> bool:
        """Note that a step is taken for the first time; return whether all from there is known."""
        self.walk.reached.append(state)
        if self.narrowings.trial is not None:
            return False
        self.walk.sound.append(number)
        return number in self.known and self.known[number] == state

    def _step(self, number: int, state: flow.State) -> int:
        """Take a step; return the number of the one to take next, which may be an earlier one."""
        statement = self.walk.steps[number].statement
        after: flow.State | int
        match statement:
            case None:
                after = state
            case typed.Command():
                after = self._command(number, statement, state)
            case typed.Wait():
                after = self._wait(statement, state)
            case typed.End():
                after = self._end(number, statement, state)
            case _:
                after = flow.unknown(self.names)
        return after if isinstance(after, int) else self.walk.leave(number, after)

    def _number(self, setter: flow.Setter) -> int:
        """Return the number of the step that has set something."""
        if setter[0] < self.keys[0]:
            raise ReachesBack(setter[0])
        return bisect_left(self.keys, setter[0])

    # --- commands ---

    def _command(self, number: int, command: typed.Command, state: flow.State) -> flow.State | int:
        if number in self.told:
            return flow.unknown(self.names)
        key = self.keys[number]
        is_free = number not in self.ways and key not in self.narrowings.narrowed
        made = self.recall.of(key, command, state) if is_free else None
        if made is not None:
            return self._accept(number, made)
        way = command.ways[self.ways.get(number, 0)]
        ruled_out = self.narrowings.of(key, (layer.graph for layer in way.layers))
        outcome = move(way.layers, state, key, ruled_out, self.library, command.once)
        if isinstance(outcome, Narrow):
            return self._narrow(number, command, way, outcome)
        if not isinstance(outcome, Move):
            trial = self.narrowings.trial
            return self._refuse(number, command, outcome) if trial is None else self._take_back(trial)
        made = Made(command, state, _played(command, way, outcome), outcome.after)
        if is_free:
            self.recall.keep(key, made)
        return self._accept(number, made)

    def _accept(self, number: int, made: Made) -> flow.State:
        self.done[made.command.span] = made.played
        self.narrowings.went_on(number)
        return made.after

    def _refuse(self, number: int, command: typed.Command, stopped: Stopped) -> int:
        """Try the next way to understand a command; if there is none, say why the first cannot be obeyed."""
        first = self.first_stop.setdefault(number, stopped)
        self.ways[number] = self.ways.get(number, 0) + 1
        if self.ways[number] == len(command.ways):
            self.told[number] = told_from(self._reason(command, first), command.span)
            self.done.pop(command.span, None)
        return self.walk.back_to(number)

    def _narrow(self, number: int, command: typed.Command, way: typed.Layering, narrow: Narrow) -> int:
        """Take candidates away from earlier commands, and go back to the first of them."""
        line, _ = self.source.position(command.span.start)
        because = f"what line {line} asks of `{narrow.graph}` cannot begin in it"
        setters = {self._number(setter) for setter in narrow.without}
        self.narrowings.narrow(number, self._as_stop(way, narrow), narrow, setters, because)
        return self.walk.back_to(min(setters))

    def _as_stop(self, way: typed.Layering, narrow: Narrow) -> Stopped:
        """Return what stops a command if the earlier ones cannot be narrowed for it."""
        layer = next(layer for layer in way.layers if layer.graph == narrow.graph)
        setter = min(narrow.without)
        motions = self.names.in_order(setter[1], narrow.without[setter])
        by_rule_1 = not any(motion in self.names.motion_set(narrow.graph) for motion in motions)
        return Stopped(narrow.graph, layer.span, layer.motions, setter[1], motions, by_rule_1, setter, within=False)

    def _take_back(self, trial: Trial) -> int:
        """Undo a narrowing that leaves nothing to an earlier command: the later one is refused."""
        self.narrowings.take_back(trial)
        first = min((trial.number, *(self._number(setter) for setter, _ in trial.forbidden)))
        command = self.walk.steps[trial.number].statement
        assert isinstance(command, typed.Command)
        return min(self._refuse(trial.number, command, trial.stopped), self.walk.back_to(first))

    # --- other statements ---

    def _wait(self, wait: typed.Wait, state: flow.State) -> flow.State:
        if wait.duration.seconds is not None:
            self.done[wait.span] = resolved.Wait(resolved.Seconds(wait.duration.seconds), wait.span)
        elif wait.duration.cycles is not None:
            self.done[wait.span] = resolved.Wait(resolved.Cycles(wait.duration.cycles), wait.span)
        return state

    def _end(self, number: int, end: typed.End, state: flow.State) -> flow.State:
        graph = end.graph
        if graph == self.names.root:
            advice = "name what it shall do next, or a part to give back"
            message = f"`{graph}` is the whole body: there is nothing to give it back to"
            self.told[number] = Diagnostic("MS042", message, end.span, advice)
            return state
        self.done[end.span] = resolved.End(graph, end.span)
        self.told.pop(number, None)
        part = state.parts.get(graph)
        if state.certain and (part is None or not part.alone):
            message = f"`{graph}` does not run on its own here, so there is nothing to end"
            fixes = (Fix(end.span, "", safe=False),)
            self.told[number] = Diagnostic("MS043", message, end.span, "take it out", fixes=fixes)
        return flow.ended(state, graph, self.names)

    # --- what to say ---

    def _reason(self, command: typed.Command, stopped: Stopped) -> Diagnostic:
        """Say why a command cannot be obeyed."""
        above = command if stopped.setter is None else self.walk.steps[self._number(stopped.setter)].statement
        return reason(stopped, above, tuple(self._origin(stopped)), *self.library)

    def _origin(self, stopped: Stopped) -> Iterator[Note]:
        """Yield where the motions come from that stand in the way, if it is not this command itself."""
        if stopped.setter is not None:
            yield Note(f"this is what `{stopped.above}` plays then", self._span(self._number(stopped.setter)))
        elif not stopped.within:
            playing = " or ".join(f"`{motion}`" for motion in stopped.motions)
            yield Note(f"it plays {playing} now" if self.has_begun else f"the character starts in `{self.start}`")

    def _span(self, number: int) -> Span:
        statement = self.walk.steps[number].statement
        assert statement is not None, "nothing is set where a loop begins"
        return statement.span


def _played(command: typed.Command, way: typed.Layering, made: Move) -> resolved.Command:
    spans = {layer.graph: layer.span for layer in way.layers}
    layers = tuple(
        resolved.Layer(graph, candidates, spans[graph], made.left_out[graph])
        for graph, candidates in made.candidates.items()
    )
    return resolved.Command(layers, _duration(command), command.span)


def _duration(command: typed.Command) -> resolved.Duration | None:
    if command.once:
        return resolved.Once()
    if command.duration is None:
        return None
    if command.duration.cycles is not None:
        return resolved.Cycles(command.duration.cycles)
    return None if command.duration.seconds is None else resolved.Seconds(command.duration.seconds)
