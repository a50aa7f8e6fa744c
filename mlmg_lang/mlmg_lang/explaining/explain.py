"""An analysis and a library -> the explanation of what the script will do."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias, TypeVar

from mlmg_lang.definitions.parameters import references
from mlmg_lang.explaining import explanation as told
from mlmg_lang.explaining.expressions import expression_of, place_of, text_of
from mlmg_lang.explaining.happened import executions_of, played_of
from mlmg_lang.explaining.layers import endings, layer_of
from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.front_end import Analysis
from mlmg_lang.parsing import syntax
from mlmg_lang.perform import rehearse
from mlmg_lang.planning import flow, resolved, typed
from mlmg_lang.planning.ahead import Ahead
from mlmg_lang.planning.course import World
from mlmg_lang.planning.estimate import NO_TIME, Estimate
from mlmg_lang.planning.forecast import Forecast, Outcome, Passage, chances_of, forecast
from mlmg_lang.planning.move import move
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.resolve import resolve
from mlmg_lang.planning.rules.ruling import Stopped
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal, some
from mlmg_runtime.library import Library

_Item = TypeVar("_Item", syntax.Item, typed.Statement)
_Executions: TypeAlias = Mapping[Span, tuple[told.Execution, ...]]


def explanation_from_analysis(
    analysis: Analysis,
    library: Library,
    start: str | None = None,
    ahead: Ahead | None = None,
    seed: int | None = None,
    now: World | None = None,
    despite_mistakes: bool = False,
) -> told.Explanation:
    """Return what a script will do on the library that it was analysed against, and why.

    Parameters
    ----------
    start : as it was given to the analysis.
    ahead : what looking ahead over the whole script has made of the plan, if that is what is played.
    seed : to play the script with, so that the explanation tells what happened; None: it is not played.
    now : what is playing already, if the text goes on with that.
    despite_mistakes : whether a script with errors is explained too, as if what cannot be understood were not there;
        each command has all the candidates that it may have, whatever that will come to.

    Raises
    ------
    ValueError
        If the script has errors, and that is not wanted.
    mlmg_lang.staging.ScriptError
        If it is to be played, and the library does not allow that.
    """
    if analysis.plan is None or (analysis.resolved is None and not despite_mistakes):
        raise ValueError(f"{analysis.source.name} has errors, so there is no plan to explain")
    names, travel = Names(library), MotionTravel(library)
    resolution = resolve(analysis.plan, names, library, analysis.source, start, analysis.question.state)
    plan, gain = resolution.plan, None
    if ahead is not None:
        plan, gain = ahead.plan, _gain(ahead, resolution.plan, (names, library, travel), seed)
    expected = forecast(plan, names, travel, now)
    played, executions = (None, {}) if seed is None else _play(plan, library, seed)
    chosen = frozenset(_chosen_ahead(plan.statements) if plan.ahead else ())
    explainer = _Explainer(analysis, (names, library, travel), resolution, expected, executions, chosen)
    return told.Explanation(
        analysis.source.name,
        Path(library.path).name,
        library.frame_rate,
        plan.start,
        _start_because(analysis.plan, plan.start, start, names, library),
        "greedy" if ahead is None else "global",
        explainer.body(plan.statements, is_last=True),
        _totals(expected.whole),
        gain,
        played,
    )


def _gain(
    ahead: Ahead, plan: resolved.ResolvedPlan, known: tuple[Names, Library, MotionTravel], seed: int | None
) -> told.Gain:
    """Return what is gained by looking ahead over playing a plan as it is."""
    names, library, travel = known
    greedy = _totals(forecast(plan, names, travel).whole)
    played = None if seed is None else _play(plan, library, seed)[0]
    return told.Gain(ahead.planned, ahead.because, greedy, played)


def _play(plan: resolved.ResolvedPlan, library: Library, seed: int) -> tuple[told.Played, _Executions]:
    rehearsal = rehearse(plan, library, seed)
    executions = executions_of(rehearsal, library, plan.start)
    return played_of(rehearsal, executions, library.frame_rate, seed), executions


def _totals(whole: Passage) -> told.Totals:
    return told.Totals(rounded(whole.takes + whole.rest), round(whole.under_way, 3), round(whole.cost, 3))


def rounded(estimate: Estimate) -> Estimate:
    """Return an estimate in thousandths."""
    return Estimate(round(estimate.mean, 3), round(estimate.least, 3), round(estimate.most, 3))


def _start_because(plan: typed.TypedPlan, motion: str, given: str | None, names: Names, library: Library) -> str:
    if given is not None:
        return "as --start says"
    first = next((one for one in plan.statements if not isinstance(one, typed.Wait | typed.End)), None)
    if isinstance(first, typed.Command) and first.start is not None:
        return "which the script names first"
    if motion == library.start:
        return "the start of the library"
    return f"the first motion of {names.root}"


class _Explainer:
    """Explains statements, each with what all stages know of it; found by its span."""

    def __init__(
        self,
        analysis: Analysis,
        known: tuple[Names, Library, MotionTravel],
        resolution: Resolution,
        expected: Forecast,
        executions: _Executions,
        chosen_ahead: frozenset[Span],
    ) -> None:
        assert analysis.plan is not None
        self._source = analysis.source
        self._definitions = analysis.definitions
        self._names, self._library, self._travel = known
        self._states = resolution.states
        self._expected, self._executions = expected, executions
        self._chosen_ahead = chosen_ahead
        self._written = {one.span: one for one in _flat(analysis.script.items, _inside_syntax)}
        self._expanded = {one.span: one for one in _flat(analysis.expanded.items, _inside_syntax)}
        self._typed = {one.span: one for one in _flat(analysis.plan.statements, _inside_typed)}

    def body(self, statements: Sequence[resolved.Statement], is_last: bool) -> tuple[told.Statement, ...]:
        """Explain statements in a row; `is_last`: nothing of the script comes after them."""
        last = len(statements) - 1
        return tuple(self._statement(one, is_last and at == last) for at, one in enumerate(statements))

    def _statement(self, statement: resolved.Statement, is_last: bool) -> told.Statement:
        place, text = place_of(self._source, statement.span), text_of(self._source, statement.span)
        match statement:
            case resolved.Repeat(count, body, span):
                once = self._passage(span)
                return told.Repeat(count, place, self.body(body, is_last), once)
            case resolved.Choose():
                return told.Choose(place, tuple(self._branches(statement, is_last)))
            case resolved.Command():
                return self._command(statement, text, place, is_last)
            case resolved.Wait(duration, span):
                lasts = rounded(self._outcome(span).lasts)
                return told.Wait(text, place, self._before(span), _duration(duration), lasts, self._executed(span))
            case resolved.End(graph, span):
                outcome = self._outcome(span)
                ends, arrives, cost = endings(outcome), rounded(outcome.arrives), round(outcome.cost, 3)
                return told.End(text, place, self._before(span), graph, ends, arrives, cost, self._executed(span))

    def _branches(self, choose: resolved.Choose, is_last: bool) -> Iterator[told.Branch]:
        for branch, chance in zip(choose.branches, chances_of(choose), strict=True):
            takes = self._passage(branch.span)
            place, body = place_of(self._source, branch.span), self.body(branch.body, is_last)
            yield told.Branch(branch.weight, round(chance, 3), place, body, takes)

    def _command(self, command: resolved.Command, text: str, place: told.Place, is_last: bool) -> told.Command:
        outcome = self._outcome(command.span)
        written, typed_one = self._written[command.span], self._typed[command.span]
        expanded = self._expanded[command.span]
        assert isinstance(written, syntax.Command)
        assert isinstance(expanded, syntax.Command)
        assert isinstance(typed_one, typed.Command)
        way, refused = self._way(typed_one, command)
        duration = _duration(command.duration) if command.duration is not None or not is_last else _TO_THE_END
        known, is_ahead = (self._names, self._travel), command.span in self._chosen_ahead
        layers = (layer_of(layer, command, outcome, known, self._source, is_ahead) for layer in command.layers)
        return told.Command(
            text,
            place,
            tuple(self._uses(written)),
            self._before(command.span),
            expression_of(expanded.motion, way, refused, self._names, self._source),
            tuple(layers),
            endings(outcome),
            rounded(outcome.arrives),
            round(outcome.cost, 3),
            duration,
            rounded(outcome.lasts),
            self._executed(command.span),
        )

    # --- how a command was understood ---

    def _way(
        self, command: typed.Command, taken: resolved.Command
    ) -> tuple[typed.Layering, tuple[told.RefusedWay, ...]]:
        """Return the assignment that a command was understood as, and why those before it were not taken."""
        wanted = {(layer.graph, layer.span) for layer in taken.layers}
        ways = command.ways
        number = next(at for at, way in enumerate(ways) if {(one.graph, one.span) for one in way.layers} == wanted)
        refused = tuple(
            told.RefusedWay(tuple(layer.graph for layer in way.layers), self._refusal(way, command.span))
            for way in ways[:number]
        )
        return ways[number], refused

    def _refusal(self, way: typed.Layering, span: Span) -> str:
        """Return why an assignment cannot be obeyed."""
        stopped = move(way.layers, self._states[span], 0, {}, (self._names, self._library))
        if not isinstance(stopped, Stopped):
            return "from what may be playing, it is not sure to be possible"
        motions = some(stopped.motions)
        if stopped.by_rule_1:
            return f"`{stopped.graph}` cannot leave {motions} (rule 1)"
        return f"from {motions}, nothing asked of `{stopped.graph}` can be reached"

    def _uses(self, command: syntax.Command) -> Iterator[told.Use]:
        """Yield the definitions that a command uses, and those that these use, each once."""
        names = [node.name for node in syntax.walk(command) if isinstance(node, syntax.Reference | syntax.Call)]
        seen: set[str] = set()
        for name in names:
            let = self._definitions.find(name)
            if let is not None and normal(let.name.text) not in seen:
                seen.add(normal(let.name.text))
                names += references(let)
                yield told.Use(let.name.text, text_of(self._source, let.span), place_of(self._source, let.span))

    # --- what is known of a statement ---

    def _outcome(self, span: Span) -> Outcome:
        return self._expected.outcomes.get(span) or Outcome({}, (), NO_TIME, 0.0, NO_TIME)

    def _executed(self, span: Span) -> tuple[told.Execution, ...]:
        return self._executions.get(span, ())

    def _passage(self, span: Span) -> Estimate:
        passage = self._expected.passages.get(span)
        return NO_TIME if passage is None else rounded(passage.takes)

    def _before(self, span: Span) -> tuple[told.Part, ...]:
        """Return what may be playing before a statement: the root, and the parts that may run on their own."""
        state, outlook = self._states[span], self._outcome(span).before
        parts = []
        for graph in self._names.graphs:
            part = state.parts.get(graph)
            if part is None or not (part.alone or graph == self._names.root):
                continue
            chances = dict.fromkeys(self._motions(part), 0.0)
            for world, chance in outlook.items():
                playing = world.get(graph)
                if playing is not None:
                    chances[playing.motion] = chances.get(playing.motion, 0.0) + chance
            runs = round(sum(chances.values()), 3)
            likely = (told.Likely(motion, round(chance, 3)) for motion, chance in chances.items())
            # Where it may follow the graph above, those that it plays with that are among the others.
            known = tuple(one for one in likely if one.chance > 0 or runs in (0.0, 1.0))
            parts.append(told.Part(graph, known, runs))
        return tuple(parts)

    def _motions(self, part: flow.Part) -> list[str]:
        """Return the motions that may drive a part, in configuration order."""
        known = dict.fromkeys(motion for graph in self._names.graphs for motion in self._names.motions(graph))
        return [motion for motion in known if motion in part.origins]


def _chosen_ahead(statements: Iterable[resolved.Statement]) -> Iterator[Span]:
    """Yield the spans of the commands that looking ahead chooses for: those outside `choose`."""
    for one in statements:
        if isinstance(one, resolved.Repeat):
            yield from _chosen_ahead(one.body)
        elif isinstance(one, resolved.Command):
            yield one.span


_TO_THE_END = told.Duration("to the end", None)


def _duration(duration: resolved.Duration | None) -> told.Duration:
    match duration:
        case resolved.Seconds(number):
            return told.Duration("seconds", round(number, 3))
        case resolved.Cycles(number):
            return told.Duration("cycles", round(number, 3))
        case resolved.Once():
            return told.Duration("once", None)
    return told.Duration("none", None)


def _flat(items: Iterable[_Item], inside: Callable[[_Item], Iterable[_Item]]) -> Iterator[_Item]:
    """Yield statements and those in them."""
    pending = list(items)
    while pending:
        item = pending.pop()
        yield item
        pending += inside(item)


def _inside_syntax(item: syntax.Item) -> Iterable[syntax.Item]:
    if isinstance(item, syntax.Repeat):
        return item.body
    return [one for branch in item.branches for one in branch.body] if isinstance(item, syntax.Choose) else ()


def _inside_typed(item: typed.Statement) -> Iterable[typed.Statement]:
    if isinstance(item, typed.Repeat):
        return item.body
    return [one for branch in item.branches for one in branch.body] if isinstance(item, typed.Choose) else ()
