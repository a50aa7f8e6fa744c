"""A plan and its forecast -> how each of its commands will probably go, as it is shown beside it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.hints import Going
from mlmg_lang.planning.course import driver
from mlmg_lang.planning.estimate import NO_TIME, Estimate, mixed
from mlmg_lang.planning.forecast import Forecast, Outcome, chances_of
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Choose, Command, Repeat, ResolvedPlan, Statement
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Foreseen:
    """How commands will probably go, by their places in the text of the plan; the first time, where they go several."""

    goings: dict[Span, Going]

    def going(self, command: Span) -> Going | None:
        """Return how the command at a place will probably go."""
        return self.goings.get(command)


def foreseen(plan: ResolvedPlan, expected: Forecast, names: Names) -> Foreseen:
    """Return how the commands of a plan will probably go, in place of playing it."""
    return Foreseen(dict(_Clock(expected, names).goings(plan.statements, 0.0)))


def still_foreseen(told: Foreseen, before: Analysis, now: Analysis) -> Foreseen:
    """Return what was foreseen of a text before an edit, for the commands that the edit has left alone.

    Where they come to stand is right, how they go may be otherwise by now: it is to be shown until that is known.
    """
    starts, pieces = before.made.places.starts, before.made.pieces
    now_at = {id(piece): start for piece, start in zip(now.made.pieces, now.made.places.starts, strict=False)}
    left: dict[Span, Going] = {}
    for command, going in told.goings.items():
        at = min(starts.last_to(command.start), len(pieces) - 1)
        start = now_at.get(id(pieces[at]))
        if start is not None:
            further = start - starts[at]
            left[Span(command.start + further, command.end + further)] = going
    return Foreseen(left)


@dataclass(frozen=True, slots=True)
class _Clock:
    expected: Forecast
    names: Names

    def goings(self, statements: Iterable[Statement], now_s: float) -> Iterator[tuple[Span, Going]]:
        """Yield how the commands in a row go that begin now."""
        for statement in statements:
            if isinstance(statement, Command):
                outcome = self.expected.outcomes[statement.span]
                yield statement.span, self._going(statement, outcome, now_s + outcome.arrives.mean)
            elif isinstance(statement, Repeat) and statement.count > 0:
                yield from self.goings(statement.body, now_s)
            elif isinstance(statement, Choose):
                for branch in statement.branches:
                    yield from self.goings(branch.body, now_s)
            now_s += self._takes(statement).mean

    def _going(self, command: Command, outcome: Outcome, arrives_s: float) -> Going:
        chances: defaultdict[tuple[tuple[str, str], ...], float] = defaultdict(float)
        for course in outcome.courses:
            driving = ((layer.graph, driver(course.world, layer.graph, self.names)[1]) for layer in command.layers)
            chances[tuple((graph, playing.motion) for graph, playing in driving)] += course.chance
        motions = max(chances, key=lambda one: chances[one], default=())
        return Going(motions, arrives_s, sure=len(chances) == 1)

    def _takes(self, statement: Statement) -> Estimate:
        """Return how long a statement takes, from its beginning to that of the next."""
        passages = self.expected.passages
        if isinstance(statement, Repeat):
            return passages[statement.span].takes.times(statement.count) if statement.count else NO_TIME
        if isinstance(statement, Choose):
            drawn = zip(chances_of(statement), statement.branches, strict=True)
            return mixed((chance, passages[branch.span].takes) for chance, branch in drawn)
        outcome = self.expected.outcomes[statement.span]
        return outcome.arrives + outcome.lasts
