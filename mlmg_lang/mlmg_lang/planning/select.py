"""A motion expression -> the graphs it is on and the motions it stands for there, by the rules of `finding`.

Every name in the expression is known to mean something (`binding`).
"""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.nowhere import nowhere
from mlmg_lang.planning.finding.search import Search, Ways
from mlmg_lang.planning.finding.table import RULES
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.source import Source


def select(motion: syntax.Motion, names: Names, source: Source, *, explains: bool = True) -> Ways | Diagnostic:
    """Return the assignments that an expression allows, the best first, or why there is none.

    Parameters
    ----------
    explains : whether that is worked out, which may take far longer than to see that there is none.
    """
    rules = (_unexplained if rule.find is nowhere and not explains else rule.find for rule in RULES)
    return Search(names, source, tuple(rules)).find(motion, Room())


def _unexplained(motion: syntax.Motion, _room: Room, _search: Search) -> Diagnostic:
    """Say no more than that no rule has found anything."""
    return Diagnostic("MS032", "nothing is this", motion.span)
