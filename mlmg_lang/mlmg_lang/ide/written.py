"""Syntax nodes with what is defined put in -> the text that says the same, on one line."""

from __future__ import annotations

from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import group_of


def written(node: syntax.Command | syntax.Motion | syntax.Amount) -> str:
    """Return how a command, an expression or a duration is written, without needless parentheses around names."""
    match node:
        case syntax.Command(motion, duration, once):
            text = written(motion) + (" once" if once is not None else f" for {written(duration)}" if duration else "")
        case syntax.Quantity(number, unit):
            text = f"{number} {unit}"
        case syntax.Name(name, quoted):
            plain = script_name(name)
            text = f'"{name}"' if quoted and plain == name else plain
        case syntax.Reference(name) | syntax.Group(syntax.Reference(name)):
            text = written(name)
        case syntax.Group(syntax.Group() as inner):
            text = written(inner)
        case syntax.Group(inner):
            text = f"({written(inner)})"
        case syntax.Not(operand):
            text = f"not {written(operand)}"
        case syntax.Qualified(graph, motion):
            text = f"{written(graph)} {written(motion)}"
        case syntax.Call(name, arguments):
            space = "" if group_of(node) is None else " "
            text = f"{written(name)}{space}({', '.join(map(_argument, arguments))})"
        case _:
            joiner = {syntax.And: " and ", syntax.Or: " or ", syntax.With: " with "}[type(node)]
            text = joiner.join(map(written, node.operands))
    return text


def _argument(argument: syntax.Argument) -> str:
    return written(argument.value) if argument.name is None else f"{written(argument.name)} = {written(argument.value)}"
