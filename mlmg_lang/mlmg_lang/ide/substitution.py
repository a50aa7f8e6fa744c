"""A motion expression and a part of it -> the same with something else in the place of that."""

from __future__ import annotations

from dataclasses import replace

from mlmg_lang.parsing import syntax


def substituted(motion: syntax.Motion, part: syntax.Motion, other: syntax.Motion) -> syntax.Motion:
    """Return an expression with another in the place of a part, which is found by what it is, not by what it says.

    What is named with a graph, without parentheses, stays: `TALK` of `Upper-Body TALK`.
    """
    if motion is part:
        return other
    match motion:
        case syntax.Group(inner):
            return replace(motion, motion=substituted(inner, part, other))
        case syntax.Not(operand):
            return replace(motion, operand=substituted(operand, part, other))
        case syntax.And(operands) | syntax.Or(operands) | syntax.With(operands):
            return replace(motion, operands=tuple(substituted(one, part, other) for one in operands))
        case syntax.Call(_, arguments):
            return replace(motion, arguments=tuple(_argument(one, part, other) for one in arguments))
    return motion


def _argument(argument: syntax.Argument, part: syntax.Motion, other: syntax.Motion) -> syntax.Argument:
    value = argument.value
    if isinstance(value, syntax.Quantity):
        return argument
    return replace(argument, value=substituted(value, part, other))
