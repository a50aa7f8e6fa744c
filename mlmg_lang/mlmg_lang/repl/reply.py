"""What is said in reply to a line: text for a person, data for a program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any


class Refusal(Exception):
    """A line that cannot be done as it was said; the message tells why, and what to say instead."""


@dataclass(frozen=True, slots=True)
class Question:
    """What a person at a terminal is asked before a line is done.

    Attributes
    ----------
    asked : in a sentence. line : says that it be done. left : what is told if the answer is no.
    """

    asked: str
    line: str
    left: str


@dataclass(frozen=True, slots=True)
class Reply:
    """A reply.

    Attributes
    ----------
    text : lines, each with its end; nothing where there is nothing to say.
    data : the same for a program; what is in it is written in docs/repl.md.
    ok : False if what was asked has not been done.
    leaves : whether this ends the conversation.
    question : what a face with a person before it asks in place of the text, which tells others what to say instead.
    """

    text: str = ""
    data: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    ok: bool = True
    leaves: bool = False
    question: Question | None = None
