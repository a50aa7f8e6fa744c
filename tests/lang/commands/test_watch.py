"""mlmgc --watch: a script is played again whenever a file changes that it is made from."""

from __future__ import annotations

import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from mlmg_lang.commands import mlmgc
from mlmg_lang.commands.watching import Inputs, NotedFiles, Stamp, changed
from mlmg_lang.script_files import used_files
from mlmg_runtime import bvh

PATIENCE_S = 120
"""How long a line may take on a busy machine before a test fails; nothing waits so long that passes."""

STATUS = re.compile(r"\d\d:\d\d:\d\d ")
SCRIPT = 'use "more.ms"\nStand for 1 sec\nGO for 1 sec\n'
BEFORE, AFTER = Stamp(1, 20, 300), Stamp(2, 20, 300)
SCRIPT_FILE, OTHER_FILE = Path("/a/s.ms"), Path("/a/t.ms")


class Watching:
    """The command as a person has it: a process that says things, line by line."""

    def __init__(self, *arguments: str) -> None:
        command = [sys.executable, "-m", "mlmg_lang.commands.mlmgc", "scene.ms", "-o", "out.bvh", "--watch"]
        self.process = subprocess.Popen([*command, *arguments], stderr=subprocess.PIPE, encoding="utf-8")
        self._lines: queue.Queue[str] = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        for line in self.process.stderr:
            self._lines.put(line.rstrip("\n"))

    def run(self) -> list[str]:
        """Return what is said up to the end of a run."""
        lines = [self._lines.get(timeout=PATIENCE_S)]
        while not STATUS.match(lines[-1]):
            lines.append(self._lines.get(timeout=PATIENCE_S))
        return lines

    def leave(self) -> int:
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(PATIENCE_S)

    def rest(self) -> str:
        self._reader.join(PATIENCE_S)
        return "\n".join(self._lines.get(timeout=PATIENCE_S) for _ in range(self._lines.qsize()))


@pytest.fixture
def watching(built):
    (built / "scene.ms").write_text(SCRIPT, encoding="utf-8")
    (built / "more.ms").write_text("let GO = Step\n", encoding="utf-8")
    (built / "mlmg.toml").write_text('library = "my.mlmg"\n', encoding="utf-8")
    started = []

    def start(*arguments: str) -> Watching:
        started.append(Watching(*arguments))
        return started[-1]

    yield start
    for one in started:
        one.process.kill()
        one.process.wait()
        one.process.stderr.close()


def save(name: str, text: str) -> None:
    """Save as many editors do; no half of it is ever seen."""
    Path(f"{name}.new").write_text(text, encoding="utf-8")
    os.replace(f"{name}.new", name)


def n_frames() -> int:
    return len(bvh.read("out.bvh").frames)


def test_a_script_is_played_at_once_and_again_at_every_save(watching):
    command = watching()
    first = command.run()
    assert first[0] == "mlmgc: watching scene.ms; Ctrl-C leaves"
    for seconds in (2, 10):
        save("scene.ms", f"Stand for {seconds} sec\n")
        status = command.run()
        assert len(status) == 1, "one line a run"
        assert status[0][9:] == f"out.bvh: {n_frames()} frames, {seconds}.0 s, 0.0 s of them on the way between motions"
        assert n_frames() == 30 * seconds


def other_definitions() -> None:
    Path("more.ms").write_text("let GO = Reach with Upper-Body SWING\n")


def other_library() -> None:
    assert shutil.copyfile("my.mlmg", "copy.mlmg")
    os.replace("copy.mlmg", "my.mlmg")


def library_written_over() -> None:
    data = Path("my.mlmg").read_bytes()
    Path("my.mlmg").write_bytes(data)


def other_settings() -> None:
    shutil.copyfile("my.mlmg", "another.mlmg")
    Path("mlmg.toml").write_text('library = "another.mlmg"\n')


def saved_in_place() -> None:
    Path("scene.ms").write_text("Stand for 3 sec\n")


def saved_beside_and_renamed() -> None:
    save("scene.ms", "Stand for 3 sec\n")


def moved_away_and_written_anew() -> None:
    os.replace("scene.ms", "scene.ms~")
    Path("scene.ms").write_text("Stand for 3 sec\n")


@pytest.mark.parametrize(
    "save",
    [
        other_definitions,
        other_library,
        library_written_over,
        other_settings,
        saved_in_place,
        saved_beside_and_renamed,
        moved_away_and_written_anew,
    ],
)
def test_whatever_a_run_is_made_from_is_watched(watching, save):
    command = watching()
    command.run()
    Path("out.bvh").unlink()
    save()
    while not Path("out.bvh").exists():
        assert STATUS.match(command.run()[-1])
    assert command.leave() == 130


def test_settings_that_are_not_there_yet_are_watched(watching):
    Path("mlmg.toml").rename("later.toml")
    command = watching("--library", "my.mlmg")
    command.run()
    Path("later.toml").rename("mlmg.toml")
    assert "out.bvh: " in command.run()[-1]


def test_a_mistake_is_drawn_and_the_last_good_output_stays(watching):
    command = watching()
    command.run()
    good = Path("out.bvh").read_bytes()
    save("scene.ms", "WLAK for 2 sec\n")
    said = command.run()
    assert "^^^^" in "\n".join(said)
    assert said[-1][9:] == "scene.ms: not played; out.bvh stays as it was"
    assert Path("out.bvh").read_bytes() == good
    save("scene.ms", "WALK for 2 sec\n")
    assert "out.bvh: " in command.run()[-1]


def test_a_used_file_that_is_made_later_mends_the_script(watching):
    Path("more.ms").rename("later.ms")
    command = watching()
    assert "MS058" in command.run()[1]
    Path("later.ms").rename("more.ms")
    assert "out.bvh: " in command.run()[-1]


@pytest.mark.parametrize("name", ["scene.ms", "my.mlmg"])
def test_a_file_that_goes_and_comes_back_is_waited_for(watching, name):
    command = watching()
    command.run()
    os.replace(name, "away")
    assert f"{name}: No such file or directory" in command.run()[0]
    os.replace("away", name)
    assert "out.bvh: " in command.run()[-1]


def test_a_library_that_is_none_is_told_and_another_one_is_waited_for(watching):
    Path("my.mlmg").rename("good.mlmg")
    Path("my.mlmg").write_text("not a library")
    command = watching()
    assert "my.mlmg: " in command.run()[1]
    os.replace("good.mlmg", "my.mlmg")
    assert "out.bvh: " in command.run()[-1]


def test_ctrl_c_leaves_without_a_traceback(watching):
    command = watching()
    command.run()
    assert command.leave() == 130
    assert command.rest() == "mlmgc: interrupted"


def test_a_script_that_was_never_there_is_not_waited_for(watching):
    Path("scene.ms").unlink()
    command = watching()
    assert command.process.wait(PATIENCE_S) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-", "-o", "out.bvh"], "--watch needs a file to be saved; the script is -"),
        ([os.devnull, "-o", "out.bvh"], f"--watch needs a file to be saved; the script is {os.devnull}"),
        (["scene.ms", "-o", "-"], "--watch writes again and again, which -o - cannot show; name a file"),
        (
            ["scene.ms", "-o", "out.bvh", "--report", "-"],
            "--watch writes again and again, which --report - cannot show; name a file",
        ),
    ],
)
def test_what_cannot_be_watched_is_wrong_usage(tmp_path, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(tmp_path)
    assert mlmgc.main([*arguments, "--watch"]) == 2
    assert capsys.readouterr().err == f"mlmgc: error: {message}\n"


def test_a_used_file_is_not_written_over(watching, capsys):
    before = Path("more.ms").read_bytes()
    assert mlmgc.main(["scene.ms", "-o", "out.bvh", "--report", "more.ms"]) == 2
    assert "more.ms: this file is read" in capsys.readouterr().err
    assert Path("more.ms").read_bytes() == before


@pytest.mark.parametrize(
    ("before", "now", "which"),
    [
        (BEFORE, BEFORE, ()),
        (BEFORE, Stamp(2, 20, 300), (SCRIPT_FILE,)),
        (BEFORE, Stamp(1, 21, 300), (SCRIPT_FILE,)),
        (BEFORE, Stamp(1, 20, 301), (SCRIPT_FILE,)),
        (BEFORE, None, (SCRIPT_FILE,)),
        (None, BEFORE, (SCRIPT_FILE,)),
        (None, None, ()),
    ],
    ids=["nothing", "time", "size", "another file", "gone", "there now", "still not there"],
)
def test_a_file_has_changed_if_it_was_written_made_replaced_or_taken_away(before, now, which):
    assert changed({SCRIPT_FILE: before, OTHER_FILE: AFTER}, {SCRIPT_FILE: now, OTHER_FILE: AFTER}) == which


def test_a_save_after_a_file_was_noted_is_a_change_though_it_is_noted_again(tmp_path):
    (tmp_path / "s.ms").write_text("WALK")
    inputs = Inputs()
    first = inputs.note(tmp_path / "s.ms")
    (tmp_path / "s.ms").write_text("WALK for 1 sec")
    assert inputs.note(tmp_path / "s.ms") == first
    inputs.wait_for_change()


def test_files_that_a_script_uses_are_noted_before_they_are_read_also_those_that_are_not_there(tmp_path):
    (tmp_path / "s.ms").write_text('use "there.ms"')
    (tmp_path / "there.ms").write_text("let GO = WALK")
    inputs = Inputs()
    files = NotedFiles(used_files(tmp_path / "s.ms"), inputs)
    for name in ("there.ms", "missing.ms", "bad\0name.ms"):
        files.find(name, str(tmp_path / "s.ms"))
    assert [state is not None for state in inputs.stamps.values()] == [True, False, False]
    assert list(inputs.stamps)[:2] == [tmp_path / "there.ms", tmp_path / "missing.ms"]


def test_a_library_stays_open_until_its_file_changes(built):
    libraries = mlmgc.Libraries()
    library = libraries.open(built / "my.mlmg", Inputs())
    assert libraries.open(built / "my.mlmg", Inputs()) is library
    other_library()
    assert libraries.open(built / "my.mlmg", Inputs()) is not library
