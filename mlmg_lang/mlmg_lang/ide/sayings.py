"""A command of a script -> what it says with what is defined put in, its type, and what may be playing before it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.definitions.expand import Expander
from mlmg_lang.ide.statements import Statement
from mlmg_lang.parsing import syntax
from mlmg_lang.planning import resolved, typed
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.plan import Planner
from mlmg_lang.source import Span


@dataclass(frozen=True, slots=True)
class Understood:
    """What a command says.

    Attributes
    ----------
    expanded : with what is defined put in; None where that fails.
    way : the one of its types that it is played by, the best where that is not known; None if it has none, or without
        a library.
    """

    expanded: syntax.Command | None
    way: typed.Layering | None


def understood(analysis: Analysis, command: syntax.Command) -> Understood:
    """Return what a command says that could stand in a script.

    Parameters
    ----------
    command : with addresses, as in `Statement`.
    """
    definitions, question = analysis.made.gathered.definitions, analysis.question
    items = Expander(definitions).body((command,))
    expanded = items[0]
    if not isinstance(expanded, syntax.Command):
        return Understood(None, None)
    if question.names is None or question.catalog is None:
        return Understood(expanded, None)
    planner = Planner(definitions, question.names, question.catalog.frame_rate, analysis.made.addressed)
    (statement,) = planner.body((expanded,))
    return Understood(expanded, _taken(analysis, statement) if isinstance(statement, typed.Command) else None)


def _taken(analysis: Analysis, command: typed.Command) -> typed.Layering:
    """Return the type that a command is played by; the best where that is not known."""
    best, *others = command.ways
    if not others:
        return best
    same = (one for one in resolved.commands(_played(analysis, command.span)) if one.span == command.span)
    layers = () if (played := next(same, None)) is None else played.layers
    wanted = {one.graph: {*one.candidates, *(out.motion for out in one.left_out)} for one in layers}
    fitting = (way for way in others if {one.graph: set(one.motions) for one in way.layers} == wanted)
    return next(fitting, best)


def _played(analysis: Analysis, command: Span) -> Sequence[resolved.Statement]:
    """Return what is played by all of a script in which a command is, or by its piece alone."""
    made = analysis.made
    if made.resolution is not None:
        return made.resolution.plan.statements
    number = made.places.starts.last_to(made.now(command).start)
    return made.played[number].statements if number < len(made.played) else ()


def state_before(analysis: Analysis, statement: Statement) -> State | None:
    """Return what may be playing before a statement of a script; None if that is not known."""
    made, span = analysis.made, statement.item.span
    if made.resolution is not None:
        return made.resolution.states.get(span)
    number = made.places.starts.last_to(statement.at(span).start)
    return made.played[number].states.get(span) if number < len(made.played) else None
