"""A resolved plan -> how it will probably go: what is taken, how long each statement takes, what that costs.

It is followed motion by motion (`course`). Where in its motion a graph is, is known right after a start or an arrival;
once time has passed, it may be anywhere. So there are several things that may be playing, each with its chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias, TypeVar

from mlmg_lang.planning.course import Course, World, bring, driver, end_part
from mlmg_lang.planning.estimate import NO_TIME, Estimate, Moment, Playing, Travel, exactly, mixed
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import (
    Choose,
    Command,
    Cycles,
    Duration,
    End,
    Once,
    Repeat,
    ResolvedPlan,
    Seconds,
    Statement,
    Wait,
)
from mlmg_lang.source import Span

MAX_WORLDS = 64
"""So many different things that may be playing are followed, the likeliest."""
_TINY = 1e-6
"""Chances that sum to so much less than 1 are all that there are."""
_N_PASSES = 3
"""So often a script with loops is gone through, each time with what came out of the loops the time before."""

_Found = TypeVar("_Found")

Outlook: TypeAlias = Mapping[World, float]
"""What may be playing, with the chances, which sum to 1."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a statement goes, over all the times that it is executed.

    Attributes
    ----------
    before : what may be playing then.
    courses : that it may take; none of `wait`.
    arrives, cost : until all parts have arrived.
    lasts : from then to the next statement.
    """

    before: Outlook
    courses: tuple[Course, ...]
    arrives: Estimate
    cost: float
    lasts: Estimate


@dataclass(frozen=True, slots=True)
class Passage:
    """How statements in a row go.

    Attributes
    ----------
    after : what may be playing then.
    takes : from the beginning of the first to the end of the last.
    under_way, cost : the seconds and the transitions until commands have arrived, on average.
    rest : what the last command of a script takes to its clip's last frame, besides.
    sure : whether all of it is possible, whatever may be playing.
    """

    after: Outlook
    takes: Estimate = NO_TIME
    under_way: float = 0.0
    cost: float = 0.0
    rest: Estimate = NO_TIME
    sure: bool = True


@dataclass(frozen=True, slots=True)
class Forecast:
    """How a script will probably go.

    Attributes
    ----------
    outcomes : by span, of the statements that hold no others.
    passages : by span, of the bodies of `repeat`, once through, and of the branches of `choose`.
    whole : of the script.
    """

    outcomes: Mapping[Span, Outcome]
    passages: Mapping[Span, Passage]
    whole: Passage


def forecast(plan: ResolvedPlan, names: Names, travel: Travel, now: World | None = None) -> Forecast:
    """Return how a plan will probably go on the library that it was resolved against.

    Parameters
    ----------
    now : what is playing before it; without it, the plan's start.
    """
    follower = Follower(names, travel)
    begin: Outlook = {now or at_start(plan, names): 1.0}
    whole = follower.body(plan.statements, begin, is_last=True)
    if _loops(plan.statements):
        for _ in range(_N_PASSES - 1):
            whole = follower.body(plan.statements, begin, is_last=True)
    return Forecast(follower.outcomes, follower.passages, whole)


def at_start(plan: ResolvedPlan, names: Names) -> World:
    """Return what plays when a script begins."""
    return World(((names.root, Playing(plan.start, Moment.FIRST, held_s=0.0)),))


def merged(worlds: Iterable[tuple[World, float]]) -> Outlook:
    """Return the likeliest of some worlds, their chances in proportion."""
    chances: dict[World, float] = {}
    for world, chance in worlds:
        chances[world] = chances.get(world, 0.0) + chance
    kept = sorted(chances.items(), key=lambda one: (-one[1], one[0].running))[:MAX_WORLDS]
    total = sum(chance for _, chance in kept)
    return {world: chance / total for world, chance in kept if chance > 0}


def lasting(world: World, duration: Duration | None, counted: str, names: Names, travel: Travel) -> Estimate:
    """Return how long a duration is; cycles and passes are those of what drives the graph `counted`."""
    drives, playing = driver(world, counted, names)
    match duration:
        case None:
            return NO_TIME
        case Seconds(number):
            return exactly(number)
        case Cycles(number):
            return travel.cycle(playing.motion).times(number)
        case Once():
            return travel.one_pass(drives, playing.motion)


def afterwards(world: World, command: Command, names: Names, travel: Travel) -> World:
    """Return the world when a command that has arrived in it has lasted as long as it says."""
    top = command.layers[0].graph
    lasts = lasting(world, command.duration, top, names, travel)
    passed: dict[str, Playing] = {}
    if isinstance(command.duration, Once):
        drives, playing = driver(world, top, names)
        passed = {drives: Playing(playing.motion, Moment.PASSED, held_s=0.0)}
    return World(tuple({**dict(world.held(lasts).running), **passed}.items()))


def _loops(statements: Iterable[Statement]) -> bool:
    for one in statements:
        if isinstance(one, Repeat) and not one.rounds and (one.count > 1 or _loops(one.body)):
            return True
        if isinstance(one, Choose) and any(_loops(branch.body) for branch in one.branches):
            return True
    return False


@dataclass(slots=True)
class Follower:
    """Follows statements in the order in which they are executed, and keeps what it finds by their spans.

    Attributes
    ----------
    outcomes, passages : what has been found, as a `Forecast` has it.
    counted : the graph whose cycles a `wait` counts.
    """

    names: Names
    travel: Travel
    outcomes: dict[Span, Outcome] = field(default_factory=dict)
    passages: dict[Span, Passage] = field(default_factory=dict)
    counted: str = ""

    def body(self, statements: Sequence[Statement], outlook: Outlook, is_last: bool) -> Passage:
        """Follow statements in a row; `is_last`: nothing of the script comes after them."""
        done = Passage(outlook)
        for at, statement in enumerate(statements):
            one = self._statement(statement, done.after, is_last and at == len(statements) - 1)
            takes, under_way, cost = done.takes + one.takes, done.under_way + one.under_way, done.cost + one.cost
            done = Passage(one.after, takes, under_way, cost, one.rest, done.sure and one.sure)
        return done

    def _statement(self, statement: Statement, outlook: Outlook, is_last: bool) -> Passage:
        match statement:
            case Repeat():
                return self._repeat(statement, outlook, is_last)
            case Choose():
                return self._choose(statement, outlook, is_last)
            case Command():
                return self._command(statement, outlook, is_last)
            case Wait(duration, span):
                times = {world: self._lasting(world, duration) for world in outlook}
                lasts = mixed((chance, times[world]) for world, chance in outlook.items())
                self.outcomes[span] = Outcome(outlook, (), NO_TIME, 0.0, lasts)
                return Passage(merged((world.held(times[world]), chance) for world, chance in outlook.items()), lasts)
            case End(graph, span):
                ended = [(chance, end_part(world, graph, self.names, self.travel)) for world, chance in outlook.items()]
                outcome = _outcome(outlook, [replace(course, chance=chance) for chance, course in ended])
                self.outcomes[span] = outcome
                after = merged((course.world, course.chance) for course in outcome.courses)
                return Passage(after, outcome.arrives, outcome.arrives.mean, outcome.cost)

    def _repeat(self, repeat: Repeat, outlook: Outlook, is_last: bool) -> Passage:
        if repeat.count == 0:
            return Passage(outlook)
        if repeat.rounds:
            return self._rounds(repeat, outlook, is_last)
        before, share = self.passages.get(repeat.span), 1.0 / repeat.count
        head = outlook if before is None else _joined([(share, outlook), (1.0 - share, before.after)])
        once = self.passages[repeat.span] = self.body(repeat.body, head, is_last)
        n = repeat.count
        return Passage(once.after, once.takes.times(n), once.under_way * n, once.cost * n, once.rest, once.sure)

    def _rounds(self, repeat: Repeat, outlook: Outlook, is_last: bool) -> Passage:
        """Follow the body each time by itself, and keep what is found on average."""
        followers, passages = [], [Passage(outlook)]
        for body in repeat.rounds:
            one = Follower(self.names, self.travel, counted=self.counted)
            passages.append(one.body(body, passages[-1].after, is_last))
            followers.append(one)
            self.counted = one.counted
        self.outcomes |= _averages([one.outcomes for one in followers], _average_outcome)
        self.passages |= _averages([one.passages for one in followers], _average_passage)
        once = self.passages[repeat.span] = _average_passage(passages[1:])
        n, last = repeat.count, passages[-1]
        return Passage(last.after, once.takes.times(n), once.under_way * n, once.cost * n, last.rest, once.sure)

    def _choose(self, choose: Choose, outlook: Outlook, is_last: bool) -> Passage:
        chances = chances_of(choose)
        drawn = [
            (chance, self.body(one.body, outlook, is_last))
            for one, chance in zip(choose.branches, chances, strict=True)
        ]
        self.passages.update((one.span, passage) for one, (_, passage) in zip(choose.branches, drawn, strict=True))
        return Passage(
            _joined([(chance, passage.after) for chance, passage in drawn]),
            mixed((chance, passage.takes) for chance, passage in drawn),
            sum(chance * passage.under_way for chance, passage in drawn),
            sum(chance * passage.cost for chance, passage in drawn),
            mixed((chance, passage.rest) for chance, passage in drawn),
            all(passage.sure for _, passage in drawn),
        )

    def _command(self, command: Command, outlook: Outlook, is_last: bool) -> Passage:
        self.counted = command.layers[0].graph
        courses = [
            replace(course, chance=chance * course.chance)
            for world, chance in outlook.items()
            for course in bring(world, command, self.names, self.travel)
        ]
        outcome = _outcome(outlook, courses)
        sure = sum(course.chance for course in courses) > 1.0 - _TINY
        plays_out = is_last and command.duration is None
        time = self._to_last_frame if plays_out else lambda world: self._lasting(world, command.duration)
        lasts = mixed((course.chance, time(course.world)) for course in outcome.courses)
        self.outcomes[command.span] = replace(outcome, lasts=lasts)
        after = merged(
            (afterwards(course.world, command, self.names, self.travel), course.chance) for course in outcome.courses
        )
        takes, rest = (outcome.arrives, lasts) if plays_out else (outcome.arrives + lasts, NO_TIME)
        return Passage(after or outlook, takes, outcome.arrives.mean, outcome.cost, rest, sure)

    # --- how long ---

    def _lasting(self, world: World, duration: Duration | None) -> Estimate:
        return lasting(world, duration, self.counted or self.names.root, self.names, self.travel)

    def _to_last_frame(self, world: World) -> Estimate:
        drives, playing = driver(world, self.counted, self.names)
        return self.travel.to_last_frame(drives, playing)


def chances_of(choose: Choose) -> list[float]:
    """Return how likely each branch is drawn."""
    total = sum(branch.weight for branch in choose.branches)
    return [branch.weight / total for branch in choose.branches]


def _outcome(outlook: Outlook, courses: Sequence[Course]) -> Outcome:
    """Return how a statement goes; courses that are not known to be possible are left out."""
    total = sum(course.chance for course in courses)
    known = tuple(replace(course, chance=course.chance / total) for course in courses if course.chance > 0)
    arrives = mixed((course.chance, course.takes) for course in known)
    return Outcome(outlook, known, arrives, sum(course.chance * course.cost for course in known), NO_TIME)


def _joined(outlooks: Sequence[tuple[float, Outlook]]) -> Outlook:
    return merged((world, share * chance) for share, outlook in outlooks for world, chance in outlook.items())


def _averages(
    rounds: Sequence[Mapping[Span, _Found]], average: Callable[[Sequence[_Found]], _Found]
) -> dict[Span, _Found]:
    """Return what was found in rounds of a loop, each as likely, by the same spans."""
    spans = dict.fromkeys(span for found in rounds for span in found)
    return {span: average([found[span] for found in rounds if span in found]) for span in spans}


def _average_outcome(rounds: Sequence[Outcome]) -> Outcome:
    share = 1.0 / len(rounds)
    before = _joined([(share, one.before) for one in rounds])
    courses = [replace(course, chance=share * course.chance) for one in rounds for course in one.courses]
    lasts = mixed((share, one.lasts) for one in rounds)
    return replace(_outcome(before, courses), lasts=lasts)


def _average_passage(rounds: Sequence[Passage]) -> Passage:
    share = 1.0 / len(rounds)
    return Passage(
        _joined([(share, one.after) for one in rounds]),
        mixed((share, one.takes) for one in rounds),
        share * sum(one.under_way for one in rounds),
        share * sum(one.cost for one in rounds),
        mixed((share, one.rest) for one in rounds),
        all(one.sure for one in rounds),
    )
