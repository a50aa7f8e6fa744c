"""What a script plays, statement by statement, with what is wrong with it as it would be played."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.planning import flow, resolved
from mlmg_lang.planning.recalling import Moves
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Resolution:
    """A resolved plan with what is wrong with the script as it would be played.

    Attributes
    ----------
    wrong : what is wrong with the start. told : by step, what is wrong with it.
    states : what may be playing before each statement that holds no others, by its span.
    reached : by step, what could be playing before it when it was first taken.
    sound : the steps that no later one has ever gone back over: with that alone, all from there comes out the same.
    moves : what commands have done; see `recalling`.
    joins : the step from which all is as was known already, if there is one; it and later ones have not been taken.
    """

    plan: resolved.ResolvedPlan
    wrong: tuple[Diagnostic, ...]
    told: Mapping[int, Diagnostic]
    states: Mapping[Span, flow.State]
    reached: Sequence[flow.State]
    sound: Sequence[int]
    moves: Moves
    joins: int | None = None

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return all that is wrong, in the order of the text."""
        return (*self.wrong, *(self.told[step] for step in sorted(self.told)))

    @property
    def bodies(self) -> Iterator[tuple[resolved.Statement, ...]]:
        """Yield the script's statements, then those of each `repeat` and of each branch."""
        bodies = [self.plan.statements]
        for body in bodies:
            for statement in body:
                if isinstance(statement, resolved.Repeat):
                    bodies.append(statement.body)
                elif isinstance(statement, resolved.Choose):
                    bodies += [branch.body for branch in statement.branches]
            yield body

    @property
    def commands(self) -> Iterator[resolved.Command]:
        """Yield all commands of the script."""
        return (one for body in self.bodies for one in body if isinstance(one, resolved.Command))
