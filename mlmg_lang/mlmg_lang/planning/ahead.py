"""The choice of the root graph's candidates over a whole script, instead of command by command.

Command by command, the motion reached soonest is taken, wherever it leads. Here that choice is made for all commands
at once that makes the sum of all seconds until commands arrive and of all transition costs smallest, as far as the
forecast knows: dynamic programming over what may be playing after each statement.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from mlmg_lang.planning.course import Course, World, bring, end_part
from mlmg_lang.planning.estimate import Travel
from mlmg_lang.planning.forecast import afterwards, at_start, lasting
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Choose, Command, End, LeftOut, Repeat, ResolvedPlan, Statement, Wait


@dataclass(frozen=True, slots=True)
class Ahead:
    """A plan whose commands have one candidate each on the root graph.

    Attributes
    ----------
    planned : False where the plan is as it was; `because` says why.
    price : the least sum of expected seconds under way and costs.
    """

    plan: ResolvedPlan
    planned: bool
    because: str
    price: float


@dataclass(frozen=True, slots=True)
class _Way:
    """The cheapest way found to a world: what it costs, and the candidates that it takes, the last first."""

    price: float
    taken: tuple[str, _Way] | None


def plan_ahead(plan: ResolvedPlan, names: Names, travel: Travel) -> Ahead:
    """Return a plan with the candidates of the root graph chosen over the whole script.

    A script that repeats or chooses is left as it is.
    """
    if any(isinstance(one, Repeat | Choose) for one in plan.statements):
        return Ahead(plan, False, "the script repeats or chooses, and only a straight one is planned ahead", 0.0)
    ways: dict[World, _Way] = {at_start(plan, names): _Way(0.0, None)}
    counted = names.root
    for statement in plan.statements:
        ways = _after(statement, counted, ways, names, travel)
        counted = statement.layers[0].graph if isinstance(statement, Command) else counted
        if not ways:
            return Ahead(plan, False, "no choice of candidates is sure to be possible", 0.0)
    best = min(ways.values(), key=lambda way: way.price)
    taken = list(_taken(best))[::-1]
    narrowed = _narrowed(plan.statements, taken, names)
    return Ahead(replace(plan, statements=narrowed, ahead=True), True, "", best.price)


def _after(
    statement: Statement, counted: str, ways: dict[World, _Way], names: Names, travel: Travel
) -> dict[World, _Way]:
    """Return the cheapest ways to what may be playing after a statement.

    Parameters
    ----------
    counted : the graph whose cycles a `wait` counts.
    """
    onward: dict[World, _Way] = {}
    for world, way in ways.items():
        for choice, course in _courses(statement, counted, world, names, travel):
            price = way.price + course.takes.mean + course.cost
            if course.world not in onward or price < onward[course.world].price:
                onward[course.world] = _Way(price, way.taken if choice is None else (choice, way))
    return onward


def _courses(
    statement: Statement, counted: str, world: World, names: Names, travel: Travel
) -> Iterator[tuple[str | None, Course]]:
    """Yield how a statement goes with each candidate of the root graph."""
    match statement:
        case Command():
            for choice, narrowed in narrowings(statement, names):
                for course in bring(world, narrowed, names, travel):
                    yield choice, replace(course, world=afterwards(course.world, narrowed, names, travel))
        case End(graph):
            yield None, end_part(world, graph, names, travel)
        case Wait(duration):
            yield None, Course(1.0, world.held(lasting(world, duration, counted, names, travel)))


def narrowings(command: Command, names: Names) -> Iterator[tuple[str | None, Command]]:
    """Yield a command once for each candidate of the root graph, with that alone; as it is, if it names parts only."""
    top = command.layers[0]
    if top.graph != names.root:
        yield None, command
        return
    for motion in top.candidates:
        yield motion, _with_candidate(command, motion)


def _taken(way: _Way) -> Iterator[str]:
    while way.taken is not None:
        motion, way = way.taken
        yield motion


def _narrowed(statements: Sequence[Statement], taken: Sequence[str], names: Names) -> tuple[Statement, ...]:
    """Return statements with the candidates that were chosen, one for each command that names the root graph."""
    chosen = iter(taken)

    def narrow(statement: Statement) -> Statement:
        if not isinstance(statement, Command) or statement.layers[0].graph != names.root:
            return statement
        return _with_candidate(statement, next(chosen))

    return tuple(map(narrow, statements))


def _with_candidate(command: Command, motion: str) -> Command:
    """Return a command with one candidate on its topmost graph."""
    top, *others = command.layers
    because = f"over the whole script `{motion}` comes to less"
    out = tuple(LeftOut(other, "look ahead", because) for other in top.candidates if other != motion)
    return replace(command, layers=(replace(top, candidates=(motion,), left_out=top.left_out + out), *others))
