"""All rules, in the order in which they are applied. A candidate that one has left out is none for those after it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from mlmg_lang.planning.rules.attempt import Attempt
from mlmg_lang.planning.rules.dead_end import dead_end
from mlmg_lang.planning.rules.forbidden import forbidden
from mlmg_lang.planning.rules.later_command import later_command
from mlmg_lang.planning.rules.outranked import outranked
from mlmg_lang.planning.rules.rule_1 import rule_1
from mlmg_lang.planning.rules.ruling import Ruling
from mlmg_lang.planning.rules.unreachable import unreachable
from mlmg_lang.planning.rules.way_on import way_on


class Order(Enum):
    """In which order a rule is asked of the layers of a command; neighbours in the table are asked together."""

    DOWNWARDS = "from the highest to the lowest"
    UPWARDS = "from the lowest to the highest, until that leaves out no more"
    LAST = "from the highest to the lowest, for this command alone: those after it go by what was left before"


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: a pure function of a command where it stands, and of one of its graphs.

    Attributes
    ----------
    name : as it is told of a candidate that it has left out.
    """

    name: str
    order: Order
    judge: Callable[[Attempt, str], Ruling]


RULES = (
    Rule("later command", Order.DOWNWARDS, later_command),
    Rule("rule 1", Order.UPWARDS, rule_1),
    Rule("dead end", Order.UPWARDS, dead_end),
    Rule("way on", Order.DOWNWARDS, way_on),
    Rule("forbidden", Order.DOWNWARDS, forbidden),
    Rule("unreachable", Order.DOWNWARDS, unreachable),
    Rule("outranked", Order.LAST, outranked),
)
