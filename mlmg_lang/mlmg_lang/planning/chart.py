"""A typed plan -> its steps, and which may come right before which, over every order in which they may be executed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeAlias

from mlmg_lang.planning import typed

Leaf: TypeAlias = typed.Command | typed.Wait | typed.End | typed.Unplanned
START = -1
"""In place of a step's number: the beginning of the script."""


@dataclass(slots=True)
class Step:
    """A statement that holds no others; or None, where a `repeat` begins and each time it begins again.

    Attributes
    ----------
    before : the numbers of the steps after which this one may come; in a loop, later ones too.
    loops : the numbers of the steps where the loops around this one begin, the outermost first.
    again : the numbers of the steps where loops begin that come round after this one, the last that leads there.
    """

    statement: Leaf | None
    before: list[int]
    loops: tuple[int, ...]
    again: list[int] = field(default_factory=list)


def chart(statements: Iterable[typed.Statement]) -> list[Step]:
    """Return the steps of a script in the order of the text."""
    charter = _Charter()
    charter.body(statements, [START])
    return charter.steps


@dataclass(slots=True)
class _Charter:
    steps: list[Step] = field(default_factory=list)
    loops: tuple[int, ...] = ()

    def body(self, statements: Iterable[typed.Statement], before: list[int]) -> list[int]:
        """Add some statements; return after which steps one is done with them."""
        for statement in statements:
            before = self._statement(statement, before)
        return before

    def _statement(self, statement: typed.Statement, before: list[int]) -> list[int]:
        match statement:
            case typed.Repeat(count, body):
                head = self._add(None, before)
                around, self.loops = self.loops, (*self.loops, head)
                after = self.body(body, [head])
                self.loops = around
                if count > 1:
                    self._come_round(head, [last for last in after if last != head])
                return after if count > 0 else before
            case typed.Choose(branches):
                ends: dict[int, None] = {}
                for branch in branches:
                    after = self.body(branch.body, before)
                    if branch.weight > 0:
                        ends.update(dict.fromkeys(after))
                return list(ends) or before
            case _:
                return [self._add(statement, before)]

    def _come_round(self, head: int, lasts: list[int]) -> None:
        self.steps[head].before += lasts
        if lasts:
            self.steps[max(lasts)].again.append(head)

    def _add(self, statement: Leaf | None, before: list[int]) -> int:
        number = len(self.steps)
        self.steps.append(Step(statement, list(before), self.loops))
        return number
