"""The script of a session plays exactly what the session did."""

from collections.abc import Callable

import pytest

import mlmg_lang
from mlmg_lang.perform import rehearse
from mlmg_lang.session.saving import SavedScript, script_from_session
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library

Says = Callable[..., Session]


def script_of(session: Session) -> SavedScript:
    """Return the script, which has been compiled afresh and plays what the session played."""
    script = script_from_session(session)
    assert script is not None
    plan, _ = mlmg_lang.compile(script.text, session.library, session.starts_in)
    assert plan is not None
    assert rehearse(plan, session.library, session.seed).timeline == session.stage.finish()
    return script


def test_what_was_entered_is_saved_as_it_was_entered(says: Says) -> None:
    script = script_of(says("let A = WALK", "A for 2 sec  # so", "WALK with Upper-Body TALK for 1 sec", "IDLE"))
    assert script.as_entered
    assert script.text.splitlines()[1] == "A for 2 sec  # so"


@pytest.fixture
def narrowed(demo_library: Library) -> Session:
    """Return a session whose script, as it was entered, would be an error: in it, every branch has to go on so."""
    seed = 3
    while True:
        session = Session(demo_library, seed=seed)
        session.enter("choose { Idle_02 for 1 sec | Idle_01 for 1 sec }")
        if session.stage.performer.motion("Full-Body") == "Idle_01":
            session.enter("Upper-Body TALK for 2 sec")
            return session
        seed += 1


def test_what_a_script_would_read_otherwise_is_saved_with_the_motions_that_were_taken(narrowed: Session) -> None:
    script = script_of(narrowed)
    assert not script.as_entered
    assert script.text == "Full-Body Idle_01 for 1 sec\nUpper-Body Talk_01 for 2 sec\n"


def test_all_kinds_of_statements_can_be_written_with_the_motions_that_were_taken(narrowed: Session) -> None:
    said = ("end Upper-Body", "Music_01 once", "wait 0.5 cycles", "wait 1.5 sec", "Talk_01 for 20 frames", "Idle_01")
    for line in said:
        assert narrowed.enter(line).n_seconds
    script = script_of(narrowed)
    assert not script.as_entered
    written = script.text.splitlines()[2:]
    assert written[:4] == ["end Upper-Body", "Full-Body Music_01 once", "wait 0.5 cycles", "wait 1.5 sec"]
    assert [line.split()[1] for line in written[4:]] == ["Talk_01", "Idle_01"]


def test_draws_are_those_of_the_session(demo_library: Library) -> None:
    for seed in range(6):
        session = Session(demo_library, seed=seed)
        for _ in range(3):
            session.enter("choose { Walk_01 for 1 sec | Walk_02 for 1 sec | Idle_01 for 1 sec }")
        assert script_of(session).as_entered


def test_nothing_played_is_no_script(session: Session, says: Says) -> None:
    assert script_from_session(session) is None
    says("let A = WALK")
    assert script_from_session(session) is None


def test_the_last_motion_is_played_to_its_end_only_in_what_is_saved(says: Says) -> None:
    session = says("WALK")
    seconds = session.n_seconds
    script = script_of(session)
    assert rehearse(script.plan, session.library).timeline.n_frames > seconds * 30
    assert session.n_seconds == seconds
