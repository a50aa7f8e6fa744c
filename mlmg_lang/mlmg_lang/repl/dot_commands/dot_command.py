"""What a command with a dot is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Refusal, Reply


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
    TIMES = "[N]"
    SETTING = "[OPTION VALUE]"
    SWITCH = "[on|off]"


def path_of(argument: str) -> Path:
    """Return the path that an argument names, with or without quotes around it; `~` is the user's folder.

    Raises
    ------
    Refusal
        If no file can be called that.
    """
    quoted = len(argument) > 1 and argument[0] == argument[-1] and argument[0] in "\"'"
    written = argument[1:-1] if quoted else argument
    try:
        path = Path(written).expanduser()
    except RuntimeError:
        raise Refusal(f"`{written}`: there is no such user") from None
    if "\0" in written:
        raise Refusal(f"`{written}` cannot be the path of a file")
    return path


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

    def say(self, desk: Desk, argument: str) -> Reply:
        """Do it, with what stands after it.

        Raises
        ------
        Refusal
            If it cannot be done, or if something stands after it that it does not take.
        """
        if argument and self.takes is Takes.NOTHING:
            raise Refusal(f"`{self.usage}` takes no words after it, found `{argument}`")
        return self.run(desk, argument)
