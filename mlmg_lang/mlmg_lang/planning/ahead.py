"""The choice of the root graph's candidates over a whole script, instead of command by command.

Command by command, the motion reached soonest is taken, wherever it leads. Here that choice is made for all commands
at once that makes the sum of all seconds until commands arrive and of all transition costs smallest, as far as the
forecast knows: dynamic programming over what may be playing after each statement.

A command in a loop is as many commands, each with a choice of its own. What a `choose` will draw is not known: its
branches go command by command and count with their chances, and the choice for all else takes that into account.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeGuard

from mlmg_lang.planning.estimate import Travel
from mlmg_lang.planning.forecast import Follower, Outlook, at_start
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Choose, Command, LeftOut, Repeat, ResolvedPlan, Statement
from mlmg_lang.spelling import joined

MAX_EXECUTED = 500
"""So many statements are looked ahead over if there are loops or choices, those of all rounds and branches counted."""
MAX_WAYS = 32
"""So many ways are followed on from a statement, the cheapest; of a short script they are all there are."""


@dataclass(frozen=True, slots=True)
class Ahead:
    """A plan whose commands, outside `choose`, have one candidate each on the root graph for each execution.

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
    """The cheapest way found to what may be playing: what it costs, and the candidates taken, the last first.

    Attributes
    ----------
    counted : the graph whose cycles a `wait` counts.
    """

    price: float
    outlook: Outlook
    counted: str
    taken: tuple[str, _Way] | None = None


def plan_ahead(plan: ResolvedPlan, names: Names, travel: Travel) -> Ahead:
    """Return a plan with the candidates of the root graph chosen over the whole script.

    A script that repeats or chooses and executes more than `MAX_EXECUTED` statements is left as it is.
    """
    if _n_executed(plan.statements) > max(MAX_EXECUTED, len(plan.statements)):
        because = f"all rounds and branches counted, it has more than {MAX_EXECUTED} statements"
        return Ahead(plan, False, because, 0.0)
    unrolled = tuple(map(_unrolled, plan.statements))
    ways = [_Way(0.0, {at_start(plan, names): 1.0}, names.root)]
    for statement in _in_order(unrolled):
        ways = _after(statement, ways, names, travel)
        if not ways:
            return Ahead(plan, False, "no choice of candidates is sure to be possible", 0.0)
    best = min(ways, key=lambda way: way.price)
    chosen = iter(list(_taken(best))[::-1])
    narrowed = tuple(_narrowed(one, chosen, names) for one in unrolled)
    return Ahead(replace(plan, statements=narrowed, ahead=True), True, "", best.price)


def _n_executed(statements: Iterable[Statement]) -> int:
    """Return how many statements are executed, as if each `choose` executed all of its branches."""
    total = 0
    for one in statements:
        match one:
            case Repeat(count, body):
                total += count * _n_executed(body)
            case Choose(branches):
                total += 1 + sum(_n_executed(branch.body) for branch in branches)
            case _:
                total += 1
    return total


def _unrolled(statement: Statement) -> Statement:
    """Return a statement in which each loop has its rounds."""
    match statement:
        case Repeat(count, body):
            once = tuple(map(_unrolled, body))
            # However often nothing is to be repeated, it is nothing.
            return replace(statement, body=once, rounds=(once,) * count if _n_executed(body) else ())
        case Choose(branches):
            return replace(
                statement, branches=tuple(replace(one, body=tuple(map(_unrolled, one.body))) for one in branches)
            )
    return statement


def _in_order(statements: Iterable[Statement]) -> Iterator[Statement]:
    """Yield statements as they are executed; what is drawn from stays whole."""
    for one in statements:
        if isinstance(one, Repeat):
            for body in one.rounds:
                yield from _in_order(body)
        else:
            yield one


def _after(statement: Statement, ways: Sequence[_Way], names: Names, travel: Travel) -> list[_Way]:
    """Return the cheapest ways to what may be playing after a statement."""
    onward: dict[frozenset[object], _Way] = {}
    for way in ways:
        for choice, narrowed in narrowings(statement, names):
            follower = Follower(names, travel, counted=way.counted)
            passage = follower.body((narrowed,), way.outlook, is_last=False)
            price = way.price + passage.under_way + passage.cost
            key = frozenset(passage.after.items())
            if passage.sure and (key not in onward or price < onward[key].price):
                taken = way.taken if choice is None else (choice, way)
                onward[key] = _Way(price, passage.after, follower.counted, taken)
    return sorted(onward.values(), key=lambda way: way.price)[:MAX_WAYS]


def narrowings(statement: Statement, names: Names) -> Iterator[tuple[str | None, Statement]]:
    """Yield a command once for each candidate of the root graph, with that alone; what has no choice, as it is."""
    if not _has_choice(statement, names):
        yield None, statement
        return
    for motion in statement.layers[0].candidates:
        yield motion, _with_candidates(statement, (motion,))


def _has_choice(statement: Statement, names: Names) -> TypeGuard[Command]:
    return isinstance(statement, Command) and statement.layers[0].graph == names.root


def _taken(way: _Way) -> Iterator[str]:
    while way.taken is not None:
        motion, way = way.taken
        yield motion


def _narrowed(statement: Statement, chosen: Iterator[str], names: Names) -> Statement:
    """Return a statement with the candidates that were chosen, one for each execution of a command on the root."""
    if _has_choice(statement, names):
        return _with_candidates(statement, (next(chosen),))
    if not isinstance(statement, Repeat) or not statement.rounds:
        return statement
    rounds = tuple(tuple(_narrowed(one, chosen, names) for one in body) for body in statement.rounds)
    body = tuple(_summed_up(one, [each[at] for each in rounds], names) for at, one in enumerate(statement.body))
    return replace(statement, body=body, rounds=rounds)


def _summed_up(statement: Statement, rounds: Sequence[Statement], names: Names) -> Statement:
    """Return a statement of a loop with all candidates that it has in some round."""
    if _has_choice(statement, names):
        taken = {motion for one in rounds if isinstance(one, Command) for motion in one.layers[0].candidates}
        return _with_candidates(statement, [one for one in statement.layers[0].candidates if one in taken])
    if not isinstance(statement, Repeat):
        return statement
    inner = [body for one in rounds if isinstance(one, Repeat) for body in one.rounds]
    if not inner:  # it is never executed, so that nothing is chosen in it
        return replace(statement, rounds=())
    body = tuple(_summed_up(one, [each[at] for each in inner], names) for at, one in enumerate(statement.body))
    return replace(statement, body=body, rounds=())


def _with_candidates(command: Command, motions: Sequence[str]) -> Command:
    """Return a command with only some of the candidates on its topmost graph."""
    top, *others = command.layers
    verb = "comes" if len(motions) == 1 else "come"
    because = f"over the whole script {joined((f'`{motion}`' for motion in motions), 'or')} {verb} to less"
    out = tuple(LeftOut(other, "look ahead", because) for other in top.candidates if other not in motions)
    return replace(command, layers=(replace(top, candidates=tuple(motions), left_out=top.left_out + out), *others))
