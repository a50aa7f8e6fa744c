"""What commands have done -> what they do again where the same may be playing before them.

What a command does hangs on nothing but itself, its key and what may be playing before it, as long as no later one has
ruled out any of its candidates.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from mlmg_lang.planning import resolved, typed
from mlmg_lang.planning.flow import State


@dataclass(frozen=True, slots=True)
class Made:
    """What a command has done: what it plays, and what may be playing before and after it."""

    command: typed.Command
    before: State
    played: resolved.Command
    after: State


Moves: TypeAlias = Mapping[int, Sequence[Made]]
"""By the key of its step, what a command has done each time that something else could be playing before it."""


@dataclass(frozen=True, slots=True)
class Recall:
    """What commands have done.

    Attributes
    ----------
    known : at earlier times. made : this time; of what was known, what has been of use again.
    """

    known: Sequence[Moves] = ()
    made: dict[int, list[Made]] = field(default_factory=dict)

    def of(self, key: int, command: typed.Command, state: State) -> Made | None:
        """Return what a command has done with this before it, if it ever has."""
        for moves in (self.made, *self.known):
            one = _found(moves.get(key, ()), command, state)
            if one is not None:
                if moves is not self.made:
                    self.keep(key, one)
                return one
        return None

    def keep(self, key: int, made: Made) -> None:
        """Keep what a command has done."""
        self.made.setdefault(key, []).append(made)


def _found(moves: Sequence[Made], command: typed.Command, state: State) -> Made | None:
    # Mostly it is the very state that comes after the command before it, which is soon seen.
    for one in moves:
        if one.before is state and one.command is command:
            return one
    for one in moves:
        if one.command is command and one.before == state:
            return one
    return None
