"""A syntax tree with uses of definitions -> one without: what a definition says stands in parentheses in their place.

Nodes keep their spans: what comes out of a definition is found where that is written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.definitions.parameters import Kind, Signature, references
from mlmg_lang.diagnostics import Diagnostic, Fix, Note
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import MAX_DEPTH
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.source import Span
from mlmg_lang.spelling import listed, nearest, normal

MAX_NODES = 20_000
"""So large may one command become."""
MAX_ALL_NODES = 200_000
"""So large may all commands of a script become together in which something is defined."""


@dataclass(frozen=True, slots=True)
class _Value:
    """What a parameter stands for; of a motion, how many nodes it has, and how deep they are nested."""

    value: syntax.Motion | syntax.Quantity
    n_nodes: int = 0
    height: int = 0


Values: TypeAlias = Mapping[str, _Value]


def told_from(one: Diagnostic, command: Span) -> Diagnostic:
    """Return what is wrong with something that a command says with the command's place, if it is a definition's."""
    if one.span is None or (command.start <= one.span.start and one.span.end <= command.end):
        return one
    return replace(one, notes=(*one.notes, Note("it is used here", command)))


def any_broken(items: Iterable[syntax.Item]) -> bool:
    """Return whether some of a script could not be read: that may use all definitions."""
    return any(isinstance(node, syntax.Broken) for item in items for node in syntax.walk(item))


def names_in(item: syntax.Item) -> frozenset[str]:
    """Return all names in an item, in NFC, whatever they are those of."""
    return frozenset(normal(node.text) for node in syntax.walk(item) if isinstance(node, syntax.Name))


def used_names(items: Iterable[syntax.Item]) -> frozenset[str]:
    """Return the names, in NFC, that statements use, be they those of definitions or not; no names without statements.

    An empty one stands for statements that use none.
    """
    statements = [item for item in items if not isinstance(item, syntax.Let | syntax.Use)]
    nodes = (node for item in statements for node in syntax.walk(item))
    found = {normal(node.name.text) for node in nodes if isinstance(node, syntax.Reference | syntax.Call)}
    return frozenset(found | {""} if statements else ())


def unused(items: Iterable[syntax.Item], used: Iterable[str], definitions: Definitions) -> Iterator[Diagnostic]:
    """Yield the definitions of a script that nothing in it uses.

    A script of nothing but definitions is there for others to use.

    Parameters
    ----------
    items : of the script; those that are no definitions do not matter.
    used : the names that its statements use.
    """
    known = set(used)
    if not known:
        return
    names = list(known)
    while names:
        let = definitions.lets.get(names.pop())
        fresh = {normal(name.text) for name in references(let)} - known if let else set()
        known |= fresh
        names += fresh
    for item in items:
        if isinstance(item, syntax.Let) and item.name.sound and normal(item.name.text) not in known:
            message = f"`{item.name.text}` is defined, but not used"
            yield Diagnostic("MS054", message, item.name.span, "take it out, or use it")


class _Failed(Exception):
    """What stands here cannot be expanded, and that has been reported."""


@dataclass(slots=True)
class Expander:
    """Puts in what is defined.

    Attributes
    ----------
    command : where the command is that is being worked at.
    visited : how many nodes have been looked at for it, the same ones again and again.
    nodes, deepest : of what it becomes, or a parameter's value in it, as far as that is known.
    all_nodes : of all commands before.
    """

    definitions: Definitions
    diagnostics: list[Diagnostic] = field(default_factory=list)
    command: Span = field(default_factory=lambda: Span(0, 0))
    visited: int = 0
    nodes: int = 0
    deepest: int = 0
    all_nodes: int = 0

    # --- statements ---

    def body(self, items: tuple[syntax.Item, ...]) -> tuple[syntax.Item, ...]:
        """Return the statements of a body with all that is defined put in."""
        return tuple(self._item(item) for item in items if not isinstance(item, syntax.Let | syntax.Use))

    def _item(self, item: syntax.Item) -> syntax.Item:
        match item:
            case syntax.Command():
                return self._command(item)
            case syntax.Repeat(body=body):
                return replace(item, body=self.body(body))
            case syntax.Choose(branches=branches):
                return replace(item, branches=tuple(replace(one, body=self.body(one.body)) for one in branches))
        return item

    def _command(self, command: syntax.Command) -> syntax.Item:
        self.command = command.span
        self.visited = self.nodes = self.deepest = 0
        try:
            whole = self._whole(command)
            motion = self._motion(command.motion, {}, 0) if whole is None else whole.motion
        except _Failed:
            return syntax.Broken(command.span)
        if motion is command.motion:
            return command
        self._count_all()
        return whole or replace(command, motion=motion)

    def _count_all(self) -> None:
        """Count what has been put into a command; say it once when that has become too much for a script."""
        before = self.all_nodes
        self.all_nodes += self.nodes
        if before <= MAX_ALL_NODES < self.all_nodes:
            message = "with this, the script becomes too large when what is defined is put in"
            self._fail(Diagnostic("MS048", message, self.command, "leave some of it to another script"))

    def _whole(self, command: syntax.Command) -> syntax.Command | None:
        """Return what a command does that is nothing but the use of a definition that says how long."""
        motion = command.motion
        if not isinstance(motion, syntax.Reference | syntax.Call):
            return None
        let = self.definitions.find(motion.name)
        signature = self._signature(let)
        if let is None or signature is None or not signature.lasts:
            return None
        if command.duration is not None or command.once is not None:
            from mlmg_lang.definitions.lasting import lasts_already

            raise self._fail(lasts_already(let, signature, motion, command))
        values = self._values(motion, let, signature, {}, 0)
        duration = self._amount(let.command.duration, values)
        body = self._motion(let.command.motion, values, 1)
        return syntax.Command(body, duration, let.command.once, command.span)

    def _amount(self, amount: syntax.Amount | None, values: Values) -> syntax.Amount | None:
        if isinstance(amount, syntax.Name):
            given = values.get(normal(amount.text))
            return given.value if given is not None and isinstance(given.value, syntax.Quantity) else amount
        return amount

    # --- motion expressions ---

    def _motion(self, motion: syntax.Motion, values: Values, depth: int) -> syntax.Motion:
        """Return an expression with all that is defined put in; the very same if nothing is."""
        self._grow(1, depth)
        match motion:
            case syntax.Reference(name, span):
                given = values.get(normal(name.text))
                return self._used(motion, values, depth) if given is None else self._given_motion(given, span, depth)
            case syntax.Call():
                return self._called(motion, values, depth)
            case syntax.Qualified():
                return self._qualified(motion, values, depth)
            case syntax.Group(inner) | syntax.Not(inner):
                put_in = self._motion(inner, values, depth + 1)
                return motion if put_in is inner else type(motion)(put_in, motion.span)
        operands = tuple(self._motion(operand, values, depth + 1) for operand in motion.operands)
        return motion if operands == motion.operands else replace(motion, operands=operands)

    def _grow(self, n_nodes: int, depth: int) -> None:
        """Count what is put in, and fail where that is too much or too deep."""
        self.visited += 1
        self.nodes += n_nodes
        self.deepest = max(self.deepest, depth)
        if max(self.nodes, self.visited) > MAX_NODES or depth > 2 * MAX_DEPTH:
            message = "this becomes too large when what is defined is put in"
            raise self._fail(Diagnostic("MS048", message, self.command, "say it with fewer definitions in each other"))

    def _given_motion(self, given: _Value, span: Span, depth: int) -> syntax.Motion:
        """Return the value of a parameter where it is used, in parentheses if it is more than a name."""
        motion = given.value
        assert not isinstance(motion, syntax.Quantity), "kinds are checked where arguments are given"
        self._grow(given.n_nodes, depth + given.height + 1)
        return motion if isinstance(motion, syntax.Reference | syntax.Group) else syntax.Group(motion, span)

    def _measured(self, value: syntax.Motion | syntax.Quantity, values: Values, depth: int) -> _Value:
        """Return what a parameter stands for, with all that is defined put in."""
        if isinstance(value, syntax.Quantity):
            return _Value(value)
        before = self.nodes, self.deepest
        self.nodes, self.deepest = 0, depth
        put_in = self._motion(value, values, depth)
        measured = _Value(put_in, self.nodes, self.deepest - depth)
        self.nodes, self.deepest = before
        return measured

    def _qualified(self, motion: syntax.Qualified, values: Values, depth: int) -> syntax.Motion:
        put_in = self._motion(motion.motion, values, depth + 1)
        if put_in is motion.motion:
            return motion
        if isinstance(put_in, syntax.Reference):
            return replace(motion, motion=put_in)
        return syntax.Call(motion.graph, (syntax.Argument(None, put_in, motion.motion.span),), motion.span)

    def _called(self, call: syntax.Call, values: Values, depth: int) -> syntax.Motion:
        if normal(call.name.text) not in values and self.definitions.find(call.name) is not None:
            return self._used(call, values, depth)
        arguments = tuple(self._argument(argument, values, depth) for argument in call.arguments)
        return call if arguments == call.arguments else replace(call, arguments=arguments)

    def _argument(self, argument: syntax.Argument, values: Values, depth: int) -> syntax.Argument:
        if isinstance(argument.value, syntax.Quantity):
            return argument
        return replace(argument, value=self._motion(argument.value, values, depth + 1))

    def _used(self, use: syntax.Reference | syntax.Call, values: Values, depth: int) -> syntax.Motion:
        """Return what a definition says, in parentheses; other names stay as they are."""
        let = self.definitions.find(use.name)
        if let is None:
            return use
        signature = self._signature(let)
        if signature is None:
            raise _Failed
        if signature.lasts:
            message = (
                f"`{let.name.text}` says how long it lasts, so it is a whole statement and cannot stand in another"
            )
            note = Note("it is defined here", let.name.span)
            advice = "define the motion without `for` and `once`, and say here how long"
            raise self._fail(Diagnostic("MS057", message, use.span, advice, (note,)))
        inside = self._values(use, let, signature, values, depth)
        return syntax.Group(self._motion(let.command.motion, inside, depth + 1), use.span)

    def _signature(self, let: syntax.Let | None) -> Signature | None:
        return None if let is None else self.definitions.signatures.get(normal(let.name.text))

    # --- arguments ---

    def _values(
        self,
        use: syntax.Reference | syntax.Call,
        let: syntax.Let,
        signature: Signature,
        outside: Values,
        depth: int,
    ) -> dict[str, _Value]:
        """Return what the parameters of a definition stand for in one use of it."""
        if self.all_nodes > MAX_ALL_NODES:
            raise _Failed
        arguments = use.arguments if isinstance(use, syntax.Call) else ()
        given = self._given(use, let, arguments)
        values: dict[str, _Value] = {}
        for parameter in let.parameters or ():
            name = normal(parameter.name.text)
            argument = given.get(name)
            if argument is not None:
                values[name] = self._value(argument, name, let, signature.kinds[name], outside, depth)
            elif parameter.default is not None:
                values[name] = self._measured(parameter.default, {}, depth + 1)
        missing = [p.name.text for p in let.parameters or () if normal(p.name.text) not in values]
        if missing:
            message = f"`{let.name.text}` is used without its {listed(missing)}"
            advice = "write them in the parentheses, separated by `,`"
            if len(missing) == 1:
                advice = f"write a {signature.kinds[normal(missing[0])] or 'motion'} for it in the parentheses"
            raise self._misfit(use.span, message, let, advice)
        return values

    def _given(
        self, use: syntax.Reference | syntax.Call, let: syntax.Let, arguments: tuple[syntax.Argument, ...]
    ) -> dict[str, syntax.Argument]:
        """Return the arguments of a use by the parameters that they are for."""
        names = [parameter.name.text for parameter in let.parameters or ()]
        if isinstance(use, syntax.Call) and let.parameters is None:
            take_out = Fix(
                Span(use.name.span.end, use.span.end), "", safe=not use.arguments, name="take the parentheses out"
            )
            message, advice = f"`{let.name.text}` takes no arguments", f"write `{script_name(let.name.text)}` alone"
            raise self._misfit(use.span, message, let, advice, (take_out,))
        given: dict[str, syntax.Argument] = {}
        named = False
        for at, argument in enumerate(arguments):
            named = named or argument.name is not None
            if argument.name is None and named:
                message = "an argument without a name stands before those with one"
                raise self._misfit(argument.span, message, let, "write its name and `=` before it")
            if argument.name is None and at >= len(names):
                many = f"{len(names)} argument{'' if len(names) == 1 else 's'}" if names else "no arguments"
                raise self._misfit(argument.span, f"`{let.name.text}` takes {many}", let, "take this one out")
            written = names[at] if argument.name is None else argument.name.text
            if normal(written) not in map(normal, names):
                assert argument.name is not None
                raise self._no_parameter(argument.name, names, let)
            if normal(written) in given:
                raise self._misfit(argument.span, f"`{written}` is given twice", let, "take one of them out")
            given[normal(written)] = argument
        return given

    def _value(
        self,
        argument: syntax.Argument,
        name: str,
        let: syntax.Let,
        kind: Kind | None,
        outside: Values,
        depth: int,
    ) -> _Value:
        value = argument.value
        passed_on = outside.get(normal(value.name.text)) if isinstance(value, syntax.Reference) else None
        if passed_on is not None and isinstance(passed_on.value, syntax.Quantity):
            value = passed_on.value
        is_duration = isinstance(value, syntax.Quantity)
        if kind is not None and is_duration != (kind is Kind.DURATION):
            found = Kind.DURATION if is_duration else Kind.MOTION
            message = f"`{name}` of `{let.name.text}` is a {kind}; this is a {found}"
            example = "such as `2 sec`" if kind is Kind.DURATION else "such as a tag"
            note = Note("it is defined here", let.name.span)
            raise self._fail(Diagnostic("MS056", message, argument.span, f"write a {kind}, {example}", (note,)))
        return self._measured(value, outside, depth + 1)

    def _no_parameter(self, name: syntax.Name, names: list[str], let: syntax.Let) -> _Failed:
        near = nearest(name.text, names, limit=1)
        advice = f"it has {listed(near or names)}" if names else None
        fixes = tuple(Fix(name.span, script_name(word), safe=False) for word in near)
        return self._misfit(name.span, f"`{let.name.text}` has no parameter `{name.text}`", let, advice, fixes)

    def _misfit(
        self, span: Span, message: str, let: syntax.Let, advice: str | None = None, fixes: tuple[Fix, ...] = ()
    ) -> _Failed:
        takes = ", ".join(_shown(parameter) for parameter in let.parameters or ())
        written = f"{let.name.text}({takes})" if let.parameters is not None else let.name.text
        note = Note(f"it is defined here as `{written}`", let.name.span)
        return self._fail(Diagnostic("MS055", message, span, advice, (note,), fixes))

    def _fail(self, diagnostic: Diagnostic) -> _Failed:
        self.diagnostics.append(diagnostic)
        return _Failed()


def _shown(parameter: syntax.Parameter) -> str:
    """Return a parameter as it is written, its default as far as that is short."""
    default = parameter.default
    if isinstance(default, syntax.Quantity):
        return f"{parameter.name.text} = {default.number} {default.unit}"
    return f"{parameter.name.text} = ..." if default is not None else parameter.name.text
