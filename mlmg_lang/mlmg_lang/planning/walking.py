"""The steps of a script in the order in which they are taken, and what may be playing before and after each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from mlmg_lang.planning import flow
from mlmg_lang.planning.chart import START, Step
from mlmg_lang.planning.names import Names


@dataclass(slots=True)
class Walk:
    """Goes through steps; where a loop begins, again and again, until nothing new can be playing there.

    Attributes
    ----------
    begin : what may be playing before the first step.
    entered, left : by step, what may be playing before and after it; None if it has not been reached.
    reached : by step, what could be playing before it when it was first taken.
    sound : the steps that no later one has ever gone back over.
    """

    names: Names
    steps: Sequence[Step]
    begin: flow.State
    entered: list[flow.State | None] = field(init=False)
    left: list[flow.State | None] = field(init=False)
    reached: list[flow.State] = field(default_factory=list)
    sound: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Make room for all steps."""
        self.entered = [None] * len(self.steps)
        self.left = [None] * len(self.steps)

    def enter(self, number: int) -> flow.State:
        """Take a step; return what may be playing before it."""
        self.entered[number] = state = self._before(number)
        return state

    def leave(self, number: int, after: flow.State) -> int:
        """Be done with a step; return the next: where a loop begins, if what may be playing there has become more."""
        self.left[number] = after
        heads = self.steps[number].again
        return next((head for head in heads if self._before(head) != self.entered[head]), number + 1)

    def back_to(self, number: int) -> int:
        """Return the step to begin again with when one has to be taken otherwise, and forget all from there.

        That is the step itself, unless loops around it have come round already with what comes of it: then it is where
        the outermost of those begins. What comes before that does not hang on the step, and would only come out again.
        """
        first = next((head for head in self.steps[number].loops if self._came_round(head, number)), number)
        while self.sound and self.sound[-1] > first:
            self.sound.pop()
        for later in range(first, len(self.steps)):
            if self.entered[later] is None:
                break
            self.entered[later] = self.left[later] = None
        return first

    def _came_round(self, head: int, number: int) -> bool:
        """Return whether what comes of a step in a loop may have come back to where that begins."""
        return any(last >= number and self.left[last] is not None for last in self.steps[head].before)

    def _before(self, number: int) -> flow.State:
        """Return what may be playing before a step, as far as what comes before it has been reached.

        Where a loop begins it only ever becomes more: a command that has to be ready for more can do less, and so
        could bring about less, again and again without end.
        """
        step = self.steps[number]
        known = [self.begin if n == START else self.left[n] for n in step.before]
        if step.statement is None:
            known.append(self.entered[number])
        elif len(known) == 1 and known[0] is not None:
            return known[0]
        return flow.joined([state for state in known if state is not None], self.names)
