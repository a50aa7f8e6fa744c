"""The script of a session plays exactly what the session did."""

from collections.abc import Callable

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


def test_what_a_script_would_read_otherwise_is_saved_with_the_motions_that_were_taken(demo_library: Library) -> None:
    session = Session(demo_library, seed=3)
    # In a script every branch has to allow what comes after it; here only the one that was drawn.
    while not session.turns:
        session.enter("choose { Idle_02 for 1 sec | Idle_01 for 1 sec }")
        if session.stage.performer.motion("Full-Body") == "Idle_02":
            session.undo()
            session = Session(demo_library, seed=session.seed + 1)
    session.enter("Upper-Body TALK for 2 sec")
    script = script_of(session)
    assert not script.as_entered
    assert script.text == "Full-Body Idle_01 for 1 sec\nUpper-Body Talk_01 for 2 sec\n"


def test_all_kinds_of_statements_can_be_written_with_the_motions_that_were_taken(demo_library: Library) -> None:
    session = Session(demo_library)
    for line in (
        "choose { Idle_02 for 1 sec | Idle_01 for 1 sec }",
        "Music_01 once",
        "wait 0.5 cycles",
        "IDLE with Upper-Body TALK for 20 frames",
        "end Upper-Body",
        "Upper-Body TALK",
        "wait 1.5 sec",
    ):
        session.enter(line)
    script_of(session)


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
