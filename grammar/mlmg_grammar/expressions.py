"""What a rule of the grammar is made of, as values."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Symbol:
    """The name of a rule or a terminal."""

    name: str

    @property
    def is_terminal(self) -> bool:
        """Return whether it is a terminal: those are written in capitals."""
        return self.name.lstrip("_").isupper()


@dataclass(frozen=True, slots=True)
class Text:
    """Words or signs that stand for themselves."""

    text: str


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regular expression."""

    regexp: str


@dataclass(frozen=True, slots=True)
class Sequence:
    """One part after the other."""

    parts: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several."""

    options: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Optional:
    """Something, or nothing."""

    part: Expression


@dataclass(frozen=True, slots=True)
class Repeat:
    """Something once or several times, with a separator between if there is one."""

    part: Expression
    separator: Expression | None = None


Expression: TypeAlias = Symbol | Text | Pattern | Sequence | Choice | Optional | Repeat


def sequence(parts: tuple[Expression, ...]) -> Expression:
    """Return parts one after the other; one part alone is itself."""
    return parts[0] if len(parts) == 1 else Sequence(parts)


def choice(options: tuple[Expression, ...]) -> Expression:
    """Return one of several; one alone is itself."""
    return options[0] if len(options) == 1 else Choice(options)


def children(expression: Expression) -> tuple[Expression, ...]:
    """Return what an expression is made of."""
    match expression:
        case Sequence(parts):
            return parts
        case Choice(options):
            return options
        case Optional(part) | Repeat(part, None):
            return (part,)
        case Repeat(part, separator) if separator is not None:
            return (part, separator)
    return ()


def walk(expression: Expression) -> Iterator[Expression]:
    """Yield an expression and all that is in it, outermost first."""
    yield expression
    for child in children(expression):
        yield from walk(child)


def rewritten(expression: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return an expression with everything in it changed, the innermost first."""
    match expression:
        case Sequence(parts):
            expression = Sequence(tuple(rewritten(part, change) for part in parts))
        case Choice(options):
            expression = Choice(tuple(rewritten(option, change) for option in options))
        case Optional(part):
            expression = Optional(rewritten(part, change))
        case Repeat(part, separator):
            between = None if separator is None else rewritten(separator, change)
            expression = Repeat(rewritten(part, change), between)
    return change(expression)
