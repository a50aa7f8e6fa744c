"""The syntax tree -> the typed plan: every statement with its type, or what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from mlmg_lang.definitions.expand import told_from
from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.diagnostics import Diagnostic, Label, has_errors, n_errors
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import seconds_from_quantity, unit_of
from mlmg_lang.parsing.nesting import Make
from mlmg_lang.parsing.parse import MAX_MISTAKES
from mlmg_lang.parsing.structure import is_sub, motion_mistakes
from mlmg_lang.planning import typed
from mlmg_lang.planning.binding.hints import graph_hints, inexact, spelling_hints
from mlmg_lang.planning.binding.scope import Scope, Unbound
from mlmg_lang.planning.binding.unbound import graph_name, unbound
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.select import select
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import listed, normal

_MAX_COUNT = 10**9


class Planner:
    """Gives statements their types, and collects what is wrong."""

    def __init__(
        self, definitions: Definitions, names: Names, frame_rate: float, source: Source, *, explains: bool = True
    ) -> None:
        """Take what names can mean; the definitions have been put in already.

        Parameters
        ----------
        explains : whether what is wrong is worked out; else types are the same, and what is said of them is not meant
            to be told.
        """
        self.diagnostics: list[Diagnostic] = []
        self._n_errors = 0
        self._is_faulty = False
        self._scope = Scope(
            names,
            frozenset(),
            not definitions.complete,
            own=definitions.lets,
            unread=definitions.unread,
            explains=explains,
        )
        self._frame_rate = frame_rate
        self._source = source

    def define(self, definitions: Definitions) -> None:
        """Report what is wrong with the names of definitions and the names in them."""
        known = frozenset(definitions.lets)
        for let in definitions.lets.values():
            if self._n_errors > MAX_MISTAKES:
                self._give_up(let.name.span)
                return
            self._tell(_clashes(let.name, self._scope.names))
            own = frozenset(normal(parameter.name.text) for parameter in let.parameters or ())
            scope = replace(self._scope, definitions=known, parameters=own)
            n_told = len(self.diagnostics)
            if self._report(unbound(let.command.motion, scope)):
                told = self._taken_back(n_told)
                self._tell(self._of_names(told, let.span))
            self._tell(spelling_hints(let.command.motion, scope))
            for parameter in let.parameters or ():
                if parameter.default is not None and not isinstance(parameter.default, syntax.Quantity):
                    self._report(unbound(parameter.default, replace(scope, parameters=frozenset())))

    def _of_names(self, told: Sequence[Diagnostic], span: Span) -> Sequence[Diagnostic]:
        """Return what is wrong with a definition, of names with spaces in them each told once."""
        from mlmg_lang.parsing.tokenize import tokenize
        from mlmg_lang.planning.binding.apart import told_of_names

        tokens = moved(tuple(tokenize(Source(self._source.slice(span)))), by(span.start))
        return told_of_names(told, tokens, self._scope.names)

    def body(self, items: Iterable[syntax.Item]) -> tuple[typed.Statement, ...]:
        """Return the typed statements of a body."""
        return tuple(self._statement(item) for item in items)

    def take(self) -> tuple[bool, tuple[Diagnostic, ...]]:
        """Return whether anything has been wrong since this was asked last, said or not, and what there is to say."""
        is_faulty = self._is_faulty or self._n_errors > 0
        self._is_faulty = False
        return is_faulty, tuple(self._taken_back(0))

    def _tell(self, told: Iterable[Diagnostic]) -> None:
        told = tuple(told)
        self.diagnostics += told
        self._n_errors += n_errors(told)

    def _taken_back(self, first: int) -> list[Diagnostic]:
        """Return what has been told from a number on, which then has not been told."""
        self.diagnostics, taken = self.diagnostics[:first], self.diagnostics[first:]
        self._n_errors -= n_errors(taken)
        return taken

    def _statement(self, item: syntax.Item) -> typed.Statement:
        planned: typed.Statement = typed.Unplanned(item.span)
        match item:
            case _ if self._n_errors > MAX_MISTAKES:
                self._give_up(item.span)
            case syntax.Command():
                planned = self._command(item)
            case syntax.Wait(amount, span):
                planned = typed.Wait(self._duration(amount), span)
            case syntax.End(graph, span):
                planned = self._end(graph, span)
            case syntax.Repeat(head, body, span):
                planned = TYPED.repeat(head, self.body(body), span)
            case syntax.Choose(head, branches, span):
                parts = (TYPED.branch(one.weight, self.body(one.body), one.span) for one in branches)
                planned = TYPED.choose(head, tuple(parts), span)
        return planned

    def _give_up(self, span: Span) -> None:
        if self.diagnostics[-1].code != "MS006":
            self._tell([too_many(span)])

    def _command(self, command: syntax.Command) -> typed.Statement:
        before = len(self.diagnostics)
        ways = self._ways(command.motion, command.span)
        self.diagnostics[before:] = [told_from(one, command.span) for one in self.diagnostics[before:]]
        if ways is None:
            return typed.Unplanned(command.span)
        duration = None if command.duration is None else self._duration(command.duration)
        once = command.once is not None
        return typed.Command(ways, duration, once, self._start(command.motion, ways), command.span)

    def _ways(self, motion: syntax.Motion, command: Span) -> tuple[typed.Layering, ...] | None:
        """Return the assignments that an expression allows; None, and that is reported, if there is none."""
        wrong = self._report(_written(unbound(motion, self._scope), command))
        # What is called now is a graph, even where it is not known yet what else is defined.
        if wrong or any(motion_mistakes(motion)):
            return None
        ways = select(motion, self._scope.names, self._source, explains=self._scope.explains)
        if isinstance(ways, Diagnostic):
            self._tell([self._at_its_use(ways, command)])
            return None
        remarks = (*graph_hints(motion, self._scope.names), *self._remarks(ways[0]))
        self._tell(remarks)
        return None if has_errors(remarks) else ways

    def _at_its_use(self, one: Diagnostic, command: Span) -> Diagnostic:
        """Return what is wrong with a command, told of the command if what it uses is right by itself."""
        place = one.span
        if place is None or _is_within(place, command):
            return one
        let = next((let for let in self._scope.own.values() if _is_within(place, let.span)), None)
        if let is None or not self._can_be_played(let):
            return one
        return replace(one, span=command, labels=(*one.labels, Label(place, f"in `{let.name.text}`, which it uses")))

    def _can_be_played(self, let: syntax.Let) -> bool:
        """Return whether a definition, which names no other, is right as a command of its own."""
        names = {normal(node.text) for node in syntax.walk(let.command.motion) if isinstance(node, syntax.Name)}
        if let.parameters or names & self._scope.own.keys():
            return False
        return not isinstance(select(let.command.motion, self._scope.names, self._source, explains=False), Diagnostic)

    def _report(self, wrong: Iterable[Unbound]) -> bool:
        """Collect what is to be said of names that mean nothing; return whether there are any."""
        found = False
        for one in wrong:
            found = True
            if one.diagnostic is not None:
                self._tell([one.diagnostic])
            if self._n_errors > MAX_MISTAKES or not self._scope.explains:
                break
        self._is_faulty = self._is_faulty or found
        return found

    def _remarks(self, way: typed.Layering) -> Iterator[Diagnostic]:
        """Yield what there is to say of the spelling of the names that were found."""
        for layer in way.layers:
            for leaf in _leaves(layer.choice):
                if not leaf.motions or normal(leaf.written) == normal(leaf.name):
                    continue
                name = syntax.Name(leaf.written, False, True, leaf.span)
                match = self._scope.names.find(leaf.graph, leaf.written)
                if match is not None and match.others:
                    spellings = listed((leaf.name, *(other.name for other in match.others)), "or")
                    message = f"`{leaf.written}` could be {spellings}"
                    yield Diagnostic("MS023", message, leaf.span, "write it exactly as it is spelt in the library")
                else:
                    yield from inexact(name, leaf.name)

    def _start(self, motion: syntax.Motion, ways: tuple[typed.Layering, ...]) -> str | None:
        """Return the motion of the root graph that a command is the name of, if it is one."""
        layer = ways[0].layers[0].choice
        if not isinstance(motion, syntax.Reference) or not isinstance(layer, typed.Named):
            return None
        is_motion = layer.kind is Kind.MOTION and layer.graph == self._scope.names.root
        return layer.name if is_motion else None

    def _end(self, graph: syntax.Name, span: Span) -> typed.Statement:
        if is_sub(graph) or self._report(graph_name(graph, self._scope)):
            return typed.Unplanned(span)
        meant = self._scope.names.graph(graph.text) or graph.text
        self._tell(inexact(graph, meant))
        return typed.End(meant, span)

    def _duration(self, amount: syntax.Amount) -> typed.Duration:
        if isinstance(amount, syntax.Name):
            return typed.Duration(None, None, amount.span)
        cycles = float(amount.number) if unit_of(amount) == "cycles" else None
        return typed.Duration(seconds_from_quantity(amount, self._frame_rate), cycles, amount.span)


def too_many(span: Span) -> Diagnostic:
    """Say that what is wrong with names from a place on is not told."""
    message = f"more than {MAX_MISTAKES} mistakes; what is wrong with the names from here on is not told"
    return Diagnostic("MS006", message, span, "is this the right library?")


def _is_within(place: Span, whole: Span) -> bool:
    return whole.start <= place.start and place.end <= whole.end


def _written(wrong: Iterable[Unbound], command: Span) -> Iterator[Unbound]:
    """Yield names that mean nothing; what is wrong with those of definitions is reported where these stand."""
    for one in wrong:
        span = None if one.diagnostic is None else one.diagnostic.span
        is_own = span is None or _is_within(span, command)
        yield one if is_own else Unbound(None)


def _clashes(name: syntax.Name, names: Names) -> Iterator[Diagnostic]:
    """Yield what a definition's name is besides."""
    if is_sub(name) or normal(name.text) in map(normal, names.graphs):
        what = "a word for the graph below another" if is_sub(name) else "a graph"
        yield Diagnostic("MS052", f"`{name.text}` is {what}, so it cannot be defined", name.span, "choose another name")
        return
    match = next((found for graph in names.graphs if (found := names.find(graph, name.text, exactly=True))), None)
    if match is not None:
        message = f"`{name.text}` is a {match.entry.kind} of this library, which this definition hides"
        yield Diagnostic("MS053", message, name.span, "choose another name, unless that is meant")


def _leaves(choice: typed.Choice) -> Iterator[typed.Named]:
    match choice:
        case typed.Named():
            yield choice
        case typed.AllBut(operand=operand):
            yield from _leaves(operand)
        case typed.Both(operands=operands) | typed.Either(operands=operands):
            for operand in operands:
                yield from _leaves(operand)


def _count(digits: str) -> int:
    """Return a whole number; one with too many digits for a person to have meant is cut."""
    return min(int(digits[:20]), _MAX_COUNT)


def _repeat(head: syntax.RepeatHead, body: tuple[typed.Statement, ...], span: Span) -> typed.Statement:
    return typed.Repeat(_count(head.count), body, span)


def _branch(weight: syntax.Weight | None, body: tuple[typed.Statement, ...], span: Span) -> typed.Branch:
    return typed.Branch(1 if weight is None else _count(weight.number), body, span)


def _choose(_: syntax.ChooseHead, branches: tuple[typed.Branch, ...], span: Span) -> typed.Statement:
    return typed.Choose(branches, span)


TYPED: Final[Make[typed.Statement, typed.Branch]] = Make(_repeat, _branch, _choose, lambda _: ())
"""Makes the types of blocks of those of statements; a weight that is none, which has been reported, has none."""
