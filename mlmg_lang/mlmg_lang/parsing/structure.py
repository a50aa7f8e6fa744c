"""The syntax tree -> what is wrong with it whatever the library."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import UNITS, seconds_from_quantity, unit_of
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.source import Span
from mlmg_lang.spelling import listed, nearest, normal

SUB = "Sub"
"""In place of a graph's name: the child of the graph last named."""
LONGEST_S = 24 * 3600.0
"""The longest duration that anyone can mean."""
MAX_EXECUTED = 100_000
"""The most statements that a `repeat` may come to."""

_DURATION: Final = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*([a-z]+)")


def misplaced(script: syntax.Script) -> Iterator[Diagnostic]:
    """Yield the definitions that do not stand at the top level."""
    for item in script.items:
        if isinstance(item, syntax.Repeat | syntax.Choose):
            for node in syntax.walk(item):
                if isinstance(node, syntax.Let | syntax.Use):
                    yield nested_definition(node)


def check_structure(
    script: syntax.Script,
    frame_rate: float | None = None,
    complete: bool = True,
    own: Sequence[str] = (),
    unread: Collection[str] = (),
) -> Iterator[Diagnostic]:
    """Yield what can be said of a script without a library, when its definitions have been put in.

    Parameters
    ----------
    frame_rate : of the library, if there is one; it says how long frames are.
    complete : False if a file with definitions could not be used, so that any name may be one.
    own : the names of all definitions. unread : those, in NFC, of definitions that could not be read.
    """
    yield from _Structure(frame_rate, complete, own, unread).body(script.items)


def check_blocks(items: Iterable[syntax.Item]) -> Iterator[Diagnostic]:
    """Yield what is wrong with blocks themselves, of what `check_structure` says."""
    for item in items:
        match item:
            case syntax.Repeat():
                yield from _repeat(item)
                yield from check_blocks(item.body)
            case syntax.Choose():
                yield from _choose(item)
                for branch in item.branches:
                    yield from check_blocks(branch.body)


def check_definition(let: syntax.Let, frame_rate: float | None = None) -> Iterator[Diagnostic]:
    """Yield what can be said of a definition wherever it is used."""
    structure = _Structure(frame_rate, False)
    yield from structure.motion(let.command.motion, sub=True)
    parameters = tuple(parameter.name.text for parameter in let.parameters or ())
    if let.command.duration is not None:
        yield from structure.duration(let.command.duration, parameters)


def motion_mistakes(motion: syntax.Motion) -> Iterator[Diagnostic]:
    """Yield what is wrong with one expression, of what `check_structure` says of it where all definitions are known."""
    return _Structure(None, complete=True).motion(motion, sub=False)


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


def n_executed(items: Iterable[syntax.Item]) -> int:
    """Return how many statements are executed at most; counts over a billion are cut."""
    total = 0
    for item in items:
        if isinstance(item, syntax.Repeat):
            total += min(int(item.head.count[:20]), 10**9) * n_executed(item.body)
        elif isinstance(item, syntax.Choose):
            total += max((n_executed(branch.body) for branch in item.branches), default=0)
        else:
            total += 1
    return min(total, 10**9)


@dataclass(frozen=True, slots=True)
class _Structure:
    """What the checks need to know of the whole script; see `check_structure`."""

    frame_rate: float | None
    complete: bool
    own: Sequence[str] = ()
    unread: Collection[str] = ()

    def body(self, items: Iterable[syntax.Item]) -> Iterator[Diagnostic]:
        for item in items:
            match item:
                case syntax.Repeat(body=body):
                    yield from _repeat(item)
                    yield from self.body(body)
                case syntax.Choose(branches=branches):
                    yield from _choose(item)
                    for branch in branches:
                        yield from self.body(branch.body)
                case syntax.Command():
                    yield from self._command(item)
                case syntax.Wait(duration):
                    yield from self.duration(duration)
                case syntax.End(graph) if is_sub(graph):
                    yield _misplaced_sub(graph)

    def _command(self, command: syntax.Command) -> Iterator[Diagnostic]:
        yield from self.motion(command.motion, sub=False)
        # A name comes from a definition where it stands elsewhere, and has been looked at there.
        if command.duration is not None and (
            isinstance(command.duration, syntax.Quantity) or _is_within(command.duration, command)
        ):
            yield from self.duration(command.duration)

    # --- durations ---

    def duration(self, amount: syntax.Amount, parameters: Sequence[str] = ()) -> Iterator[Diagnostic]:
        """Yield what is wrong with a duration; `parameters` are those of the definition that it stands in."""
        if isinstance(amount, syntax.Name):
            if amount.sound and normal(amount.text) not in map(normal, parameters):
                yield _no_number(amount, parameters)
            return
        number = float(amount.number)
        seconds = seconds_from_quantity(amount, self.frame_rate)
        shortest = 0.5 / self.frame_rate if self.frame_rate is not None else 0.0
        if number == 0 or (seconds is not None and seconds < shortest):
            message = "this lasts no time" if number == 0 else "this is shorter than a frame"
            # No edit: without `for`, the last command of a script plays to the end of its clip.
            yield Diagnostic("MS045", message, amount.span, help="write how long, as in `3 sec`")
        elif seconds is not None and seconds > LONGEST_S:
            yield Diagnostic("MS046", "this is longer than a day", amount.span, help="check number and unit")
        elif unit_of(amount) == "cycles" and number > LONGEST_S:
            message = "this is more cycles than a day has seconds"
            yield Diagnostic("MS046", message, amount.span, help="check number and unit")

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
                # What stands behind a definition has been told of with it, however it is written.
                if not (isinstance(inner, syntax.Call) and graph.text in self.own):
                    yield from self.motion(inner, sub)
            case syntax.Call():
                yield from self._call(motion, sub)

    def _set(self, motion: syntax.Motion, sub: bool, whose: str) -> Iterator[Diagnostic]:
        """Yield what is wrong with an expression that has to be a set of motions."""
        layers = without_groups(motion)
        if isinstance(layers, syntax.With):
            message = f"{whose} takes sets of motions; this says what several graphs do"
            inside = motion.span.start <= layers.span.start and layers.span.end <= motion.span.end
            span = layers.span if inside else motion.span
            yield Diagnostic("MS034", message, span, help="write `with` outside of it")
        yield from self.motion(motion, sub)

    def _graph(self, graph: syntax.Name, sub: bool) -> Iterator[Diagnostic]:
        if is_sub(graph) and not sub:
            yield _misplaced_sub(graph)

    def _call(self, call: syntax.Call, sub: bool) -> Iterator[Diagnostic]:
        if not self.complete or normal(call.name.text) in self.unread:
            return
        yield from self._graph(call.name, sub)
        inner = group_of(call)
        if inner is not None:
            yield from self._set(inner, sub, "a graph")
            return
        yield _no_definition(call, self.own)


def _repeat(repeat: syntax.Repeat) -> Iterator[Diagnostic]:
    if int(repeat.head.count[:20]) == 0:
        message, advice = "this is repeated no times", "leave it out, or say how often"
        fix = Fix(repeat.span, "", safe=False)
        yield Diagnostic("MS045", message, repeat.head.span, help=advice, fixes=(fix,))
    elif n_executed((repeat,)) > MAX_EXECUTED and n_executed(repeat.body) <= MAX_EXECUTED:
        message = f"this comes to more than {MAX_EXECUTED:,} statements, one after the other"
        yield Diagnostic("MS048", message, repeat.head.span, help="repeat it less often")


def _choose(choose: syntax.Choose) -> Iterator[Diagnostic]:
    weights = [1 if branch.weight is None else int(branch.weight.number[:20]) for branch in choose.branches]
    if not any(weights):
        message = "every branch has the weight 0, so none can be drawn"
        yield Diagnostic("MS049", message, choose.head.span, help="give one of them a weight above 0")


def _is_within(part: syntax.Node, whole: syntax.Node) -> bool:
    return whole.span.start <= part.span.start and part.span.end <= whole.span.end


def nested_definition(item: syntax.Let | syntax.Use) -> Diagnostic:
    """Return what to say of a definition that stands in a block."""
    word = "let" if isinstance(item, syntax.Let) else "use"
    advice = "write it outside of `repeat` and `choose`; it may stand after what uses it"
    return Diagnostic("MS015", f"`{word}` stands at the top level of a script alone", item.span, help=advice)


def _no_number(amount: syntax.Name, parameters: Sequence[str]) -> Diagnostic:
    """Say what is wrong with `for sec` or `for t`."""
    if not amount.quoted and amount.text in UNITS:
        unit = UNITS[amount.text]
        advice = f"write how many, as in `10 {unit}`"
        return Diagnostic("MS017", f"how many {unit}? The number is missing", amount.span, help=advice)
    if amount.quoted and (written := _DURATION.fullmatch(amount.text.strip())) and written[2] in UNITS:
        right = f"{written[1]} {UNITS[written[2]]}"
        fix = Fix(amount.span, right, safe=True)
        return Diagnostic("MS027", "a duration stands without quotes", amount.span, f"write `{right}`", fixes=(fix,))
    near = nearest(amount.text, parameters, limit=1)
    if near:
        message = f"`{amount.text}` is not a parameter of this definition"
        fix = Fix(amount.span, script_name(near[0]), safe=False)
        return Diagnostic("MS027", message, amount.span, f"there is the parameter `{near[0]}`", fixes=(fix,))
    message = f"`{amount.text}` is not a duration, nor a parameter of a definition that this stands in"
    return Diagnostic("MS027", message, amount.span, help="write how long, as in `10 sec`")


def _no_definition(call: syntax.Call, own: Sequence[str]) -> Diagnostic:
    """Say what is wrong with arguments for something that is not defined."""
    name = call.name
    message = f"`{name.text}` is not a definition, so it takes no arguments"
    near = nearest(name.text, own)
    if near:
        fixes = tuple(Fix(name.span, script_name(word), safe=False) for word in near)
        return Diagnostic("MS028", message, name.span, f"there is the definition {listed(near, 'or')}", fixes=fixes)
    if not call.arguments:
        empty = Fix(Span(name.span.end, call.span.end), "", safe=True, name="take the parentheses out")
        advice = f"write `{script_name(name.text)}` without parentheses"
        return Diagnostic("MS028", message, call.span, advice, fixes=(empty,))
    argument = call.arguments[0].value
    if len(call.arguments) == 1 and isinstance(argument, syntax.Quantity):
        right = f"{script_name(name.text)} for {argument.number} {argument.unit}"
        fix = Fix(call.span, right, safe=False)
        return Diagnostic("MS028", message, call.span, f"for how long, write `{right}`", fixes=(fix,))
    advice = "after a graph's name, write one motion expression in the parentheses"
    return Diagnostic("MS028", message, call.span, help=advice)


def _misplaced_sub(graph: syntax.Name) -> Diagnostic:
    message = f"`{graph.text}` is the graph below the one named before `with`; there is none before it here"
    return Diagnostic("MS033", message, graph.span, help="write the graph's own name")
