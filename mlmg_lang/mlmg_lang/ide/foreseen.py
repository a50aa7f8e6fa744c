"""A plan and its forecast -> how each of its commands will probably go, as it is shown beside it."""

from __future__ import annotations

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from mlmg_lang.analysis import InPieces
from mlmg_lang.blocks import Statement
from mlmg_lang.common_ends import common_ends
from mlmg_lang.ide.hints import Going, Outlook
from mlmg_lang.planning import resolved
from mlmg_lang.planning.course import driver
from mlmg_lang.planning.estimate import NO_TIME, Estimate, mixed
from mlmg_lang.planning.forecast import Forecast, Outcome, chances_of
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Choose, Command, Repeat, ResolvedPlan
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
    return Foreseen(dict(_Clock(expected, names).goings(plan.statements, NO_TIME)))


@dataclass(frozen=True)
class Remembered:
    """What was foreseen of a text, to be told of later ones for the commands that edits have left alone.

    How they go may be otherwise by then: it is to be shown until that is known.
    """

    told: Foreseen
    text: InPieces

    def of(self, now: InPieces) -> Outlook:
        """Return how the commands of a later text would go."""
        before, after = (one.source.text.splitlines(keepends=True) for one in (self.text, now))
        n_first, n_last = common_ends(before, after)
        head, tail = (sum(map(len, lines)) for lines in (after[:n_first], after[len(after) - n_last :]))
        return _Remembering(self, list(now.pieces), list(now.places.starts), len(now.source.text), head, tail)

    def of_piece(self, piece: Statement, command: Span) -> Going | None:
        """Return how the command at a place in a piece was to go; places count from the beginning of that."""
        start = self._starts.get(id(piece))
        return None if start is None else self.told.going(command.shifted(start))

    @cached_property
    def _starts(self) -> dict[int, int]:
        return {id(piece): start for piece, start in zip(self.text.pieces, self.text.places.starts, strict=False)}


@dataclass(frozen=True, slots=True)
class _Remembering:
    """Tells of a later text.

    Attributes
    ----------
    pieces, starts : of that, and where they begin. size : how long it is.
    head, tail : as many code points of whole lines are the same at its beginning, and at its end.
    """

    known: Remembered
    pieces: Sequence[Statement]
    starts: Sequence[int]
    size: int
    head: int
    tail: int

    def going(self, command: Span) -> Going | None:
        """Return how the command at a place was to go."""
        at = max(bisect_right(self.starts, command.start, hi=len(self.pieces)) - 1, 0)
        own = self.known.of_piece(self.pieces[at], command.shifted(-self.starts[at]))
        return own or self._beside_the_edit(command)

    def _beside_the_edit(self, command: Span) -> Going | None:
        """Return how the command was to go at a place in lines that are the same, though they have been read again."""
        if command.end <= self.head:
            return self.known.told.going(command)
        if command.start < self.size - self.tail:
            return None
        return self.known.told.going(command.shifted(len(self.known.text.source.text) - self.size))


@dataclass(frozen=True, slots=True)
class _Clock:
    expected: Forecast
    names: Names

    def goings(self, statements: Iterable[resolved.Statement], now: Estimate) -> Iterator[tuple[Span, Going]]:
        """Yield how the commands in a row go that begin now."""
        for statement in statements:
            if isinstance(statement, Command):
                outcome = self.expected.outcomes[statement.span]
                yield statement.span, self._going(statement, outcome, now + outcome.arrives)
            elif isinstance(statement, Repeat) and statement.count > 0:
                yield from self.goings(statement.body, now)
            elif isinstance(statement, Choose):
                for branch in statement.branches:
                    yield from self.goings(branch.body, now)
            now += self._takes(statement)

    def _going(self, command: Command, outcome: Outcome, arrives: Estimate) -> Going:
        chances: defaultdict[tuple[tuple[str, str], ...], float] = defaultdict(float)
        for course in outcome.courses:
            driving = ((layer.graph, driver(course.world, layer.graph, self.names)[1]) for layer in command.layers)
            chances[tuple((graph, playing.motion) for graph, playing in driving)] += course.chance
        motions = max(chances, key=lambda one: chances[one], default=())
        return Going(motions, len(chances) == 1, arrives)

    def _takes(self, statement: resolved.Statement) -> Estimate:
        """Return how long a statement takes, from its beginning to that of the next."""
        passages = self.expected.passages
        if isinstance(statement, Repeat):
            return passages[statement.span].takes.times(statement.count) if statement.count else NO_TIME
        if isinstance(statement, Choose):
            drawn = zip(chances_of(statement), statement.branches, strict=True)
            return mixed((chance, passages[branch.span].takes) for chance, branch in drawn)
        outcome = self.expected.outcomes[statement.span]
        return outcome.arrives + outcome.lasts
