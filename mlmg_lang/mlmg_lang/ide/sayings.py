"""A command of a script -> what it says with what is defined put in, its type, and what may be playing before it."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.definitions.expand import Expander
from mlmg_lang.ide.statements import Statement
from mlmg_lang.parsing import syntax
from mlmg_lang.planning import typed
from mlmg_lang.planning.flow import State
from mlmg_lang.planning.plan import Planner


@dataclass(frozen=True, slots=True)
class Understood:
    """What a command says.

    Attributes
    ----------
    expanded : with what is defined put in; None where that fails.
    way : the best of its types; None if it has none, or without a library.
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
    return Understood(expanded, statement.ways[0] if isinstance(statement, typed.Command) else None)


def state_before(analysis: Analysis, statement: Statement) -> State | None:
    """Return what may be playing before a statement of a script; None if that is not known."""
    made, span = analysis.made, statement.item.span
    if made.resolution is not None:
        return made.resolution.states.get(span)
    number = made.places.starts.last_to(statement.at(span).start)
    return made.played[number].states.get(span) if number < len(made.played) else None
