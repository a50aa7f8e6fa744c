"""The order in which statements are executed, and what `choose` draws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import islice
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.execution import drawing, executed, expected_steps
from mlmg_lang.planning.resolved import Branch, Choose, End, Repeat, ResolvedPlan, Seconds, Statement, Wait
from mlmg_lang.source import Source, Span

NOWHERE = Span(0, 0)


def say(word: str) -> End:
    """Return a statement that is told from others by a word."""
    return End(word, NOWHERE)


def repeat(count: int, *body: Statement) -> Repeat:
    return Repeat(count, body, NOWHERE)


def choose(*bodies: Sequence[Statement], weights: Sequence[int] = ()) -> Choose:
    weights = weights or [1] * len(bodies)
    return Choose(
        tuple(Branch(weight, tuple(body), NOWHERE) for weight, body in zip(weights, bodies, strict=True)), NOWHERE
    )


def words(*statements: Statement, seed: int = 0) -> str:
    """Return the words of what is executed, one after the other."""
    plan = ResolvedPlan(Source(""), "Idle_01", statements)
    return "".join(step.graph for step in executed(plan, drawing(seed)) if isinstance(step, End))


def drawn(*weights: int, seed: int = 0, times: int = 1_000) -> str:
    """Return which branches are drawn, each called by a letter."""
    letters = "abcdefghijklmnopqrstuvwxyz"[: len(weights)]
    return words(repeat(times, choose(*([say(letter)] for letter in letters), weights=weights)), seed=seed)


# --- the order ---


def test_statements_are_executed_in_the_order_of_the_text() -> None:
    wait = Wait(Seconds(1.0), NOWHERE)
    plan = ResolvedPlan(Source(""), "Idle_01", (say("a"), wait, say("b")))
    assert list(executed(plan, drawing(0))) == [say("a"), wait, say("b")]


@pytest.mark.parametrize(
    ("statements", "expected"),
    [
        ([], ""),
        ([repeat(0, say("a")), say("b")], "b"),
        ([repeat(1, say("a")), say("b")], "ab"),
        ([repeat(3, say("a"), say("b")), say("c")], "abababc"),
        ([repeat(2, say("a"), repeat(3, say("b")))], "abbbabbb"),
        ([repeat(2), say("a")], "a"),
        ([choose([say("a"), say("b")])], "ab"),
        ([choose([]), say("a")], "a"),
        ([choose([say("a")], [say("b")], weights=[0, 1])], "b"),
        ([choose([say("a")], [say("b")], [say("c")], weights=[0, 5, 0])], "b"),
        ([repeat(2, choose([repeat(2, choose([say("a")]))]), say("b"))], "aabaab"),
    ],
)
def test_loops_and_choices_are_executed_as_they_are_nested(statements: list[Statement], expected: str) -> None:
    assert words(*statements) == expected


def test_a_script_is_executed_step_by_step_and_not_ahead() -> None:
    plan = ResolvedPlan(Source(""), "Idle_01", (repeat(10**9, repeat(10**9, say("a"))),))
    assert list(islice(executed(plan, drawing(0)), 3)) == [say("a")] * 3


# --- what is drawn ---


@pytest.mark.parametrize("weights", [(1, 1), (1, 2, 3), (90, 10), (0, 1, 0, 3), (1,) * 7, (10**9, 3 * 10**9)])
def test_branches_are_drawn_as_often_as_they_weigh(weights: tuple[int, ...]) -> None:
    """Pearson's chi-squared of 20,000 draws, of 20 seeds; fixed, and at most where 1 of 1,000 would be above."""
    counts: Counter[str] = Counter()
    for seed in range(20):
        counts.update(drawn(*weights, seed=seed))
    expected = {letter: 20_000 * weight / sum(weights) for letter, weight in zip("abcdefg", weights, strict=False)}
    assert all(expected[letter] > 0 for letter in counts)
    chi_squared = sum((counts[letter] - often) ** 2 / often for letter, often in expected.items() if often)
    highest = {1: 10.83, 2: 13.82, 3: 16.27, 6: 22.46}
    assert chi_squared < highest[sum(weight > 0 for weight in weights) - 1]


def test_draws_do_not_follow_from_those_before() -> None:
    """Of pairs of draws each is as frequent, over seeds and within one."""
    within = drawn(1, 1, 1, times=9_000)
    over = "".join(drawn(1, 1, 1, seed=seed, times=2) for seed in range(4_500))
    for draws in (within, over):
        pairs = Counter(draws[at : at + 2] for at in range(0, len(draws), 2))
        assert sum((count - 500) ** 2 / 500 for count in pairs.values()) < 26.12
        assert len(pairs) == 9


@pytest.mark.parametrize("weights", [(0, 1), (1, 0), (0, 0, 1, 0), (3, 0, 2)])
def test_a_branch_of_no_weight_is_never_drawn(weights: tuple[int, ...]) -> None:
    never = {letter for letter, weight in zip("abcd", weights, strict=False) if weight == 0}
    assert never.isdisjoint("".join(drawn(*weights, seed=seed) for seed in range(20)))


def test_the_least_of_all_draws_takes_no_branch_without_weight_either() -> None:
    class Least(Random):
        def random(self) -> float:
            return 0.0

    plan = ResolvedPlan(Source(""), "Idle_01", (choose([say("a")], [say("b")], weights=[0, 1]),))
    assert list(executed(plan, Least())) == [say("b")]


def test_the_same_seed_gives_the_same_draws() -> None:
    for seed in (0, 1, 7, 10**30):
        assert drawn(1, 2, 3, seed=seed) == drawn(1, 2, 3, seed=seed)


def test_different_seeds_give_different_draws() -> None:
    assert len({drawn(1, 1, seed=seed, times=64) for seed in range(-250, 250)}) == 500


def test_draws_of_a_seed_stay_what_they_are() -> None:
    """Whoever has a seed that they like shall keep what it gives, in every version."""
    assert drawn(1, 1, 1, seed=0, times=40) == "ccbabbcabbcbacbaccccacccbabbccbcacbacbcc"
    assert drawn(1, 1, 1, seed=2024, times=40) == "bcacbcaacbbccacbccacbccaababbaccbbabaaca"


@given(st.lists(st.integers(0, 10**12), min_size=1, max_size=30).filter(any), st.integers(0, 2**64))
def test_whatever_the_weights_a_branch_is_drawn(weights: list[int], seed: int) -> None:
    bodies = [[say(str(at))] for at in range(len(weights))]
    assert weights[int(words(choose(*bodies, weights=weights), seed=seed))] > 0


def test_a_choice_takes_one_number_whenever_it_is_executed() -> None:
    """What is drawn after a choice does not depend on what it drew, unless that draws itself."""
    tail = repeat(50, choose([say("a")], [say("b")]))
    after_many = words(choose([say("x")], [say("y")], [], [say("z"), say("z")]), tail, seed=3)
    after_one = words(choose([]), tail, seed=3)
    assert after_many.lstrip("xyz") == after_one
    assert after_one != words(tail, seed=3)
    assert words(choose([], [choose([])], weights=[0, 1]), tail, seed=3) != after_one


def test_loops_take_no_numbers() -> None:
    draw = choose([say("a")], [say("b")])
    assert words(repeat(30, draw), seed=5) == words(*[draw] * 30, seed=5) == words(repeat(3, repeat(10, draw)), seed=5)


def test_how_many_statements_are_executed_is_known_on_average() -> None:
    often = choose([say("a"), say("b")], [], weights=[3, 1])
    assert expected_steps([say("a"), repeat(3, say("b"), say("c")), repeat(0, say("d"))]) == 7
    assert expected_steps([often, repeat(2, often)]) == 4.5
    one, other = (say("a"),), (say("b"), say("c"))
    assert expected_steps([Repeat(2, one, NOWHERE, rounds=(one, other))]) == 3
