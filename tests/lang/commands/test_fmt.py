"""`mlmg fmt` as a user calls it."""

from __future__ import annotations

import io
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mlmg_lang.commands import mlmg

FORMATTED = "WALK\nIDLE for 10 sec\n"
WRITTEN = "WALK;IDLE for 10s\n"
WRONG = "WALK  FOR 10 SEC;IDLE\n"
Told = pytest.CaptureFixture[str]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with four scripts, and stand in it; no library is at hand."""
    monkeypatch.delenv("MLMG_LIBRARY", raising=False)
    monkeypatch.chdir(tmp_path)
    for name, text in [("a.ms", WRITTEN), ("b.ms", FORMATTED), ("c.ms", WRONG), ("sub/d.ms", WRITTEN)]:
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Callable[[bytes], None]:
    """Return a function that puts bytes on standard input."""

    def put(data: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    return put


def contents(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text(encoding="utf-8") for path in folder.rglob("*.ms")}


# --- rewriting -------------------------------------------------------------------------------------------


def test_scripts_are_rewritten_and_counted(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "a.ms", "b.ms"]) == 0
    assert Path("a.ms").read_text(encoding="utf-8") == FORMATTED
    assert capsys.readouterr() == ("", "1 script rewritten, 1 script left as it is\n")


def test_a_script_in_the_form_is_not_touched(here: Path) -> None:
    os.utime("b.ms", ns=(0, 0))
    before = os.stat("b.ms")
    assert mlmg.main(["fmt", "b.ms"]) == 0
    after = os.stat("b.ms")
    assert (after.st_mtime_ns, after.st_ino) == (0, before.st_ino)


def test_line_ends_and_a_byte_order_mark_are_reason_enough(here: Path) -> None:
    Path("a.ms").write_bytes(b"\xef\xbb\xbfWALK\n")
    Path("b.ms").write_bytes(b"WALK\r\n")
    assert mlmg.main(["fmt", "a.ms", "b.ms"]) == 0
    assert [Path(name).read_bytes() for name in ("a.ms", "b.ms")] == [b"WALK\n", b"WALK\n"]


def test_permissions_and_links_are_kept(here: Path) -> None:
    Path("a.ms").chmod(0o640)
    Path("link.ms").symlink_to("a.ms")
    assert mlmg.main(["fmt", "link.ms"]) == 0
    assert Path("link.ms").is_symlink()
    assert stat.S_IMODE(os.stat("a.ms").st_mode) == 0o640
    assert Path("a.ms").read_text(encoding="utf-8") == FORMATTED


def test_a_statement_with_a_mistake_is_kept_and_told_at_its_new_place(here: Path, capsys: Told) -> None:
    Path("c.ms").write_text(f"\n\n{WRONG}", encoding="utf-8")
    assert mlmg.main(["fmt", "c.ms"]) == 1
    assert Path("c.ms").read_text(encoding="utf-8") == "WALK  FOR 10 SEC\nIDLE\n"
    out, err = capsys.readouterr()
    assert out == ""
    assert err == (
        "c.ms:1:7: error[MS011]: `FOR` and `SEC`: the words of the language are written in lower case\n"
        "1 script rewritten\n"
    )


def test_what_only_a_check_finds_does_not_keep_a_script_from_being_in_the_form(here: Path, capsys: Told) -> None:
    Path("a.ms").write_text("WALK for 0 sec\nSub TALK\n", encoding="utf-8")
    assert mlmg.main(["fmt", "a.ms"]) == 0
    assert capsys.readouterr().err == "1 script left as it is\n"


# --- several files, folders ------------------------------------------------------------------------------


def test_of_a_folder_all_scripts_are_taken_but_those_in_hidden_folders(here: Path) -> None:
    for name in (".venv/e.ms", "sub/notes.txt", "sub/deep/f.ms"):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(WRITTEN, encoding="utf-8")
    assert mlmg.main(["fmt", "sub", "."]) == 1  # c.ms has a mistake
    formatted = {name for name, text in contents(here).items() if text == FORMATTED}
    assert formatted == {"a.ms", "b.ms", "sub/d.ms", "sub/deep/f.ms"}
    assert Path("sub/notes.txt").read_text(encoding="utf-8") == WRITTEN


def test_a_script_named_twice_is_taken_once(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "--check", "sub/d.ms", "sub", "./sub/d.ms"]) == 1
    assert capsys.readouterr() == ("sub/d.ms\n", "1 script would be rewritten\n")


def test_a_folder_without_scripts_is_told_so(here: Path, capsys: Told) -> None:
    Path("empty").mkdir()
    assert mlmg.main(["fmt", "empty"]) == 0
    assert capsys.readouterr() == ("", "there is no script (*.ms) in this folder\n")


def test_a_file_that_cannot_be_read_leaves_with_2_and_the_others_are_rewritten(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "none.ms", "a.ms"]) == 2
    assert "mlmg fmt: error: none.ms: " in capsys.readouterr().err
    assert Path("a.ms").read_text(encoding="utf-8") == FORMATTED


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everything")
def test_a_file_that_cannot_be_written_leaves_with_2(here: Path, capsys: Told) -> None:
    Path("a.ms").chmod(0o400)
    assert mlmg.main(["fmt", "a.ms"]) == 2
    assert "mlmg fmt: error: a.ms: " in capsys.readouterr().err
    assert Path("a.ms").read_text(encoding="utf-8") == WRITTEN


def test_a_file_that_is_not_utf_8_is_told_so_and_left_as_it_is(here: Path, capsys: Told) -> None:
    Path("a.ms").write_bytes(b"WALK;Gr\xfc\xdfe\n")
    assert mlmg.main(["fmt", "a.ms"]) == 1
    assert Path("a.ms").read_bytes() == b"WALK;Gr\xfc\xdfe\n"
    assert capsys.readouterr().err.startswith("a.ms:1:8: error[MS001]: this file is not UTF-8")


def test_without_a_script_it_is_said_what_to_write(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["fmt"]) == 2
    assert "no script is named; `mlmg fmt stroll.ms` takes one" in capsys.readouterr().err


# --- only looking ----------------------------------------------------------------------------------------


def test_check_writes_nothing_and_lists_what_would_be_rewritten(here: Path, capsys: Told) -> None:
    before = contents(here)
    assert mlmg.main(["fmt", "--check", "a.ms", "b.ms", "sub"]) == 1
    assert capsys.readouterr() == ("a.ms\nsub/d.ms\n", "2 scripts would be rewritten, 1 script left as it is\n")
    assert contents(here) == before


def test_check_of_scripts_in_the_form_leaves_with_0(here: Path) -> None:
    assert mlmg.main(["fmt", "--check", "b.ms"]) == 0


def test_check_tells_mistakes_where_they_are_now(here: Path, capsys: Told) -> None:
    Path("c.ms").write_text(f"\n\n{WRONG}", encoding="utf-8")
    assert mlmg.main(["fmt", "--check", "c.ms"]) == 1
    assert capsys.readouterr().err.startswith("c.ms:3:7: error[MS011]")


def test_diff_writes_nothing_and_shows_what_would_change(here: Path, capsys: Told) -> None:
    before = contents(here)
    assert mlmg.main(["fmt", "--diff", "a.ms", "b.ms"]) == 1
    out, err = capsys.readouterr()
    assert out == "--- a.ms\n+++ a.ms\n@@ -1 +1,2 @@\n-WALK;IDLE for 10s\n+WALK\n+IDLE for 10 sec\n"
    assert err == "1 script would be rewritten, 1 script left as it is\n"
    assert contents(here) == before
    assert mlmg.main(["fmt", "--diff", "b.ms"]) == 0


def test_check_and_diff_together_show_the_difference(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "--check", "--diff", "a.ms"]) == 1
    assert capsys.readouterr().out.startswith("--- a.ms\n")


# --- standard input --------------------------------------------------------------------------------------


def test_a_hyphen_reads_standard_input_and_writes_standard_output(typed: Callable[[bytes], None], capsys: Told) -> None:
    typed("WALK;走路 for 10s\r\n".encode())
    assert mlmg.main(["fmt", "-"]) == 0
    assert capsys.readouterr() == ("WALK\n走路 for 10 sec\n", "")


def test_a_mistake_on_standard_input_leaves_with_1_and_the_rest_is_written(
    typed: Callable[[bytes], None], capsys: Told
) -> None:
    typed(WRONG.encode())
    assert mlmg.main(["fmt", "-"]) == 1
    out, err = capsys.readouterr()
    assert out == "WALK  FOR 10 SEC\nIDLE\n"
    assert err.startswith("<stdin>:1:7: error[MS011]")


def test_standard_input_that_is_not_utf_8_writes_nothing(typed: Callable[[bytes], None], capsys: Told) -> None:
    typed(b"\xff")
    assert mlmg.main(["fmt", "-"]) == 1
    assert capsys.readouterr().out == ""


def test_check_of_standard_input_writes_its_name_alone(typed: Callable[[bytes], None], capsys: Told) -> None:
    typed(WRITTEN.encode())
    assert mlmg.main(["fmt", "--check", "-"]) == 1
    assert capsys.readouterr() == ("<stdin>\n", "")


def test_nobody_reading_the_changes_is_no_trouble_of_a_script(here: Path) -> None:
    Path("a.ms").write_text("WALK;IDLE\n" * 20_000, encoding="utf-8")
    command = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "fmt", "--diff", "a.ms"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        assert running.stdout is not None
        assert running.stderr is not None
        running.stdout.close()
        told = running.stderr.read()
    assert (running.returncode, told) == (141, b"")


def test_in_a_pipe_the_bytes_are_those_of_the_form() -> None:
    command = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "fmt", "-"]
    done = subprocess.run(command, input=WRITTEN.replace("\n", "\r\n").encode(), capture_output=True, check=True)
    assert done.stdout == FORMATTED.encode()


# --- names as the library spells them --------------------------------------------------------------------


def test_with_fix_names_are_spelt_as_in_the_library(built: Path, capsys: Told) -> None:
    text = "walk with upper_body talk ; STEP for 10s\nrepeat 2 { idle } # Idle\n"
    Path("a.ms").write_text(text, encoding="utf-8")
    assert mlmg.main(["fmt", "a.ms", "--library", "my.mlmg"]) == 0
    assert "walk with upper_body talk" in Path("a.ms").read_text(encoding="utf-8")
    assert mlmg.main(["fmt", "--fix", "a.ms", "--library", "my.mlmg"]) == 0
    expected = "WALK with Upper-Body TALK\nStep for 10 sec\nrepeat 2 {\n    IDLE\n}  # Idle\n"
    assert Path("a.ms").read_text(encoding="utf-8") == expected
    assert mlmg.main(["fmt", "--fix", "--check", "a.ms", "--library", "my.mlmg"]) == 0


def test_with_fix_words_in_the_wrong_case_and_unknown_names_are_left(built: Path) -> None:
    Path("a.ms").write_text("walk ONCE\nwlak\n", encoding="utf-8")
    Path("mlmg.toml").write_text('library = "my.mlmg"\n', encoding="utf-8")
    mlmg.main(["fmt", "--fix", "a.ms"])
    assert Path("a.ms").read_text(encoding="utf-8").split() == ["walk", "ONCE", "wlak"]


def test_with_fix_but_without_a_library_names_are_left(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "--fix", "a.ms", "b.ms"]) == 0
    assert Path("a.ms").read_text(encoding="utf-8") == FORMATTED
    assert capsys.readouterr().err.count("without a library, names are left as they are\n") == 1


def test_with_fix_names_are_left_where_a_used_file_is_missing(built: Path, capsys: Told) -> None:
    Path("a.ms").write_text('use "none.ms"\nwalk\n', encoding="utf-8")
    assert mlmg.main(["fmt", "--fix", "a.ms", "--library", "my.mlmg"]) == 0
    assert Path("a.ms").read_text(encoding="utf-8") == 'use "none.ms"\nwalk\n'
    assert "a.ms: a file that it uses cannot be read, so its names are left as they are\n" in capsys.readouterr().err


def test_with_fix_a_library_that_cannot_be_opened_leaves_with_2(here: Path, capsys: Told) -> None:
    assert mlmg.main(["fmt", "--fix", "a.ms", "--library", "none.mlmg"]) == 2
    assert "none.mlmg" in capsys.readouterr().err
    assert Path("a.ms").read_text(encoding="utf-8") == WRITTEN
