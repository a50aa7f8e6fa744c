"""What a character did for an entry, as data: what each part plays, when it arrived, by which transitions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.explaining.explanation import Execution
from mlmg_lang.explaining.happened import Teller
from mlmg_lang.planning.resolved import ResolvedPlan
from mlmg_lang.source import Source
from mlmg_lang.staging import Executed, Stage


@dataclass(frozen=True, slots=True)
class Deed:
    """A statement that was executed, in the words of the entry, and how that went."""

    text: str
    went: Execution


@dataclass(frozen=True, slots=True)
class Answer:
    """What is to be said of an entry.

    Attributes
    ----------
    diagnostics : what is wrong with it, or could be better. If there are errors, nothing has been played.
    n_seconds : how much motion there is now; None if nothing has been played.
    problem : why the library does not allow it to be played.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...]
    deeds: tuple[Deed, ...] = ()
    n_seconds: float | None = None
    problem: str | None = None


def deeds(done: Sequence[Executed], plan: ResolvedPlan, before: Stage | None, after: Stage) -> tuple[Deed, ...]:
    """Return what was done, one statement after the other.

    Parameters
    ----------
    before, after : the character; None if nothing had been played.
    """
    performer = after.performer
    homes = {performer.library.root.name: performer.start} if before is None else _homes(before)
    teller = Teller(performer.library, performer.timeline().tracks, homes)
    return tuple(Deed(" ".join(plan.source.slice(one.statement.span).split()), teller.execution(one)) for one in done)


def _homes(stage: Stage) -> dict[str, str]:
    performer = stage.performer
    return {graph: performer.motion(graph) for graph in performer.library.graphs if performer.runs(graph)}
