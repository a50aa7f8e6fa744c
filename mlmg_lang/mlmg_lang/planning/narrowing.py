"""What later commands have ruled out of earlier ones, and the narrowing that is on trial."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from mlmg_lang.planning.flow import Setter
from mlmg_lang.planning.rules.ruling import Narrow, Stopped


@dataclass(frozen=True, slots=True)
class Trial:
    """A narrowing of earlier commands for the sake of a later one, which can be taken back.

    Attributes
    ----------
    number : the step of the later one. stopped : what stops it if they cannot be narrowed.
    pending : the steps that have not shown yet that they can go on with it.
    forbidden : what has been ruled out.
    """

    number: int
    stopped: Stopped
    pending: set[int]
    forbidden: list[tuple[Setter, str]] = field(default_factory=list)


@dataclass(slots=True)
class Narrowings:
    """What has been ruled out.

    Attributes
    ----------
    forbidden : by what set them, the candidates that later commands have ruled out, and why.
    narrowed : the keys of the steps that some have been ruled out of, once at least.
    trial : the narrowing that has not shown yet that all can go on with it.
    """

    forbidden: dict[Setter, dict[str, str]] = field(default_factory=dict)
    narrowed: set[int] = field(default_factory=set)
    trial: Trial | None = None

    def of(self, key: int, graphs: Iterable[str]) -> Mapping[str, Mapping[str, str]]:
        """Return by graph what is ruled out of a step."""
        return {graph: self.forbidden.get((key, graph), {}) for graph in graphs}

    def narrow(self, number: int, stopped: Stopped, narrow: Narrow, setters: Iterable[int], because: str) -> None:
        """Rule out what keeps a step from being taken.

        Parameters
        ----------
        setters : the steps of which it is ruled out.
        """
        if self.trial is None:
            self.trial = Trial(number, stopped, {number})
        self.trial.pending.update(setters)
        for setter, motions in narrow.without.items():
            here = self.forbidden.setdefault(setter, {})
            self.narrowed.add(setter[0])
            for motion in sorted(motions - here.keys()):
                here[motion] = because
                self.trial.forbidden.append((setter, motion))

    def went_on(self, number: int) -> None:
        """Note that a step has been taken: when all on trial have, the narrowing stands."""
        if self.trial is not None:
            self.trial.pending.discard(number)
            if not self.trial.pending:
                self.trial = None

    def take_back(self, trial: Trial) -> None:
        """Undo the narrowing that is on trial."""
        self.trial = None
        for setter, motion in trial.forbidden:
            del self.forbidden[setter][motion]
