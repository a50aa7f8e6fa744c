"""A conversation, without a terminal: each line is an entry of a script or a command with a dot, and has one reply."""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

from mlmg_lang.rendering.wording import safe
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands import dotted, find_dot_command
from mlmg_lang.repl.reply import Refusal, Reply
from mlmg_lang.repl.telling import telling_of
from mlmg_runtime.errors import MlmgError


@dataclass(frozen=True, slots=True)
class Conversation:
    """Lines in, replies out."""

    desk: Desk

    def say(self, line: str) -> Reply:
        """Do what a line asks for, and reply. What is interrupted or impossible leaves all as it was."""
        began = perf_counter()
        try:
            reply = self._reply(line)
        except (Refusal, MlmgError) as refusal:
            reply = _refused(str(refusal))
        except OSError as error:
            name = f"{error.filename}: " if error.filename else ""
            reply = _refused(f"{name}{error.strerror or error}")
        return self._timed(reply, perf_counter() - began)

    def _reply(self, line: str) -> Reply:
        meant = dotted(line, self.desk.session)
        if meant is not None:
            raise Refusal(f"write `{meant}`: commands that play nothing begin with a dot")
        if not is_dotted(line):
            return telling_of(self.desk).reply(self.desk.session.enter(line))
        word, _, argument = line.strip()[1:].partition(" ")
        return find_dot_command(word).say(self.desk, argument.strip())

    def _timed(self, reply: Reply, seconds: float) -> Reply:
        if not self.desk.settings.time:
            return reply
        told = f"{reply.text}  took {seconds:.3f} s\n"
        return replace(reply, text=told, data={**reply.data, "took": round(seconds, 6)})


def is_dotted(line: str) -> bool:
    """Return whether a line is a command with a dot, not an entry of a script."""
    return line.lstrip().startswith(".")


def _refused(message: str) -> Reply:
    return Reply(f"error: {safe(message)}\n", {"problem": message}, ok=False)
