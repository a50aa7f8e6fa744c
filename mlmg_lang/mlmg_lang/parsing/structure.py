"""The syntax tree -> what is wrong with it whatever the library, and what is not played yet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import UNITS, seconds_from_quantity, unit_of
from mlmg_lang.source import Span

SUB = "Sub"
"""In place of a graph's name: the child of the graph last named."""
LONGEST_S = 24 * 3600.0
"""The longest duration that anyone can mean."""


def check_structure(script: syntax.Script, frame_rate: float | None = None) -> Iterator[Diagnostic]:
    """Yield what can be said without a library; its frame rate, if there is one, says how long frames are."""
    definitions = frozenset(item.name.text for item in script.items if isinstance(item, syntax.Let))
    uses = any(isinstance(item, syntax.Use) for item in script.items)
    yield from _Structure(frame_rate, None if uses else definitions).body(script.items, top=True)


def motion_mistakes(motion: syntax.Motion, definitions: frozenset[str] | None) -> Iterator[Diagnostic]:
    """Yield what is wrong with one expression, of what `check_structure` says of it.

    Parameters
    ----------
    definitions : the names that may be called with arguments; None if another file may hold more.
    """
    return _Structure(None, definitions).motion(motion, sub=False)


def is_sub(name: syntax.Name) -> bool:
    """Return whether a name is the word `Sub`, in whatever case; in quotes it is a name like others."""
    return not name.quoted and name.text.casefold() == SUB.casefold()


def without_groups(motion: syntax.Motion) -> syntax.Motion:
    """Return what stands in the parentheses, if there are any."""
    while isinstance(motion, syntax.Group):
        motion = motion.motion
    return motion


def group_of(call: syntax.Call) -> syntax.Motion | None:
    """Return what stands in the parentheses after a graph's name; None if it is not one motion expression."""
    if len(call.arguments) == 1 and call.arguments[0].name is None:
        value = call.arguments[0].value
        return None if isinstance(value, syntax.Quantity) else value
    return None


@dataclass(frozen=True, slots=True)
class _Structure:
    """What the checks need to know of the whole script.

    Attributes
    ----------
    definitions : the names that may be called with arguments; None if another file may hold more.
    """

    frame_rate: float | None
    definitions: frozenset[str] | None

    def body(self, items: Iterable[syntax.Item], top: bool = False) -> Iterator[Diagnostic]:
        for item in items:
            match item:
                case syntax.Let() | syntax.Use():
                    yield _definition_not_yet(item) if top else _nested(item)
                    if isinstance(item, syntax.Let):
                        yield from self._command(item.command, item.parameters or ())
                case syntax.Repeat(head, body):
                    yield _not_yet(head.span, "repeat")
                    yield from self.body(body)
                case syntax.Choose(head, branches):
                    yield _not_yet(head.span, "choose")
                    for branch in branches:
                        yield from self.body(branch.body)
                case syntax.Command():
                    yield from self._command(item)
                case syntax.Wait(duration, span):
                    yield from self._duration(duration, (), span)
                case syntax.End(graph) if is_sub(graph):
                    yield _misplaced_sub(graph)

    def _command(self, command: syntax.Command, parameters: tuple[syntax.Parameter, ...] = ()) -> Iterator[Diagnostic]:
        yield from self.motion(command.motion, sub=False)
        if command.once is not None:
            yield _not_yet(command.once, "once")
        if command.duration is not None:
            gap = Span(command.motion.span.end, command.duration.span.end)
            yield from self._duration(command.duration, parameters, gap)

    # --- durations ---

    def _duration(
        self, amount: syntax.Amount, parameters: tuple[syntax.Parameter, ...], whole: Span
    ) -> Iterator[Diagnostic]:
        """Yield what is wrong with a duration; `whole` is what could be taken out if it lasts no time."""
        if isinstance(amount, syntax.Name):
            if amount.sound and amount.text not in {parameter.name.text for parameter in parameters}:
                yield _no_number(amount)
            return
        if unit_of(amount) == "cycles":
            yield _not_yet(amount.span, "cycles")
            return
        seconds = seconds_from_quantity(amount, self.frame_rate)
        shortest = 0.5 / self.frame_rate if self.frame_rate is not None else 0.0
        if float(amount.number) == 0 or (seconds is not None and seconds < shortest):
            message = "this lasts no time" if float(amount.number) == 0 else "this is shorter than a frame"
            fix = Fix(whole, "", safe=False)
            yield Diagnostic("MS045", message, amount.span, help="leave it out, or give it time", fixes=(fix,))
        elif (seconds if seconds is not None else float(amount.number)) > LONGEST_S:
            yield Diagnostic("MS046", "this is longer than a day", amount.span, help="check number and unit")

    # --- motion expressions ---

    def motion(self, motion: syntax.Motion, sub: bool) -> Iterator[Diagnostic]:
        """Yield what is wrong with an expression; `sub` says whether a graph stands left of it by `with`."""
        match motion:
            case syntax.With(operands):
                yield from self.motion(operands[0], sub)
                for operand in operands[1:]:
                    yield from self.motion(operand, sub=True)
            case syntax.And(operands) | syntax.Or(operands):
                word = "and" if isinstance(motion, syntax.And) else "or"
                for operand in operands:
                    yield from self._set(operand, sub, f"`{word}`")
            case syntax.Not(operand):
                yield from self._set(operand, sub, "`not`")
            case syntax.Group(inner):
                yield from self.motion(inner, sub)
            case syntax.Qualified(graph, inner):
                yield from self._graph(graph, sub)
                yield from self.motion(inner, sub)
            case syntax.Call():
                yield from self._call(motion, sub)

    def _set(self, motion: syntax.Motion, sub: bool, whose: str) -> Iterator[Diagnostic]:
        """Yield what is wrong with an expression that has to be a set of motions."""
        layers = without_groups(motion)
        if isinstance(layers, syntax.With):
            message = f"{whose} takes sets of motions; this says what several graphs do"
            yield Diagnostic("MS034", message, layers.span, help="write `with` outside of it")
        yield from self.motion(motion, sub)

    def _graph(self, graph: syntax.Name, sub: bool) -> Iterator[Diagnostic]:
        if is_sub(graph) and not sub:
            yield _misplaced_sub(graph)

    def _call(self, call: syntax.Call, sub: bool) -> Iterator[Diagnostic]:
        if self.definitions is None or call.name.text in self.definitions:
            return
        yield from self._graph(call.name, sub)
        inner = group_of(call)
        if inner is not None:
            yield from self._set(inner, sub, "a graph")
            return
        message = f"`{call.name.text}` is not a definition, so it takes no arguments"
        advice = "after a graph's name, write one motion expression in the parentheses"
        yield Diagnostic("MS028", message, call.span, help=advice)


def _not_yet(span: Span, word: str) -> Diagnostic:
    message = f"`{word}` is part of Motion Script, but this version does not play it yet"
    return Diagnostic("MS060", message, span)


def _definition_not_yet(item: syntax.Let | syntax.Use) -> Diagnostic:
    if isinstance(item, syntax.Use):
        return _not_yet(item.span, "use")
    return _not_yet(Span(item.span.start, item.name.span.end), "let")


def _nested(item: syntax.Let | syntax.Use) -> Diagnostic:
    word = "let" if isinstance(item, syntax.Let) else "use"
    advice = "write it outside of `repeat` and `choose`; it may stand after what uses it"
    return Diagnostic("MS015", f"`{word}` stands at the top level of a script alone", item.span, help=advice)


def _no_number(amount: syntax.Name) -> Diagnostic:
    """Say what is wrong with `for sec` or `for t`."""
    if not amount.quoted and amount.text in UNITS:
        unit = UNITS[amount.text]
        advice = f"write how many, as in `10 {unit}`"
        return Diagnostic("MS017", f"how many {unit}? The number is missing", amount.span, help=advice)
    message = f"`{amount.text}` is not a duration, nor a parameter of a definition that this stands in"
    return Diagnostic("MS027", message, amount.span, help="write how long, as in `10 sec`")


def _misplaced_sub(graph: syntax.Name) -> Diagnostic:
    message = f"`{graph.text}` is the graph below the one named before `with`; there is none before it here"
    return Diagnostic("MS033", message, graph.span, help="write the graph's own name")
