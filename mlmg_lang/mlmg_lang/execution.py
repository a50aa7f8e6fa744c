"""A resolved plan -> its statements in the order of execution: repeated, and drawn where there is a choice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import accumulate, repeat
from random import Random
from typing import TypeAlias

from mlmg_lang.planning.resolved import Branch, Choose, Command, End, Repeat, ResolvedPlan, Statement, Wait

Step: TypeAlias = Command | Wait | End


def drawing(seed: int) -> Random:
    """Return the stream of random numbers of which each `choose` takes one whenever it is executed."""
    # Of a number, `Random` takes no notice of the sign.
    return Random(seed if seed >= 0 else str(seed))


def executed(plan: ResolvedPlan, draws: Random) -> Iterator[Step]:
    """Yield what is executed, in order; the same plan and draws always give the same."""
    yield from _body(plan.statements, draws)


def _body(statements: Iterable[Statement], draws: Random) -> Iterator[Step]:
    for statement in statements:
        match statement:
            case Repeat(count, body, rounds=rounds):
                for one in rounds or repeat(body, count):
                    yield from _body(one, draws)
            case Choose(branches):
                yield from _body(_drawn(branches, draws.random()).body, draws)
            case _:
                yield statement


def expected_steps(statements: Iterable[Statement]) -> float:
    """Return how many statements are executed, on average over what may be drawn."""
    return sum(map(_expected, statements))


def _expected(statement: Statement) -> float:
    match statement:
        case Repeat(count, body, rounds=rounds):
            return sum(map(expected_steps, rounds)) if rounds else count * expected_steps(body)
        case Choose(branches):
            total = sum(branch.weight for branch in branches)
            return sum(branch.weight / total * expected_steps(branch.body) for branch in branches)
    return 1.0


def _drawn(branches: tuple[Branch, ...], share: float) -> Branch:
    """Return the branch at a share, from 0 to below 1, of the sum of all weights."""
    sums = list(accumulate(branch.weight for branch in branches))
    return next(branch for branch, end in zip(branches, sums, strict=True) if share * sums[-1] < end)
