"""All rules by which expressions are found, in the order in which they are tried; the first that finds one wins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.finding.layered import layered
from mlmg_lang.planning.finding.nowhere import nowhere
from mlmg_lang.planning.finding.search import Search, Ways
from mlmg_lang.planning.finding.shared import shared
from mlmg_lang.planning.finding.whole import whole
from mlmg_lang.planning.nothing import Room


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: a pure function of an expression and the room that its command leaves it; None leaves it to the next."""

    name: str
    find: Callable[[syntax.Motion, Room, Search], Ways | Diagnostic | None]


RULES = (
    Rule("layered", layered),
    Rule("whole", whole),
    Rule("shared", shared),
    Rule("nowhere", nowhere),
)
