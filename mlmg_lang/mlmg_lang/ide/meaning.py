"""A use of a definition in a statement -> the motions that it stands for there, on each of its graphs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeAlias

from mlmg_lang.analysis import Analysis
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.ide.sayings import understood
from mlmg_lang.ide.substitution import substituted
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.planning import typed
from mlmg_lang.planning.select import select

_Use: TypeAlias = syntax.Reference | syntax.Call


def motions_of_use(analysis: Analysis, items: Iterable[syntax.Item], use: _Use) -> Mapping[str, tuple[str, ...]]:
    """Return the motions that a definition stands for in one use of it, by graph in the order of the text.

    Nothing where the command that uses it is not understood, as in a definition that takes something.

    Parameters
    ----------
    items : with addresses; the use is in one of them.
    """
    commands = (item.command if isinstance(item, syntax.Let) else item for item in items)
    for command in commands:
        if isinstance(command, syntax.Command) and any(node is use for node in syntax.walk(command)):
            return _in_command(analysis, command, use)
    return {}


def _in_command(analysis: Analysis, command: syntax.Command, use: _Use) -> Mapping[str, tuple[str, ...]]:
    says, names = understood(analysis, command), analysis.question.names
    if says.expanded is None or says.way is None or names is None:
        return {}
    if command.motion is use:
        return {layer.graph: layer.motions for layer in says.way.layers}
    # What comes of this use is known by where it is, though another use may put in the same text.
    apart = 1 + max(node.span.end for node in syntax.walk(says.expanded))
    nodes = syntax.walk(says.expanded)
    own = next((node for node in nodes if isinstance(node, syntax.Group) and node.span == use.span), None)
    if own is None:  # It is given to a definition that does not use it.
        return {}
    motion = substituted(says.expanded.motion, own, moved(own, by(apart)))
    ways = select(motion, names, analysis.made.addressed, explains=False)
    assert not isinstance(ways, Diagnostic), "it is understood where it stands"
    found: dict[str, set[str]] = {}
    taken = [(layer.graph, layer.motions) for layer in says.way.layers]
    way = next(way for way in ways if [(layer.graph, layer.motions) for layer in way.layers] == taken)
    for choice in (one for layer in way.layers for one in _from(layer.choice, apart)):
        # An `and` in an `and` is one with it, so that there may be several.
        found.setdefault(choice.graph, set(choice.motions)).intersection_update(choice.motions)
    return {graph: names.in_order(graph, motions) for graph, motions in found.items()}


def _from(choice: typed.Choice, address: int) -> Iterator[typed.Choice]:
    """Yield the outermost choices from an address on."""
    if choice.span.start >= address:
        yield choice
        return
    match choice:
        case typed.AllBut(operand=operand):
            yield from _from(operand, address)
        case typed.Both(operands=operands) | typed.Either(operands=operands):
            for one in operands:
                yield from _from(one, address)
