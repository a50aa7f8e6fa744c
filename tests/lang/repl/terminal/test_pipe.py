"""Whole sessions at the prompt, with keys from a pipe and a terminal that shows nothing."""

import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from prompt_toolkit.application import create_app_session
from prompt_toolkit.input import PipeInput, create_pipe_input
from prompt_toolkit.output import DummyOutput

from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.terminal.completing import ScriptCompleter
from mlmg_lang.repl.terminal.terminal import TerminalFace
from mlmg_runtime.library import Library

ENTER, CTRL_C, CTRL_D, CTRL_R, ESCAPE, UP = "\r", "\x03", "\x04", "\x12", "\x1b", "\x1b[A"


@pytest.fixture(autouse=True)
def _history_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_HISTORY", str(tmp_path / "history"))


@contextmanager
def keys(text: str) -> Iterator[PipeInput]:
    with create_pipe_input() as pipe, create_app_session(input=pipe, output=DummyOutput()):
        pipe.send_text(text)
        yield pipe


@pytest.fixture
def typed(conversation: Conversation) -> Callable[[str], list[str]]:
    """Return a function: keys -> the entries that have been played after them."""

    def run(text: str) -> list[str]:
        with keys(text) as pipe:
            TerminalFace(conversation, pipe, DummyOutput()).run()
        return [turn.text for turn in conversation.desk.session.turns]

    return run


def test_enter_plays_and_ctrl_d_leaves(typed: Callable[[str], list[str]]) -> None:
    assert typed(f"WALK for 1 sec{ENTER}IDLE{ENTER}{CTRL_D}y{ENTER}") == ["WALK for 1 sec", "IDLE"]


def test_leaving_asks_nothing_if_all_is_saved(typed: Callable[[str], list[str]], tmp_path: Path) -> None:
    assert typed(CTRL_D) == []
    assert typed(f"WALK{ENTER}.save {tmp_path / 'a.bvh'}{ENTER}{CTRL_D}") == ["WALK"]


def test_leaving_with_something_unsaved_asks_and_stays_if_the_answer_is_no(
    typed: Callable[[str], list[str]],
) -> None:
    assert typed(f"WALK{ENTER}{CTRL_D}n{ENTER}IDLE{ENTER}{CTRL_D}y{ENTER}") == ["WALK", "IDLE"]
    assert typed(f".quit{ENTER}{ENTER}TALK{ENTER}.quit{ENTER}yes{ENTER}")[-1] == "TALK"


def test_ctrl_c_at_the_question_stays(typed: Callable[[str], list[str]]) -> None:
    assert typed(f"WALK{ENTER}{CTRL_D}{CTRL_C}IDLE{ENTER}{CTRL_D}{CTRL_D}") == ["WALK", "IDLE"]


def test_a_file_that_was_there_before_is_asked_about(typed: Callable[[str], list[str]], tmp_path: Path) -> None:
    mine = tmp_path / "mine.ms"
    mine.write_text("# by hand\n", encoding="utf-8")
    for answer in (f"n{ENTER}", ENTER, CTRL_D, CTRL_C):
        typed(f"WALK{ENTER}.save {mine}{ENTER}{answer}.quit{ENTER}y{ENTER}")
        assert mine.read_text(encoding="utf-8") == "# by hand\n"
    typed(f".save {mine}{ENTER}y{ENTER}.quit{ENTER}")
    assert mine.read_text(encoding="utf-8").startswith("# mlmgc mine.ms ")


def test_what_was_entered_is_searched_without_regard_to_case(typed: Callable[[str], list[str]]) -> None:
    typed(f"WALK for 1 sec{ENTER}IDLE{ENTER}.quit{ENTER}y{ENTER}")
    assert typed(f"{CTRL_R}walk{ENTER}{ENTER}.quit{ENTER}y{ENTER}")[-1] == "WALK for 1 sec"


def test_an_open_block_goes_on_in_another_line(typed: Callable[[str], list[str]]) -> None:
    assert typed(f"repeat 2 {{{ENTER}WALK for 1 sec{ENTER}}}{ENTER}{CTRL_D}y{ENTER}") == [
        "repeat 2 {\nWALK for 1 sec\n}"
    ]


def test_ctrl_c_drops_what_was_typed(typed: Callable[[str], list[str]]) -> None:
    assert typed(f"WALK for{CTRL_C}IDLE{ENTER}{CTRL_D}y{ENTER}") == ["IDLE"]


def test_ctrl_c_stops_a_command_and_the_next_goes_on_from_before_it(
    typed: Callable[[str], list[str]], conversation: Conversation, monkeypatch: pytest.MonkeyPatch
) -> None:
    enter = type(conversation.desk.session).enter

    def interrupted(self: object, text: str) -> object:
        if text == "TALK":
            raise KeyboardInterrupt
        return enter(self, text)  # type: ignore[arg-type]

    monkeypatch.setattr(type(conversation.desk.session), "enter", interrupted)
    assert typed(f"WALK{ENTER}TALK{ENTER}IDLE{ENTER}{CTRL_D}y{ENTER}") == ["WALK", "IDLE"]


def test_what_was_entered_is_found_again_in_the_next_session(
    typed: Callable[[str], list[str]], conversation: Conversation
) -> None:
    typed(f"WALK for 1 sec{ENTER}{CTRL_D}y{ENTER}")
    assert typed(f"{UP}{ENTER}{CTRL_D}y{ENTER}") == ["WALK for 1 sec", "WALK for 1 sec"]


def test_another_library_has_its_own_history(
    typed: Callable[[str], list[str]], demo_library: Library, tmp_path: Path
) -> None:
    shutil.copy(demo_library.path, tmp_path / "my.mlmg")
    typed(f"WALK for 1 sec{ENTER}.library {tmp_path / 'my.mlmg'}{ENTER}IDLE{ENTER}{CTRL_D}y{ENTER}")
    kept = {path.name.partition("-")[0]: path.read_text() for path in (tmp_path / "history").iterdir()}
    assert "+WALK" in kept["demo.txt"]
    assert "+IDLE" not in kept["demo.txt"]
    assert "+IDLE" in kept["my"]
    assert "+WALK" not in kept["my"]


def test_what_is_entered_counts_as_used_at_once(
    typed: Callable[[str], list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Counter[str]] = []
    made = ScriptCompleter.__init__

    def remembered(self: ScriptCompleter, desk: Desk, uses: Counter[str]) -> None:
        seen.append(uses)
        made(self, desk, uses)

    monkeypatch.setattr(ScriptCompleter, "__init__", remembered)
    typed(f"WALK for 1 sec{ENTER}WALK{ENTER}{CTRL_D}y{ENTER}")
    assert seen[0]["WALK"] == 2


def test_vi_keys_can_be_set(typed: Callable[[str], list[str]]) -> None:
    assert typed(f".set keys vi{ENTER}WALX{ESCAPE}rK{ENTER}{CTRL_D}y{ENTER}") == ["WALK"]


def test_a_history_that_cannot_be_kept_is_no_hindrance(
    typed: Callable[[str], list[str]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("MLMG_HISTORY", str(tmp_path / "file" / "history"))
    assert typed(f"WALK{ENTER}{CTRL_D}y{ENTER}") == ["WALK"]
