"""Rules of the grammar -> extended Backus-Naur form: `[ ]` may be left out, `{ }` comes any number of times."""

from __future__ import annotations

from mlmg_grammar.definitions import Definition
from mlmg_grammar.expressions import Choice, Expression, Optional, Pattern, Repeat, Sequence, Symbol, Text


def ebnf(definition: Definition, width: int = 0) -> str:
    """Return a rule as a line of text, its name filled up to a width."""
    return f"{definition.name.ljust(width)} = {_written(definition.expression)}"


def _written(expression: Expression) -> str:
    match expression:
        case Symbol(name):
            text = name.lstrip("_")
        case Text(word):
            text = f'"{word}"'
        case Pattern(regexp):
            text = f"/{regexp}/"
        case Sequence(parts):
            text = " ".join(map(_inside, parts))
        case Choice(options):
            text = " | ".join(map(_written, options))
        case Optional(Repeat(part, None)):
            text = f"{{ {_written(part)} }}"
        case Optional(part):
            text = f"[ {_written(part)} ]"
        case Repeat(part, separator):
            between = "" if separator is None else f"{_inside(separator)} "
            text = f"{_inside(part)} {{ {between}{_inside(part)} }}"
    return text


def _inside(expression: Expression) -> str:
    """Return a part of a sequence: a choice in parentheses."""
    text = _written(expression)
    return f"( {text} )" if isinstance(expression, Choice) else text
