"""A motion expression -> the graphs it is on and the motions it stands for there, by the rules of `finding`.

Every name in the expression is known to mean something (`binding`).
"""

from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.search import Search, Ways
from mlmg_lang.planning.finding.table import RULES
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.nothing import Room
from mlmg_lang.source import Source


def select(motion: syntax.Motion, names: Names, source: Source) -> Ways | Diagnostic:
    """Return the assignments that an expression allows, the best first, or why there is none."""
    return Search(names, source, tuple(rule.find for rule in RULES)).find(motion, Room())
