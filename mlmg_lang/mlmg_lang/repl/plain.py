"""The plain face: lines from a program, a file or the command line; replies as plain lines, or as JSON, one a line."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TextIO

from mlmg_lang.ide.cursor import is_open
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.repl.conversation import Conversation, is_dotted
from mlmg_lang.source import Source


@dataclass(frozen=True, slots=True)
class PlainFace:
    """Says lines to a conversation and writes the replies.

    Attributes
    ----------
    as_json : whether each reply is one line of JSON.
    """

    conversation: Conversation
    out: TextIO
    as_json: bool = False

    def run(self, lines: Iterable[str]) -> bool:
        """Say all entries until one leaves; return whether all of them could be done."""
        all_done = True
        for entry in entries(lines):
            reply = self.conversation.say(entry)
            all_done = all_done and reply.ok
            if self.as_json:
                data = {"entry": entry, "ok": reply.ok, **reply.data}
                self.out.write(json.dumps(data, ensure_ascii=False) + "\n")
            else:
                self.out.write(reply.text)
            self.out.flush()
            if reply.leaves:
                break
        return all_done


def entries(lines: Iterable[str]) -> Iterator[str]:
    """Yield entries: a line each, but several where braces or parentheses are open; empty lines are left out."""
    waiting = ""
    for line in lines:
        waiting += line if line.endswith("\n") else f"{line}\n"
        if (is_dotted(waiting) or not is_open(tokenize(Source(waiting)))) and waiting.strip():
            yield waiting.rstrip("\n")
        elif waiting.strip():
            continue
        waiting = ""
    if waiting.strip():
        yield waiting.rstrip("\n")
