"""A session plays each entry on from where the character is, and can go back to any moment before."""

import random
from collections.abc import Callable

import pytest

import mlmg_lang
from mlmg_lang.perform import perform
from mlmg_lang.session.saving import script_from_session
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library
from mlmg_runtime.playing.performer import Performer

Says = Callable[..., Session]


def test_a_command_is_played_on_from_the_present_state(says: Says) -> None:
    session = says("WALK for 3 sec")
    before = session.n_seconds
    says("WALK with Upper-Body TALK for 2 sec")
    assert session.turns[1].deeds[0].went.begin_s == pytest.approx(before, abs=1e-3)
    assert {one.graph for one in session.playing} == {"Full-Body", "Upper-Body"}


def test_an_answer_says_how_much_motion_there_is_by_now(session: Session) -> None:
    seconds = [session.enter(line).n_seconds for line in ("Idle_01 for 1 sec", "Idle_01 for 2 sec")]
    assert seconds == [1.0, 3.0]


def test_what_is_said_of_scripts_that_are_finished_is_not_said_of_entries(session: Session) -> None:
    assert session.enter("let A = WALK").diagnostics == ()
    assert session.enter("WALK; IDLE").diagnostics == ()


def test_the_first_command_that_names_a_root_motion_sets_the_start(says: Says) -> None:
    assert says("Talk_01 for 1 sec").starts_in == "Talk_01"
    assert says("Walk_01 for 1 sec").starts_in == "Talk_01"


def test_a_definition_before_the_first_command_leaves_the_start_open(says: Says) -> None:
    assert says("let A = WALK", "Talk_01").starts_in == "Talk_01"


def test_a_command_that_waits_before_the_first_motion_waits_in_the_library_s_start(says: Says) -> None:
    session = says("wait 1 sec", "Talk_01")
    assert session.starts_in == session.library.start


def test_a_start_that_is_given_is_kept(demo_library: Library) -> None:
    session = Session(demo_library, start="walk01")
    session.enter("Talk_01")
    assert session.starts_in == "Walk_01"


def test_a_start_that_is_no_motion_is_refused(demo_library: Library) -> None:
    with pytest.raises(ValueError, match=r"no motion `Wlak` on `Full-Body`"):
        Session(demo_library, start="Wlak")


def test_an_entry_with_a_mistake_leaves_all_as_it_was(says: Says) -> None:
    session = says("WALK for 3 sec")
    turns, seconds = session.turns, session.n_seconds
    answer = session.enter("WLAK for 3 sec")
    assert [one.code for one in answer.diagnostics] == ["MS021"]
    assert answer.n_seconds is None
    assert (session.turns, session.n_seconds) == (turns, seconds)


def test_a_later_line_is_refused_where_a_script_would_have_narrowed_the_earlier_one(says: Says) -> None:
    session = says("Idle_02")
    answer = session.enter("Upper-Body TALK")
    assert [one.code for one in answer.diagnostics] == ["MS040"]
    assert [note.message for note in answer.diagnostics[0].notes] == ["it plays `Idle_02` now"]


@pytest.mark.parametrize("line", ["with Upper-Body TALK", "and TALK", "for 3 sec", "# so\nwith TALK", "once"])
def test_a_line_that_would_go_on_with_a_played_command_says_so(line: str, says: Says) -> None:
    session = says("WALK")
    (told,) = session.enter(line).diagnostics
    assert "the one before has been played" in told.message
    assert told.help is not None
    assert "WALK" in told.help


def test_definitions_are_known_in_later_entries_and_nothing_is_said_of_them_there(says: Says) -> None:
    session = says("let GREET(x) = x with Upper-Body WAVE_HAND", "let WALK2 = WALK")
    answer = session.enter("GREET(IDLE) for 1 sec")
    assert answer.diagnostics == ()
    assert answer.deeds[0].text == "GREET(IDLE) for 1 sec"


def test_a_name_is_defined_once_in_an_entry(says: Says) -> None:
    answer = says("IDLE for 1 sec").enter("let A = WALK\nlet A = IDLE")
    assert [one.code for one in answer.diagnostics] == ["MS050"]


def test_a_definition_takes_the_place_of_an_earlier_one_also_in_those_that_use_it(says: Says) -> None:
    session = says("let A = WALK", "let B = A", "let A = Talk_02")
    assert session.enter("let A = Talk_01").diagnostics == ()
    session.enter("B for 1 sec")
    assert session.stage.performer.motion("Full-Body") == "Talk_01"
    session.undo()
    session.undo()
    session.enter("B for 1 sec")
    assert session.stage.performer.motion("Full-Body") == "Talk_02"


def test_what_no_longer_fits_a_definition_is_told_of_when_it_is_used(says: Says) -> None:
    session = says("let A(x) = x", "let B = A(WALK)", "let A(x, y) = x with Upper-Body y")
    answer = session.enter("B for 1 sec")
    (told,) = answer.diagnostics
    assert answer.source.slice(told.span) == "A(WALK)"
    assert session.enter("A(WALK, TALK) for 1 sec").diagnostics == ()


def test_cycles_of_wait_are_those_of_the_command_in_an_earlier_entry(says: Says, demo_library: Library) -> None:
    session = says("WALK with Upper-Body TALK for 1 sec", "wait 1 cycles")
    motion = session.stage.performer.motion("Full-Body")
    assert session.turns[1].deeds[0].went.lasted_s == pytest.approx(demo_library.n_frames(motion) / 30, abs=1e-3)


def test_choose_draws_on_where_the_entry_before_stopped(demo_library: Library) -> None:
    line, n = "choose { Walk_01 for 1 sec | Walk_02 for 1 sec | IDLE for 1 sec }", 12
    apart, at_once = Session(demo_library, seed=5), Session(demo_library, seed=5)
    for _ in range(n):
        apart.enter(line)
    at_once.enter(f"repeat {n} {{ {line} }}")
    assert len({turn.deeds[0].text for turn in apart.turns}) == 3
    assert [turn.deeds[0].text for turn in apart.turns] == [deed.text for deed in at_once.turns[0].deeds]


def test_undo_gives_back_exactly_what_was_and_redo_what_came_of_it(says: Says) -> None:
    session = says("WALK for 2 sec", "choose { TALK | IDLE | Music }")
    after = (session.turns, session.playing, session.n_seconds)
    draws = session.stage.draws.getstate()
    says("choose { TALK | IDLE | Music }")
    session.undo()
    assert (session.turns, session.playing, session.n_seconds) == after
    assert session.stage.draws.getstate() == draws
    session.redo()
    assert len(session.turns) == 3


def test_undo_of_nothing_is_nothing(session: Session) -> None:
    assert session.undo() is None
    assert session.redo() is None


def test_an_entry_after_undo_drops_what_was_taken_back(says: Says) -> None:
    session = says("WALK", "IDLE")
    session.undo()
    says("TALK")
    assert session.redo() is None
    assert [turn.text for turn in session.turns] == ["WALK", "TALK"]


def test_an_interrupted_entry_leaves_all_as_it_was(says: Says, monkeypatch: pytest.MonkeyPatch) -> None:
    session = says("WALK for 2 sec")
    before = (session.turns, session.playing, session.n_seconds)
    n_calls = 0
    hold = Performer.hold

    def interrupted(self: Performer, n_frames: int) -> None:
        nonlocal n_calls
        n_calls += 1
        hold(self, n_frames)
        if n_calls == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(Performer, "hold", interrupted)
    with pytest.raises(KeyboardInterrupt):
        session.enter("repeat 3 { TALK for 1 sec; IDLE for 1 sec }")
    assert (session.turns, session.playing, session.n_seconds) == before


COMMANDS = (
    *("WALK for 1 sec", "WALK with Upper-Body TALK for 1 sec", "IDLE", "TALK and IDLE", "WALK and TALK for 10 frames"),
    *("SWING_HAND", "Upper-Body TALK for 0.5 sec", "Left-Hand WAVE", "WALK with Left-Hand WAVE for 1 sec", "Idle_02"),
    *("Music once", "not WALK", "wait 0.5 sec", "wait 0.2 cycles", "end Upper-Body", "end Left-Hand", "Talk_01 once"),
    *("repeat 2 { WALK for 1 sec; IDLE }", "choose { 3: WALK | IDLE | Upper-Body TALK }", "WLAK", "with Sub TALK", "("),
    *("Walk_01 with Upper-Body Talk_01 with Left-Hand Wave_01 for 1 sec", "(TALK or IDLE) for 1 sec", "let A = WALK"),
)


def test_hundreds_of_random_commands_with_undo_and_redo_are_the_same_as_their_script_played_at_once(
    demo_library: Library,
) -> None:
    draw = random.Random(4)
    session = Session(demo_library, seed=9)
    for _ in range(400):
        kind = draw.random()
        if kind < 0.15:
            session.undo()
        elif kind < 0.25:
            session.redo()
        else:
            session.enter(draw.choice(COMMANDS))
    script = script_from_session(session)
    assert script is not None
    assert len(session.turns) > 120
    plan, _ = mlmg_lang.compile(script.text, demo_library, session.starts_in)
    assert plan is not None
    played = perform(plan, demo_library, session.seed)
    finished = session.stage.finish()
    assert played.report["n_frames"] == finished.n_frames
    assert perform(script.plan, demo_library, session.seed).report["tracks"] == played.report["tracks"]
