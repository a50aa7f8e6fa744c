"""A session -> the same entries played anew: in another library, from another start, with other draws."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.diagnostics import has_errors
from mlmg_lang.session.answer import Answer
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library


@dataclass(frozen=True, slots=True)
class Replayed:
    """A session that has been played anew, and the entries that could not be, with what is wrong with each."""

    session: Session
    lost: tuple[Answer, ...]


def replay(session: Session, library: Library, start: str | None, seed: int) -> Replayed:
    """Return a new session with the same entries; the given one stays as it is.

    Raises
    ------
    ValueError
        If the library has no such start motion.
    """
    fresh = Session(library, start, seed, session.files)
    answers = [fresh.enter(turn.text, turn.name) for turn in session.turns]
    lost = [one for one in answers if one.problem is not None or has_errors(one.diagnostics)]
    return Replayed(fresh, tuple(lost))
