"""What may be playing between two statements: at the start, where orders of execution meet, after a part is ended."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from mlmg_lang.planning.names import Names

Setter: TypeAlias = tuple[int, str]
"""The step, by its key (a number that sorts it among all steps), and the graph that it set."""
Origins: TypeAlias = Mapping[str, frozenset[Setter | None]]
"""By motion that may drive a graph, what may have set it; None for the start, or what could not be understood."""
_NOBODY: Final[frozenset[Setter | None]] = frozenset((None,))
"""One for all: where anything may be playing, many of them are compared."""


@dataclass(frozen=True, slots=True)
class Part:
    """A graph that a command has named and none has ended since.

    Attributes
    ----------
    origins : the motions that may drive it, its own or its parent's.
    alone : whether it may run a motion other than its parent's.
    following : of the motions, those that can drive it only where it follows the graph above: then that plays them.
    """

    origins: Origins
    alone: bool
    following: frozenset[str] = frozenset()

    @property
    def motions(self) -> frozenset[str]:
        """Return the motions that may drive it."""
        return frozenset(self.origins)

    def setters(self, motions: Iterable[str]) -> frozenset[Setter | None]:
        """Return what may have set it to one of some motions."""
        return frozenset(setter for motion in motions for setter in self.origins[motion])


@dataclass(frozen=True, slots=True)
class State:
    """What may be playing between two statements.

    Attributes
    ----------
    parts : by graph; the root is always among them.
    certain : False after a statement that could not be understood: then anything may be playing.
    """

    parts: Mapping[str, Part]
    certain: bool = True


def begin(names: Names, motion: str) -> State:
    """Return the state at the start."""
    return State({names.root: Part({motion: _NOBODY}, True)})


def unknown(names: Names) -> State:
    """Return the state in which anything may be playing."""
    return State({names.root: Part(dict.fromkeys(names.motions(names.root), _NOBODY), True)}, certain=False)


def joined(states: Iterable[State], names: Names) -> State:
    """Return the state in which any of some states may be: at least one."""
    first, *others = states
    for other in others:
        if other != first:
            first = _either(first, other, names)
    return first


def _either(a: State, b: State, names: Names) -> State:
    parts = {}
    for graph in names.graphs:
        own = [state.parts[graph] for state in (a, b) if graph in state.parts]
        if len(own) == 1:
            follows = b if graph in a.parts else a
            above = next(above for above in names.ancestors(graph) if above in follows.parts)
            origins = follows.parts[above].origins
            own = [replace(own[0], alone=True), Part(origins, False, frozenset(origins))]
        if own:
            running = frozenset(motion for part in own for motion in part.motions - part.following)
            origins = _merged(part.origins for part in own)
            parts[graph] = Part(origins, any(part.alone for part in own), frozenset(origins) - running)
    return State(parts, a.certain and b.certain)


def _merged(many: Iterable[Origins]) -> Origins:
    """Return what may have set each motion in any of some origins: at least one."""
    first, *others = many
    if not others:
        return first
    merged = dict(first)
    for origins in others:
        for motion, setters in origins.items():
            known = merged.setdefault(motion, setters)
            if known is not setters:
                merged[motion] = known | setters
    return merged


def ended(state: State, graph: str, names: Names) -> State:
    """Return the state after a part, and with it all below it, has been given back to its parent."""
    gone = {graph, *names.below((graph,))}
    return replace(state, parts={name: part for name, part in state.parts.items() if name not in gone})
