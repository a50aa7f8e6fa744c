"""An analysis and how its commands go -> small words between those of the text: what is taken, and what is meant."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import ceil, floor
from typing import Final, Protocol

from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import Statement
from mlmg_lang.catalog import Catalog
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import UNITS, seconds_from_quantity, spelled, unit_of
from mlmg_lang.planning.estimate import Estimate
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal


class Kind(StrEnum):
    """What a hint tells; each can be asked for by itself."""

    MOTIONS = "motions"
    ARRIVALS = "arrivals"
    UNITS = "units"
    PARAMETERS = "parameters"


ALL = frozenset(Kind)
_NEAR_S: Final = 1.0
"""So far off a time may be at most that is told as one, with `~`."""
_OF_COMMANDS = frozenset({Kind.MOTIONS, Kind.ARRIVALS})


@dataclass(frozen=True, slots=True)
class Hint:
    """A few words to show at an offset.

    Attributes
    ----------
    before : whether they belong to what stands behind the offset, else to what stands before it.
    explanation : a sentence more.
    """

    offset: int
    label: str
    kind: Kind
    before: bool
    explanation: str


@dataclass(frozen=True, slots=True)
class Going:
    """How a command goes.

    Attributes
    ----------
    motions : by graph, the highest first, what it takes.
    sure : whether it takes them in all cases that may come to pass.
    arrives : from the beginning of the script until all parts have arrived; None if that is not known.
    """

    motions: tuple[tuple[str, str], ...]
    sure: bool
    arrives: Estimate | None


class Outlook(Protocol):
    """How the commands of a script go: foreseen, or found out by playing it."""

    def going(self, command: Span) -> Going | None:
        """Return how the command at a place goes, if that is known; of several times, the first."""


@dataclass(frozen=True, slots=True)
class Meanings:
    """What hints depend on beside what is written, and how commands go."""

    definitions: Definitions
    catalog: Catalog | None

    @classmethod
    def of(cls, analysis: Analysis) -> Meanings:
        """Return that of a script."""
        return cls(analysis.made.gathered.definitions, analysis.question.catalog)


def goings(piece: Statement, start: int, outlook: Outlook | None) -> tuple[Going | None, ...]:
    """Return how the commands of a piece go that begins at an offset; nothing if that is known of none."""
    if outlook is None:
        return ()
    further = start - piece.address
    spans = (one.span for one in syntax.commands(piece.items))
    found = tuple([outlook.going(span.shifted(further)) for span in spans])
    return () if all(one is None for one in found) else found


def has_arguments(piece: Statement) -> bool:
    """Return whether the hints of a piece depend on definitions."""
    return any(isinstance(node, syntax.Call) for item in piece.items for node in syntax.walk(item))


def piece_hints(
    piece: Statement, text: str, meanings: Meanings, going: Sequence[Going | None], kinds: Collection[Kind] = ALL
) -> tuple[Hint, ...]:
    """Return the hints in a piece, with places counted from its beginning, in the order of the text.

    Parameters
    ----------
    text : of the piece. going : how its commands go; see `goings`.
    """
    hinter = _Hinter(text, meanings, -piece.address)
    told = (
        hint
        for command, one in zip(syntax.commands(piece.items), going, strict=False)
        for hint in hinter.of(command, one)
    )
    written = (hint for item in piece.items for hint in hinter.written(item))
    found = (hint for hint in (*told, *written) if hint.kind in kinds)
    # What a command takes stands behind what its last word means.
    return tuple(sorted(found, key=lambda hint: (hint.offset, not hint.before, hint.kind in _OF_COMMANDS)))


@dataclass(frozen=True, slots=True)
class _Hinter:
    """Makes the hints of a piece, whose text begins `further` on from address 0."""

    text: str
    meanings: Meanings
    further: int

    def of(self, command: syntax.Command, going: Going | None) -> Iterator[Hint]:
        """Yield what a command takes, and when it arrives."""
        if going is None or not going.motions:
            return
        start, end = command.span.start + self.further, command.span.end + self.further
        lines = [f"{motion} on {graph}" for graph, motion in going.motions]
        unsure, likely = ("", "") if going.sure else ("~ ", "probably ")
        written = self.text[start:end]
        if not going.sure or not all(motion in written for _, motion in going.motions):
            label = unsure + " with ".join(motion for _, motion in going.motions)
            yield Hint(end, label, Kind.MOTIONS, False, f"{likely}{', '.join(lines)}")
        if going.arrives is not None:
            yield _arrival(going.arrives, end)

    def written(self, item: syntax.Item) -> Iterator[Hint]:
        """Yield what is meant by what is written."""
        for node in syntax.walk(item):
            match node:
                case syntax.Quantity():
                    yield from self._lasting(node, node.span.end + self.further)
                case syntax.Call():
                    yield from self._given(node)

    def _lasting(self, quantity: syntax.Quantity, end: int) -> Iterator[Hint]:
        """Yield what a quantity is in seconds, if it is not written so."""
        if quantity.unit not in UNITS or quantity.unit in ("sec", "second", "seconds"):
            return
        catalog = self.meanings.catalog
        rate = None if catalog is None else catalog.frame_rate
        seconds, unit = seconds_from_quantity(quantity, rate), unit_of(quantity)
        if unit == "cycles":
            yield Hint(end, "passes of the clip", Kind.UNITS, False, "so many times the length of the motion's clip")
        elif seconds is not None and seconds < float("inf"):
            said = f" at {spelled(rate)} frames a second" if unit == "frames" and rate is not None else ""
            label = f"= {spelled(seconds) or '0'} sec"
            yield Hint(end, label, Kind.UNITS, False, f"{quantity.number} {unit} are {label[2:]}{said}")

    def _given(self, call: syntax.Call) -> Iterator[Hint]:
        """Yield the parameters that arguments without a name are for."""
        let = self.meanings.definitions.find(call.name)
        if let is None:
            return
        for argument, parameter in zip(call.arguments, let.parameters or (), strict=False):
            if argument.name is not None:
                return
            if not _says(argument.value, parameter.name):
                name = parameter.name.text
                explanation = f"the parameter `{name}` of `{let.name.text}`"
                yield Hint(argument.span.start + self.further, f"{name} =", Kind.PARAMETERS, True, explanation)


def _arrival(arrives: Estimate, end: int) -> Hint:
    """Return when a command arrives; where its average is far from what may be, only between what that lies."""
    earliest, mean, latest = (
        f"{number:.1f}".removesuffix(".0") for number in (arrives.least, arrives.mean, arrives.most)
    )
    if arrives.is_exact:
        label, when = f"at {mean} sec", f"arrived at {mean} sec"
    elif arrives.mean - arrives.least <= _NEAR_S and arrives.most - arrives.mean <= _NEAR_S:
        label, when = f"~ at {mean} sec", f"probably arrived at about {mean} sec ({earliest} to {latest})"
    else:
        label = f"~ at {floor(arrives.least)} to {ceil(arrives.most)} sec"
        when = f"probably arrived between {earliest} and {latest} sec"
    return Hint(end, label, Kind.ARRIVALS, False, f"all parts have {when} from the beginning")


def _says(value: syntax.Motion | syntax.Quantity, name: syntax.Name) -> bool:
    """Return whether an argument is a name that says itself which parameter it is for."""
    return isinstance(value, syntax.Reference) and normal(value.name.text) == normal(name.text)
