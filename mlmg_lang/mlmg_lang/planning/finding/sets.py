"""An expression and one graph -> the motions of the graph that it stands for there."""

from __future__ import annotations

from collections.abc import Iterator

from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.structure import group_of, without_groups
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.typed import AllBut, Both, Choice, Either, Named


def motions_on(graph: str, motion: syntax.Motion, names: Names, fixed: bool) -> Choice:
    """Return the motions of a graph that an expression stands for.

    Parameters
    ----------
    fixed : whether a graph's name in the whole expression says that it is on this one.
    """
    match motion:
        case syntax.Reference(name):
            return _named(graph, name, names, fixed)
        case syntax.Qualified(_, inner) | syntax.Group(inner):
            return motions_on(graph, inner, names, fixed)
        case syntax.Call():
            inside = group_of(motion)
            assert inside is not None, "binding lets no other call through"
            return motions_on(graph, inside, names, fixed)
        case syntax.And():
            operands = tuple(motions_on(graph, operand, names, fixed) for operand in flattened(motion))
            kept = set.intersection(*(set(operand.motions) for operand in operands))
            return Both(graph, names.in_order(graph, kept), operands, motion.span)
        case syntax.Or(parts):
            operands = tuple(motions_on(graph, operand, names, fixed) for operand in parts)
            kept = set().union(*(operand.motions for operand in operands))
            return Either(graph, names.in_order(graph, kept), operands, motion.span)
        case syntax.Not(part):
            operand = motions_on(graph, part, names, fixed)
            kept = set(names.motions(graph)) - set(operand.motions)
            return AllBut(graph, names.in_order(graph, kept), operand, motion.span)
        case syntax.With():
            raise AssertionError("structure lets no layers into a set")


def flattened(motion: syntax.Motion) -> Iterator[syntax.Motion]:
    """Yield the operands of an `and`, those of an `and` among them too."""
    bare = without_groups(motion)
    if isinstance(bare, syntax.And):
        for operand in bare.operands:
            yield from flattened(operand)
    else:
        yield bare


def _named(graph: str, name: syntax.Name, names: Names, fixed: bool) -> Named:
    find = names.find if fixed else names.find_unqualified
    match = find(graph, name.text)
    if match is None:
        return Named(graph, (), name.text, Kind.TAG, name.text, name.span)
    entry = match.entry
    return Named(graph, entry.motions, entry.name, entry.kind, name.text, name.span)
