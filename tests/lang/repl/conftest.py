"""Conversations on the demo library, without a terminal."""

from collections.abc import Callable
from pathlib import Path

import pytest

from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Reply
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library


@pytest.fixture
def shown() -> list[tuple[Path, Path]]:
    """Return the motions and reports that the player has been asked to show."""
    return []


@pytest.fixture
def conversation(demo_library: Library, shown: list[tuple[Path, Path]]) -> Conversation:
    """Return a conversation in which nothing has been said."""

    def show(motion: Path, report: Path) -> str:
        shown.append((motion, report))
        return "shown"

    return Conversation(Desk(Session(demo_library), show))


@pytest.fixture
def say(conversation: Conversation) -> Callable[..., Reply]:
    """Return a function that says lines, and returns the reply to the last."""

    def lines(*said: str) -> Reply:
        reply = Reply()
        for line in said:
            reply = conversation.say(line)
        return reply

    return lines
