"""Lines as other programs have them, without a dot -> the command with a dot that is meant."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from mlmg_lang.repl.dot_commands.dot_command import Takes
from mlmg_lang.repl.dot_commands.table import DOT_COMMANDS
from mlmg_lang.session.session import Session

_ELSEWHERE: Final[Mapping[str, str]] = MappingProxyType(
    {"?": "help", "h": "help", "man": "help", "q": "quit", "exit": "quit", "bye": "quit", "logout": "quit"}
)
_LINE: Final = re.compile(r"\s*[:/\\]?(\?|[a-z]+!?)(?:\s+(?P<rest>[^\s;(].*)|\s*\(\s*\)|)\s*;?\s*", re.IGNORECASE)
_GOES_ON: Final = re.compile(r"(with|and|or|for|once)\b", re.IGNORECASE)
"""What follows a motion: the word before is meant for one."""


def dotted(line: str, session: Session) -> str | None:
    """Return how a line is written as a command with a dot; None if none is meant, or its word means something."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    word, rest = match[1].lower(), match["rest"] or ""
    found = next((one for one in DOT_COMMANDS if one.name == _ELSEWHERE.get(word, word)), None)
    if found is None or (rest and (found.takes is Takes.NOTHING or _GOES_ON.match(rest))):
        return None
    if word != "?" and not any(one.code == "MS021" for one in session.analyse(match[1]).diagnostics):
        return None
    return f".{found.name} {rest}".rstrip()
