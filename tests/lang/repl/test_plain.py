"""Without a terminal: lines in, plain lines or JSON out."""

import io
import json
import subprocess
import sys
from pathlib import Path

import pytest

from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.plain import PlainFace, entries


def test_an_entry_is_a_line_but_several_where_something_is_open() -> None:
    lines = ["WALK", "", "repeat 2 {", "  WALK", "}", ".save a(.bvh", "WALK with (", "TALK)", "IDLE"]
    assert list(entries(lines)) == [
        "WALK",
        "repeat 2 {\n  WALK\n}",
        ".save a(.bvh",
        "WALK with (\nTALK)",
        "IDLE",
    ]


def test_what_is_still_open_at_the_end_is_an_entry_too() -> None:
    assert list(entries(["repeat 2 {\n", "WALK\n"])) == ["repeat 2 {\nWALK"]


def test_replies_are_plain_lines_and_leaving_ends(conversation: Conversation) -> None:
    out = io.StringIO()
    assert PlainFace(conversation, out).run(["WALK for 1 sec", ".quit", "TALK"])
    assert "Walk_" in out.getvalue()
    assert "\x1b" not in out.getvalue()
    assert len(conversation.desk.session.turns) == 1


def test_json_is_a_line_for_each_entry(conversation: Conversation) -> None:
    out = io.StringIO()
    assert not PlainFace(conversation, out, as_json=True).run(["WALK", "WLAK", ".state"])
    replies = [json.loads(line) for line in out.getvalue().splitlines()]
    assert [(reply["entry"], reply["ok"]) for reply in replies] == [("WALK", True), ("WLAK", False), (".state", True)]


@pytest.fixture
def repl(demo_library: object, tmp_path: Path) -> object:
    """Return a function that runs `mlmg repl` as a process of its own."""

    def run(*arguments: str, stdin: str = "") -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "repl", str(demo_library.path), *arguments]  # type: ignore[attr-defined]
        return subprocess.run(command, input=stdin, capture_output=True, text=True, cwd=tmp_path, check=False)

    return run


def test_lines_can_be_given_as_options(repl: object, tmp_path: Path) -> None:
    ran = repl("-c", "WALK for 3 sec", "-c", ".save a.bvh")  # type: ignore[operator]
    assert (ran.returncode, ran.stderr) == (0, "")
    assert "a.bvh: " in ran.stdout
    assert (tmp_path / "a.bvh").is_file()


def test_a_script_on_standard_input_is_played_line_by_line(repl: object) -> None:
    ran = repl(stdin="WALK for 1 sec\n# so\nrepeat 2 {\nIDLE\n}\n")  # type: ignore[operator]
    assert ran.returncode == 0
    assert ran.stdout.count("s of motion") == 2


def test_a_mistake_is_told_and_the_exit_code_says_so(repl: object) -> None:
    ran = repl(stdin="WLAK\nWALK\n")  # type: ignore[operator]
    assert ran.returncode == 1
    assert "MS021" in ran.stdout
    assert "s of motion" in ran.stdout


def test_a_start_that_is_none_is_wrong_usage(repl: object) -> None:
    ran = repl("--start", "Nobody")  # type: ignore[operator]
    assert ran.returncode == 2
    assert "no motion `Nobody`" in ran.stderr


def test_json_goes_through_a_pipe(repl: object) -> None:
    ran = repl("--json", stdin="WALK\n.state\n")  # type: ignore[operator]
    assert [json.loads(line)["ok"] for line in ran.stdout.splitlines()] == [True, True]
