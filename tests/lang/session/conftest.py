"""Sessions on the demo library."""

from collections.abc import Callable

import pytest

from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library


@pytest.fixture
def session(demo_library: Library) -> Session:
    """Return a session in which nothing has been said."""
    return Session(demo_library)


@pytest.fixture
def says(session: Session) -> Callable[..., Session]:
    """Return a function that enters lines, all of which can be played, and returns the session."""

    def enter(*lines: str) -> Session:
        for line in lines:
            answer = session.enter(line)
            assert answer.n_seconds is not None, (line, answer.problem, [one.message for one in answer.diagnostics])
        return session

    return enter
