"""The prompt in a real terminal: keys typed into tmux, the screen read from it."""

import os
import secrets
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from mlmg_runtime.library import Library

PATIENCE_S = 60.0


@dataclass(frozen=True)
class Terminal:
    """A terminal with the prompt in it."""

    socket: str

    def tmux(self, *arguments: str) -> str:
        return subprocess.run(
            ["tmux", "-L", self.socket, *arguments], capture_output=True, text=True, check=True
        ).stdout

    def type(self, text: str) -> None:
        self.tmux("send-keys", "-t", "s", "-l", text)

    def press(self, *names: str) -> None:
        self.tmux("send-keys", "-t", "s", *names)

    def screen(self) -> str:
        return self.tmux("capture-pane", "-p", "-t", "s")

    def waits_for(self, *texts: str) -> str:
        """Return the screen as soon as it shows all of some texts."""
        deadline = time.monotonic() + PATIENCE_S
        while not all(text in (screen := self.screen()) for text in texts):
            assert time.monotonic() < deadline, f"{texts} is not on the screen:\n{screen}"
            time.sleep(0.05)
        return screen


@pytest.fixture
def terminal(demo_library: Library, tmp_path: Path) -> Iterator[Callable[..., Terminal]]:
    """Return a function that starts the prompt in a terminal of some size."""
    if shutil.which("tmux") is None:
        pytest.skip("tmux is not installed")
    opened: list[Terminal] = []

    def start(columns: int = 80, rows: int = 24) -> Terminal:
        made = Terminal(f"mlmg-test-{secrets.token_hex(6)}")
        opened.append(made)
        environment = [
            f"MLMG_HISTORY={tmp_path / 'history'}",
            f"PYTHONPATH={os.pathsep.join(sys.path)}",
            "LC_ALL=C.UTF-8",
        ]
        repl = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "repl", str(demo_library.path)]
        made.tmux(
            *("-u", "-f", os.devnull, "new-session", "-d", "-s", "s", "-x", str(columns), "-y", str(rows)),
            *("-c", str(tmp_path), "env", *environment, *repl),
        )
        made.waits_for("Motion Script>>>" if columns >= 40 else ">>>")
        return made

    yield start
    for one in opened:
        subprocess.run(["tmux", "-L", one.socket, "kill-server"], capture_output=True, check=False)


def test_a_command_typed_at_80_columns_is_played_and_the_toolbar_follows(terminal: Callable[..., Terminal]) -> None:
    at = terminal()
    at.type("WALK with Upper-Body TALK for 2 sec")
    at.press("Enter")
    screen = at.waits_for("s of motion", "unsaved")
    assert "Upper-Body  Talk_01 after" in screen
    assert max(map(len, screen.splitlines())) <= 80


def test_the_menu_opens_while_typing_and_tab_takes_from_it(terminal: Callable[..., Terminal]) -> None:
    at = terminal()
    at.type("WALK with Upper-Body T")
    at.waits_for("2 motions, 22 s")
    at.press("Tab")
    at.waits_for("Upper-Body TALK")
    at.press("Enter")
    at.press("Enter")
    at.waits_for("s of motion")


def test_wide_characters_stand_where_they_belong(terminal: Callable[..., Terminal]) -> None:
    at = terminal()
    at.type("走路 for 3 sec; 😀")
    at.press("Enter")
    screen = at.waits_for("error[MS021]")
    drawn = screen.splitlines()
    line = next(n for n, text in enumerate(drawn) if " 1 | 走路" in text)
    assert drawn[line + 1].rstrip().endswith("^^^^")


def test_a_terminal_of_30_columns_is_wide_enough(terminal: Callable[..., Terminal]) -> None:
    at = terminal(30, 20)
    at.type("WALK for 1 sec")
    at.press("Enter")
    screen = at.waits_for("s of motion", "unsaved")
    assert max(map(len, screen.splitlines())) <= 30


@pytest.mark.parametrize("columns", [80, 40])
def test_replies_are_broken_at_words(columns: int, terminal: Callable[..., Terminal]) -> None:
    at = terminal(columns, 90)
    at.type(".help")
    at.press("Enter")
    screen = at.waits_for("leave\n", ".quit")
    assert max(map(len, screen.splitlines())) <= columns
    said = " ".join(screen.split())
    assert "write the motion, or the script that plays it again" in said
    assert "take the last entry back, or the last N" in said
    assert "`.help` tells what there is, Ctrl-D leaves." in said


def test_the_terminal_may_be_resized_while_typing(terminal: Callable[..., Terminal]) -> None:
    at = terminal(80, 24)
    at.type("WALK with Upper-Body TALK for 2 sec")
    at.tmux("resize-window", "-t", "s", "-x", "40", "-y", "18")
    at.press("Enter")
    at.waits_for("s of motion")
    at.tmux("resize-window", "-t", "s", "-x", "100", "-y", "30")
    at.type("IDLE")
    at.press("Enter")
    at.waits_for("goes with the body again")


def test_ctrl_c_stops_a_long_command_and_all_is_as_before(terminal: Callable[..., Terminal]) -> None:
    at = terminal()
    at.type("WALK for 1 sec")
    at.press("Enter")
    seconds = next(line for line in at.waits_for("s of motion").splitlines() if "of motion" in line).split()[0]
    at.type("repeat 40000 { WALK with Upper-Body TALK for 1 sec; IDLE }")
    at.press("Enter")
    # A key that comes while the prompt still reads is one of the next line.
    deadline = time.monotonic() + PATIENCE_S
    while "stopped; all is as it was before" not in at.screen():
        assert time.monotonic() < deadline
        at.press("C-c")
        time.sleep(0.1)
    at.waits_for(f"{seconds} s  unsaved")


def test_ctrl_d_leaves_at_once_if_nothing_has_been_played(terminal: Callable[..., Terminal]) -> None:
    at = terminal()
    pane = int(at.tmux("display-message", "-p", "-t", "s", "#{pane_pid}"))
    at.press("C-d")
    deadline = time.monotonic() + PATIENCE_S
    while _lives(pane):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def _lives(process: int) -> bool:
    try:
        os.kill(process, signal.SIG_DFL)
    except ProcessLookupError:
        return False
    return True
