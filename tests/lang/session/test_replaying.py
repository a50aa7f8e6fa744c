"""The entries of a session can be played anew: with other draws, from another start, in another library."""

from collections.abc import Callable
from pathlib import Path

import pytest

from mlmg_lang.script_files import used_files
from mlmg_lang.session.replaying import replay
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library

Says = Callable[..., Session]


def test_the_same_library_start_and_seed_give_the_same(says: Says, demo_library: Library) -> None:
    session = says("WALK for 2 sec", "choose { TALK | IDLE }", "IDLE")
    again = replay(session, demo_library, None, 0)
    assert again.lost == ()
    assert again.session.stage.finish() == session.stage.finish()


def test_another_start_and_seed_are_taken(says: Says, demo_library: Library) -> None:
    session = says("IDLE for 1 sec", "WALK for 2 sec")
    again = replay(session, demo_library, "Talk_01", 7).session
    assert (again.starts_in, again.seed) == ("Talk_01", 7)
    assert session.starts_in == "Idle_01"


def test_an_entry_that_cannot_be_played_is_told_and_left_out(
    says: Says, demo_library: Library, reference_library: Library
) -> None:
    session = says("WALK for 1 sec", "Left-Hand WAVE", "IDLE")
    again = replay(session, reference_library, None, 0)
    assert [one.source.text for one in again.lost] == ["Left-Hand WAVE"]
    assert [turn.text for turn in again.session.turns] == ["WALK for 1 sec", "IDLE"]


def test_files_that_a_script_used_are_found_again(demo_library: Library, tmp_path: Path) -> None:
    (tmp_path / "lib.ms").write_text("let A = WALK\n", encoding="utf-8")
    name = str(tmp_path / "a.ms")
    session = Session(demo_library, files=used_files(name))
    assert session.enter('use "lib.ms"\nA for 1 sec', name).n_seconds
    again = replay(session, demo_library, None, 0)
    assert again.lost == ()
    assert again.session.turns[0].name == name


def test_a_start_that_the_library_does_not_have_is_refused(says: Says, demo_library: Library) -> None:
    with pytest.raises(ValueError, match="Nobody"):
        replay(says("WALK"), demo_library, "Nobody", 0)
