"""What a command with a dot is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Reply


class Takes(StrEnum):
    """What stands after a command, which is what completion offers there."""

    NOTHING = ""
    DOT_COMMAND = "[COMMAND]"
    GRAPH = "[GRAPH]"
    MOTION = "MOTION"
    STATEMENT = "COMMAND"
    OUTPUT = "FILE.bvh|FILE.ms"
    SCRIPT = "FILE.ms"
    LIBRARY = "[FILE.mlmg]"
    NUMBER = "N"
    SETTING = "[OPTION VALUE]"
    SWITCH = "[on|off]"


@dataclass(frozen=True, slots=True)
class DotCommand:
    """A command with a dot.

    Attributes
    ----------
    name : without the dot. says : what it does, in a few words. more : what else there is to know, with examples.
    run : takes what stands after it, without white space around.
    """

    name: str
    takes: Takes
    says: str
    more: str
    run: Callable[[Desk, str], Reply]

    @property
    def usage(self) -> str:
        """Return how it is written."""
        return f".{self.name} {self.takes.value}".rstrip()
