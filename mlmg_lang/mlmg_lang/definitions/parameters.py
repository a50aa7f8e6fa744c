"""Definitions -> their parameters: of which kind each is, told by how it is used; and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from mlmg_lang.diagnostics import Diagnostic, Note
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal


class Kind(StrEnum):
    """What a parameter stands for."""

    MOTION = "motion"
    DURATION = "duration"


Kinds: TypeAlias = Mapping[str, Kind | None]
"""By parameter, in NFC and in order; None for one that is not used."""


@dataclass(frozen=True, slots=True)
class Signature:
    """What a definition takes, and whether it says how long: then it is a whole statement."""

    kinds: Kinds
    lasts: bool


def signatures(lets: Mapping[str, syntax.Let]) -> tuple[dict[str, Signature], tuple[Diagnostic, ...]]:
    """Return the signatures of the definitions that have no mistake in this respect, and what is wrong with others."""
    circles = _circles(lets)
    reader = _Reader(lets, circles)
    each_once = {frozenset(circle): name for name, circle in reversed(circles.items())}
    reader.diagnostics += [_in_circle(lets[name], circles[name], lets) for name in reversed(each_once.values())]
    for name in lets:
        reader.signature(name)
    found = {name: signature for name, signature in reader.known.items() if signature is not None}
    return found, tuple(reader.diagnostics)


def references(let: syntax.Let) -> Iterator[syntax.Name]:
    """Yield the names in a definition that may be those of definitions, in the order of the text."""
    own = {normal(parameter.name.text) for parameter in let.parameters or ()}
    for node in syntax.walk(let):
        if isinstance(node, syntax.Reference | syntax.Call) and normal(node.name.text) not in own:
            yield node.name


# --- circles ---------------------------------------------------------------------------------------------


def _circles(lets: Mapping[str, syntax.Let]) -> dict[str, tuple[str, ...]]:
    """Return the definitions that lead to themselves, each with the names on a short way round."""
    onward = {name: _onward(let, lets) for name, let in lets.items()}
    found: dict[str, tuple[str, ...]] = {}
    for name in _on_circles(onward):
        way = () if name in found else _way_round(name, onward)
        found.update((other, way) for other in way if other not in found)
    return found


def _onward(let: syntax.Let, lets: Mapping[str, syntax.Let]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(word for word in (normal(n.text) for n in references(let)) if word in lets))


def _on_circles(onward: Mapping[str, tuple[str, ...]]) -> list[str]:
    """Return the names that may be on a circle: what is left without those that lead nowhere, or that none leads to."""
    users: dict[str, list[str]] = {name: [] for name in onward}
    for name, others in onward.items():
        for other in others:
            users[other].append(name)
    loose = _peeled(onward, users) | _peeled(users, onward)
    return [name for name in onward if name not in loose]


def _peeled(onward: Mapping[str, Sequence[str]], users: Mapping[str, Sequence[str]]) -> set[str]:
    """Return the names that lead nowhere, those that lead to such alone, and so on."""
    left = {name: len(others) for name, others in onward.items()}
    done = [name for name, count in left.items() if count == 0]
    for name in done:
        for user in users[name]:
            left[user] -= 1
            if left[user] == 0:
                done.append(user)
    return set(done)


def _way_round(name: str, onward: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return the names on the shortest way from one back to itself; none if there is no way."""
    came: dict[str, str] = {}
    pending = [name]
    for here in pending:
        for other in onward[here]:
            if other == name:
                way = [here]
                while way[-1] != name:
                    way.append(came[way[-1]])
                return (*reversed(way), name)
            if other not in came:
                came[other] = here
                pending.append(other)
    return ()


def _in_circle(let: syntax.Let, circle: tuple[str, ...], lets: Mapping[str, syntax.Let]) -> Diagnostic:
    way = " -> ".join(f"`{name}`" for name in circle)
    message = f"`{let.name.text}` is defined in terms of itself" + (f": {way}" if len(circle) > 2 else "")
    notes = tuple(Note(f"`{name}` is defined here", lets[name].name.span) for name in circle[1:-1])
    return Diagnostic("MS051", message, let.name.span, "a definition has to end in motions and tags", notes)


# --- kinds -----------------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Reader:
    """Reads how parameters are used. `known` has None for definitions with mistakes."""

    lets: Mapping[str, syntax.Let]
    circles: Mapping[str, tuple[str, ...]]
    known: dict[str, Signature | None] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def signature(self, name: str) -> Signature | None:
        """Return the signature of a definition, worked out after those that it uses."""
        pending = [name]
        while pending:
            here = pending[-1]
            needed = [] if here in self.circles else _onward(self.lets[here], self.lets)
            missing = [other for other in needed if other not in self.known]
            if missing and here not in self.known:
                pending += missing
            else:
                pending.pop()
                if here not in self.known:
                    self.known[here] = None if here in self.circles else self._read(self.lets[here])
        return self.known[name]

    def _read(self, let: syntax.Let) -> Signature | None:
        before = len(self.diagnostics)
        kinds: dict[str, Kind | None] = {}
        for parameter in let.parameters or ():
            name = normal(parameter.name.text)
            if name in kinds:
                message = f"`{let.name.text}` has the parameter `{parameter.name.text}` twice"
                self.diagnostics.append(Diagnostic("MS050", message, parameter.name.span, "give it another name"))
            kinds.setdefault(name, None)
        places: dict[str, Span] = {}
        uses = tuple(self._uses(let, kinds))
        for name, kind, span in (*_defaults(let), *uses):
            if kinds[name] in (None, kind):
                kinds[name] = kind
                places.setdefault(name, span)
            else:
                self._mixed(name, kind, span, places[name])
        used = {name for name, _, _ in uses}
        for parameter in let.parameters or ():
            if parameter.name.sound and normal(parameter.name.text) not in used:
                self._unused(let, parameter)
        command = let.command
        lasts = command.duration is not None or command.once is not None
        sound = not any(one.code != "MS054" for one in self.diagnostics[before:])
        return Signature(kinds, lasts) if sound else None

    def _mixed(self, name: str, kind: Kind, span: Span, first: Span) -> None:
        other = Kind.MOTION if kind is Kind.DURATION else Kind.DURATION
        message = f"`{name}` is a {kind} here, but a {other} where it stands first"
        note = Note(f"here it is a {other}", first)
        self.diagnostics.append(Diagnostic("MS056", message, span, "use two parameters", (note,)))

    def _unused(self, let: syntax.Let, parameter: syntax.Parameter) -> None:
        message = f"`{let.name.text}` does not use its parameter `{parameter.name.text}`"
        self.diagnostics.append(Diagnostic("MS054", message, parameter.name.span, "take it out, or use it"))

    def _uses(self, let: syntax.Let, kinds: Kinds) -> Iterator[tuple[str, Kind, Span]]:
        """Yield where parameters are used, and as what."""
        passed: dict[Span, Kind | None] = {}
        for node in syntax.walk(let.command):
            if isinstance(node, syntax.Call):
                passed.update(self._passed(node))
            if isinstance(node, syntax.Reference) and normal(node.name.text) in kinds:
                passed_for = passed.get(node.span, Kind.MOTION)
                if passed_for is not None:
                    yield normal(node.name.text), passed_for, node.span
        amount = let.command.duration
        if isinstance(amount, syntax.Name) and normal(amount.text) in kinds:
            yield normal(amount.text), Kind.DURATION, amount.span

    def _passed(self, call: syntax.Call) -> Iterator[tuple[Span, Kind | None]]:
        """Yield the arguments of a definition that are bare names, with the kinds of what they are passed for."""
        signature = self.known.get(normal(call.name.text))
        if signature is None:
            return
        names = list(signature.kinds)
        for at, argument in enumerate(call.arguments):
            name = normal(argument.name.text) if argument.name else (names[at] if at < len(names) else "")
            if isinstance(argument.value, syntax.Reference):
                yield argument.value.span, signature.kinds.get(name)


def _defaults(let: syntax.Let) -> Iterator[tuple[str, Kind, Span]]:
    """Yield the parameters that have a default, and what that is."""
    for parameter in let.parameters or ():
        if parameter.default is not None:
            kind = Kind.DURATION if isinstance(parameter.default, syntax.Quantity) else Kind.MOTION
            yield normal(parameter.name.text), kind, parameter.default.span
