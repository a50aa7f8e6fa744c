"""The syntax tree: what a script says, before anyone asks whether it makes sense."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Final, TypeAlias

from mlmg_lang.source import Span


class Node:
    """Whatever has a place in the tree."""

    __slots__ = ()
    span: Span


@dataclass(frozen=True, slots=True)
class Name(Node):
    """A name as written.

    Attributes
    ----------
    text : without the quotes and with its escapes undone.
    sound : False if the text cannot be a name; tokens that are wrong have been reported by themselves.
    """

    text: str
    quoted: bool
    sound: bool
    span: Span


@dataclass(frozen=True, slots=True)
class Quantity(Node):
    """A number with a unit, as in `10 sec`.

    Attributes
    ----------
    number : the digits as written.
    unit : the unit as written.
    """

    number: str
    unit: str
    span: Span


Amount: TypeAlias = Quantity | Name


@dataclass(frozen=True, slots=True)
class Reference(Node):
    """A name that stands for motions."""

    name: Name
    span: Span


@dataclass(frozen=True, slots=True)
class Argument(Node):
    """One of the things in the parentheses after a name."""

    name: Name | None
    value: Motion | Quantity
    span: Span


@dataclass(frozen=True, slots=True)
class Call(Node):
    """`NAME ( ... )`: a definition with arguments, or a graph with a group."""

    name: Name
    arguments: tuple[Argument, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Qualified(Node):
    """`Upper-Body TALK`."""

    graph: Name
    motion: Reference | Call
    span: Span


@dataclass(frozen=True, slots=True)
class Group(Node):
    """A motion expression in parentheses."""

    motion: Motion
    span: Span


@dataclass(frozen=True, slots=True)
class Not(Node):
    """All motions but these."""

    operand: Motion
    span: Span


@dataclass(frozen=True, slots=True)
class And(Node):
    """Two or more operands joined by `and`."""

    operands: tuple[Motion, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Or(Node):
    """Two or more operands joined by `or`."""

    operands: tuple[Motion, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class With(Node):
    """Two or more operands joined by `with`, each below the first."""

    operands: tuple[Motion, ...]
    span: Span


Motion: TypeAlias = Reference | Call | Qualified | Group | Not | And | Or | With


@dataclass(frozen=True, slots=True)
class Command(Node):
    """A motion expression, and for how long."""

    motion: Motion
    duration: Amount | None
    once: Span | None
    span: Span


@dataclass(frozen=True, slots=True)
class Wait(Node):
    """Stay in what is playing."""

    duration: Amount
    span: Span


@dataclass(frozen=True, slots=True)
class End(Node):
    """Give a body part back to its parent."""

    graph: Name
    span: Span


@dataclass(frozen=True, slots=True)
class Parameter(Node):
    """A name that a definition leaves open."""

    name: Name
    default: Motion | Quantity | None
    span: Span


@dataclass(frozen=True, slots=True)
class Let(Node):
    """A definition. `parameters` is None where there are no parentheses.

    `mended` says that its text has a mistake, which has been reported, so that it may not say what was meant.
    """

    name: Name
    parameters: tuple[Parameter, ...] | None
    command: Command
    span: Span
    mended: bool = False


@dataclass(frozen=True, slots=True)
class Use(Node):
    """The definitions of another file."""

    path: Name
    span: Span


@dataclass(frozen=True, slots=True)
class RepeatHead(Node):
    """`repeat 3`, without its body. `count` is as written."""

    count: str
    span: Span


@dataclass(frozen=True, slots=True)
class Repeat(Node):
    """A body that is played several times."""

    head: RepeatHead
    body: tuple[Item, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class ChooseHead(Node):
    """`choose`, without its branches."""

    span: Span


@dataclass(frozen=True, slots=True)
class Weight(Node):
    """How often a branch is drawn, against the others. `number` is as written."""

    number: str
    span: Span


@dataclass(frozen=True, slots=True)
class Branch(Node):
    """One of the things that `choose` draws from."""

    weight: Weight | None
    body: tuple[Item, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Choose(Node):
    """One branch is drawn and played."""

    head: ChooseHead
    branches: tuple[Branch, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Broken(Node):
    """A statement that could not be read; its mistake has been reported."""

    span: Span


@dataclass(frozen=True, slots=True)
class BrokenDefinition(Broken):
    """A `let` or `use` that could not be read.

    Attributes
    ----------
    names : those that it may have been meant to define; none where these may be any.
    """

    names: tuple[str, ...]


Statement: TypeAlias = Command | Wait | End | Let | Use
Line: TypeAlias = Statement | RepeatHead | ChooseHead | Weight
Item: TypeAlias = Statement | Repeat | Choose | Broken


@dataclass(frozen=True, slots=True)
class Script(Node):
    """A whole text."""

    items: tuple[Item, ...]
    span: Span


_HOLDING: Final = (
    *(Reference, Argument, Call, Qualified, Group, Not, And, Or, With),
    *(Command, Wait, End, Parameter, Let, Use, Repeat, Branch, Choose, Script),
)
"""The kinds of node that are made of other nodes."""
_PLAIN: Final = ("Span", "Span | None", "bool")
_PARTS: Final[Mapping[type[Node], Sequence[str]]] = {
    kind: tuple(one.name for one in fields(kind) if one.type not in _PLAIN) for kind in _HOLDING
}
"""By kind of node, the fields that hold nodes, or tuples of nodes, in the order of the text."""


def children(node: Node) -> list[Node]:
    """Return the nodes that a node is made of, in the order of the text."""
    found: list[Node] = []
    for field in _PARTS.get(type(node), ()):
        part = getattr(node, field)
        if type(part) is tuple:
            found += part
        elif part is not None:
            found.append(part)
    return found


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all that is in it, outermost first, in the order of the text."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        yield node
        if type(node) in _PARTS:
            waiting += reversed(children(node))


def commands(items: Iterable[Item]) -> Iterator[Command]:
    """Yield the commands of items, those in blocks too, in the order of the text; those of definitions are left out."""
    for item in items:
        match item:
            case Command():
                yield item
            case Repeat(body=body):
                yield from commands(body)
            case Choose(branches=branches):
                yield from (command for branch in branches for command in commands(branch.body))
