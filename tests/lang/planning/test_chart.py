"""Which statement may come right before which, held against all orders in which a script may be executed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.planning import typed
from mlmg_lang.planning.chart import START, Step, chart
from mlmg_lang.source import Span

Orders = list[tuple[int, ...]]
NOWHERE = Span(0, 0)


def leaf(number: int) -> typed.Wait:
    """Return a statement that is told from others by where it begins."""
    return typed.Wait(typed.Duration(1.0, None, NOWHERE), Span(number, number + 1))


def repeat(count: int, *body: typed.Statement) -> typed.Repeat:
    return typed.Repeat(count, body, NOWHERE)


def choose(*bodies: Sequence[typed.Statement], weights: Sequence[int] = ()) -> typed.Choose:
    weights = weights or [1] * len(bodies)
    branches = (typed.Branch(weight, tuple(body), NOWHERE) for weight, body in zip(weights, bodies, strict=True))
    return typed.Choose(tuple(branches), NOWHERE)


def orders(statements: Sequence[typed.Statement]) -> Orders:
    """Return every order in which the leaves of some statements may be executed; loops go round three times at most."""
    found: Orders = [()]
    for statement in statements:
        match statement:
            case typed.Repeat(count, body):
                for _ in range(min(count, 3)):
                    found = followed(found, orders(body))
            case typed.Choose(branches):
                found = followed(found, [way for branch in branches if branch.weight for way in orders(branch.body)])
            case _:
                found = followed(found, [(statement.span.start,)])
    return found


def followed(orders: Orders, others: Orders) -> Orders:
    return list(dict.fromkeys((*one, *other) for one in orders for other in others))


def before(steps: Sequence[Step], number: int) -> set[int]:
    """Return after which leaves, or the START, a step may come; beginnings of loops are passed through."""
    found: set[int] = set()
    seen: set[int] = set()
    pending = list(steps[number].before)
    while pending:
        one = pending.pop()
        if one in seen:
            continue
        seen.add(one)
        statement = None if one == START else steps[one].statement
        if one == START:
            found.add(START)
        elif statement is None:
            pending += steps[one].before
        else:
            found.add(statement.span.start)
    return found


def charted(statements: Sequence[typed.Statement]) -> dict[int, set[int]]:
    steps = chart(statements)
    leaves = {number: step.statement for number, step in enumerate(steps) if step.statement is not None}
    return {statement.span.start: before(steps, number) for number, statement in leaves.items()}


def numbered(statements: Sequence[typed.Statement], numbers: Iterator[int]) -> tuple[typed.Statement, ...]:
    """Return the same statements with leaves that are told from each other."""
    found: list[typed.Statement] = []
    for statement in statements:
        match statement:
            case typed.Repeat(count, body):
                found.append(repeat(count, *numbered(body, numbers)))
            case typed.Choose(branches):
                found.append(choose(*(numbered(branch.body, numbers) for branch in branches)))
            case _:
                found.append(leaf(next(numbers)))
    return tuple(found)


BODIES = st.recursive(
    st.lists(st.just(leaf(0)), max_size=2),
    lambda inner: st.lists(
        st.just(leaf(0))
        | st.builds(lambda count, body: repeat(count, *body), st.integers(1, 3), inner)
        | st.builds(lambda bodies: choose(*bodies), st.lists(inner, min_size=1, max_size=3)),
        max_size=3,
    ),
    max_leaves=6,
)


@given(BODIES)
def test_a_step_may_come_after_those_that_it_does_come_after_in_some_order(body: list[typed.Statement]) -> None:
    statements = numbered(body, iter(range(10_000)))
    expected: dict[int, set[int]] = {}
    for order in orders(statements):
        for one, following in zip((START, *order), order, strict=False):
            expected.setdefault(following, set()).add(one)
    assert charted(statements) == expected


@given(BODIES)
def test_every_loop_knows_from_where_it_begins_again(body: list[typed.Statement]) -> None:
    steps = chart(body)
    for number, step in enumerate(steps):
        last_before = [max(steps[head].before, default=START) for head in range(number)]
        assert sorted(step.again) == [head for head, last in enumerate(last_before) if last == number]


def test_the_steps_of_a_plain_script_follow_each_other() -> None:
    steps = chart([leaf(1), leaf(2), leaf(3)])
    assert [step.before for step in steps] == [[START], [0], [1]]
    assert [step.loops for step in steps] == [(), (), ()]
    assert all(step.again == [] for step in steps)


def test_a_loop_comes_after_what_is_before_it_and_after_its_own_end() -> None:
    assert charted([leaf(1), repeat(2, leaf(2), leaf(3)), leaf(4)]) == {1: {START}, 2: {1, 3}, 3: {2}, 4: {3}}


def test_a_loop_that_goes_round_once_is_no_loop() -> None:
    assert charted([leaf(1), repeat(1, leaf(2)), leaf(3)]) == {1: {START}, 2: {1}, 3: {2}}


def test_a_loop_that_is_never_entered_is_looked_at_but_left_out() -> None:
    assert charted([leaf(1), repeat(0, leaf(2)), leaf(3)]) == {1: {START}, 2: {1}, 3: {1}}


def test_a_branch_that_is_never_drawn_is_looked_at_but_left_out() -> None:
    statements = [leaf(1), choose([leaf(2)], [leaf(3)], weights=[0, 1]), leaf(4)]
    assert charted(statements) == {1: {START}, 2: {1}, 3: {1}, 4: {3}}


def test_a_choice_that_nothing_can_be_drawn_from_does_nothing() -> None:
    assert charted([leaf(1), choose([leaf(2)], weights=[0]), leaf(3)]) == {1: {START}, 2: {1}, 3: {1}}


def test_an_empty_branch_lets_what_comes_before_through() -> None:
    assert charted([leaf(1), choose([leaf(2)], []), leaf(3)]) == {1: {START}, 2: {1}, 3: {1, 2}}


def test_all_steps_know_the_loops_around_them() -> None:
    steps = chart([leaf(1), repeat(2, leaf(2), repeat(2, leaf(3)), choose([leaf(4)])), repeat(1, leaf(5)), leaf(6)])
    assert [step.loops for step in steps] == [(), (), (1,), (1,), (1, 3), (1,), (), (6,), ()]


def test_each_predecessor_is_named_once() -> None:
    steps = chart([leaf(1), choose([], [], [choose([], [])]), leaf(2)])
    assert steps[1].before == [0]
