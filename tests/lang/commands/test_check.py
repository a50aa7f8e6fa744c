"""`mlmg check` as a user calls it, without a library."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from mlmg_lang.commands import mlmg
from mlmg_runtime.library import Library

RIGHT = "WALK with Upper-Body TALK for 10 sec\n"
WRONG = "WALK FOR 10 SEC\n"
WARNED = "WALK for 0 sec\n"


@pytest.fixture(autouse=True)
def scripts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stand in a folder with three scripts and no library."""
    monkeypatch.delenv("MLMG_LIBRARY", raising=False)
    monkeypatch.chdir(tmp_path)
    for name, text in [("right.ms", RIGHT), ("wrong.ms", WRONG), ("warned.ms", WARNED)]:
        Path(name).write_text(text, encoding="utf-8")


def test_a_right_script_is_told_so_on_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "right.ms"]) == 0
    out, err = capsys.readouterr()
    assert (out, err) == ("", "nothing wrong; without a library, names were not checked\n")


def test_an_error_is_drawn_on_standard_output_and_leaves_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "wrong.ms", "right.ms"]) == 1
    out, err = capsys.readouterr()
    assert out == (
        "error[MS011]: `FOR` and `SEC`: the words of the language are written in lower case\n"
        "  --> wrong.ms:1:6\n"
        "   |\n"
        " 1 | WALK FOR 10 SEC\n"
        "   |      ^^^^^^^^^^\n"
        "   = help: write `for` and `sec`\n"
    )
    assert err == "1 error; --fix mends 1; without a library, names were not checked\n"


def test_a_warning_leaves_with_0(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "warned.ms"]) == 0
    assert capsys.readouterr().out.startswith("warning[MS045]")


def test_the_concise_form_is_one_line_each(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--format", "concise", "wrong.ms", "warned.ms"]) == 1
    out, err = capsys.readouterr()
    assert [line.split(": ")[0] for line in out.splitlines()] == ["wrong.ms:1:6", "warned.ms:1:10"]
    assert err == ""


def test_json_is_one_list_for_all_scripts(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--format", "json", "wrong.ms", "right.ms", "warned.ms"]) == 1
    entries = json.loads(capsys.readouterr().out)
    assert [(entry["file"], entry["code"]) for entry in entries] == [("wrong.ms", "MS011"), ("warned.ms", "MS045")]
    assert entries[0]["span"] == [1, 6, 1, 16]
    fix = {"title": "write `for 10 sec`", "span": [1, 6, 1, 16], "replacement": "for 10 sec", "applicability": "safe"}
    assert entries[0]["fixes"] == [fix]


def test_a_file_that_cannot_be_read_leaves_with_2_and_the_others_are_checked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert mlmg.main(["check", "none.ms", "wrong.ms"]) == 2
    out, err = capsys.readouterr()
    assert "wrong.ms:1:6" in out
    assert "mlmg check: error: none.ms: " in err


def test_a_file_that_is_not_utf_8_is_one_error(capsys: pytest.CaptureFixture[str]) -> None:
    Path("latin.ms").write_bytes(b"WALK\nGr\xfc\xdfe with with\n")
    assert mlmg.main(["check", "--format", "concise", "latin.ms"]) == 1
    assert (
        capsys.readouterr().out == "latin.ms:2:3: error[MS001]: this file is not UTF-8: byte 0xFC cannot stand here\n"
    )


def test_a_hyphen_is_standard_input(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(WRONG.encode())))
    assert mlmg.main(["check", "--format", "concise", "-"]) == 1
    assert capsys.readouterr().out.startswith("<stdin>:1:6: error[MS011]: ")


def test_without_a_script_it_is_said_what_to_write(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check"]) == 2
    assert capsys.readouterr().err == (
        "mlmg check: error: no script is named; `mlmg check stroll.ms` takes one, "
        "`mlmg check .` all in this folder and below\n"
    )


def test_of_a_folder_all_scripts_are_checked_but_for_hidden_folders(capsys: pytest.CaptureFixture[str]) -> None:
    for folder in ("scenes", "scenes/deep", "scenes/.hidden"):
        Path(folder).mkdir()
        Path(folder, "wrong.ms").write_text(WRONG, encoding="utf-8")
    Path("scenes/notes.txt").write_text(WRONG, encoding="utf-8")
    assert mlmg.main(["check", "--format", "concise", "scenes", "scenes/wrong.ms"]) == 1
    files = [line.partition(":")[0] for line in capsys.readouterr().out.splitlines()]
    assert files == ["scenes/wrong.ms", "scenes/deep/wrong.ms"]


def test_a_folder_without_scripts_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    Path("empty").mkdir()
    assert mlmg.main(["check", "empty"]) == 0
    assert capsys.readouterr().err == "there is no script (*.ms) in this folder\n"


def test_github_and_sarif_are_one_text_for_all_scripts(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--format", "github", "wrong.ms", "right.ms", "warned.ms"]) == 1
    assert [line.split(" ")[0] for line in capsys.readouterr().out.splitlines()] == ["::error", "::warning"]
    assert mlmg.main(["check", "--format", "sarif", "wrong.ms", "right.ms", "warned.ms"]) == 1
    (run,) = json.loads(capsys.readouterr().out)["runs"]
    assert [result["ruleId"] for result in run["results"]] == ["MS011", "MS045"]


def test_what_is_wrong_with_a_file_that_several_scripts_use_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    Path("more.ms").write_text("let STROLL = WALK for\n", encoding="utf-8")
    for name in ("a.ms", "b.ms"):
        Path(name).write_text('use "more.ms"\nTALK for 2 sec\n', encoding="utf-8")
    for scripts in (["a.ms", "b.ms", "more.ms"], ["more.ms", "a.ms"], ["a.ms", "./a.ms"]):
        assert mlmg.main(["check", "--format", "concise", *scripts]) == 1
        assert [line.split(": ")[0] for line in capsys.readouterr().out.splitlines()] == ["more.ms:1:19"]


# --- edits ---

LIKELY = "WALK for 10\nWALK FOR 10 SEC\n"


@pytest.fixture
def likely() -> Path:
    """Return a script with one edit that is safe and one that is not."""
    path = Path("likely.ms")
    path.write_text(LIKELY, encoding="utf-8")
    return path


def test_what_edits_could_do_is_said_below(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "likely.ms"]) == 1
    assert capsys.readouterr().err.startswith("2 errors; --fix mends 1, --unsafe-fixes 2; ")
    likely.write_text("WALK for 10", encoding="utf-8")
    assert mlmg.main(["check", "likely.ms"]) == 1
    assert capsys.readouterr().err.startswith("1 error; --unsafe-fixes mends 1; ")


def test_fix_applies_safe_edits_and_tells_what_is_left(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--fix", "likely.ms", "right.ms"]) == 1
    out, err = capsys.readouterr()
    assert likely.read_text(encoding="utf-8") == "WALK for 10\nWALK for 10 sec\n"
    assert out.startswith("error[MS016]")
    assert err.startswith("1 fixed in likely.ms, 1 left (1 error); ")


def test_unsafe_fixes_applies_all(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--unsafe-fixes", "likely.ms"]) == 0
    assert likely.read_text(encoding="utf-8") == "WALK for 10 sec\nWALK for 10 sec\n"
    assert capsys.readouterr().err.startswith("2 fixed, nothing left; ")


def test_diff_shows_the_edits_and_makes_none(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--diff", "likely.ms", "right.ms"]) == 1
    out, err = capsys.readouterr()
    assert out == ("--- likely.ms\n+++ likely.ms\n@@ -1,2 +1,2 @@\n WALK for 10\n-WALK FOR 10 SEC\n+WALK for 10 sec\n")
    assert err.startswith("1 would be fixed in likely.ms, 1 left (1 error); ")
    assert likely.read_text(encoding="utf-8") == LIKELY


def test_diff_judges_the_script_as_it_stands(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--diff", "--unsafe-fixes", "wrong.ms"]) == 1
    assert mlmg.main(["check", "--diff", "right.ms"]) == 0
    assert capsys.readouterr().err.endswith(
        "nothing would be fixed, nothing left; without a library, names were not checked\n"
    )


def test_diff_and_a_format_of_diagnostics_do_not_go_together(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--diff", "--format", "json", "wrong.ms"]) == 2
    assert "--diff" in capsys.readouterr().err


def test_line_ends_and_a_byte_order_mark_are_kept(likely: Path) -> None:
    likely.write_bytes("\ufeffWALK FOR 1 SEC\r\n# Gr\u00fc\u00dfe\r\n".encode())
    assert mlmg.main(["check", "--fix", "likely.ms"]) == 0
    assert likely.read_bytes() == "\ufeffWALK for 1 sec\r\n# Gr\u00fc\u00dfe\r\n".encode()


def test_a_script_without_edits_is_not_written(likely: Path) -> None:
    likely.write_text(RIGHT, encoding="utf-8")
    likely.chmod(0o444)
    before = likely.stat()
    assert mlmg.main(["check", "--fix", "likely.ms"]) == 0
    assert (likely.stat().st_mtime_ns, likely.stat().st_ino) == (before.st_mtime_ns, before.st_ino)


def test_a_script_that_is_not_utf_8_is_not_touched() -> None:
    Path("latin.ms").write_bytes(b"WALK FOR 1 SEC # Gr\xfc\xdfe\n")
    assert mlmg.main(["check", "--fix", "latin.ms"]) == 1
    assert Path("latin.ms").read_bytes() == b"WALK FOR 1 SEC # Gr\xfc\xdfe\n"


def test_a_link_still_points_at_the_script_that_was_fixed(likely: Path) -> None:
    Path("link.ms").symlink_to("likely.ms")
    assert mlmg.main(["check", "--fix", "link.ms"]) == 1
    assert Path("link.ms").is_symlink()
    assert "for 10 sec" in likely.read_text(encoding="utf-8")


def test_fixed_standard_input_goes_to_standard_output_and_the_rest_to_standard_error(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(LIKELY.encode())))
    assert mlmg.main(["check", "--fix", "-"]) == 1
    out, err = capsys.readouterr()
    assert out == "WALK for 10\nWALK for 10 sec\n"
    assert err.startswith("error[MS016]")
    assert "1 fixed, 1 left (1 error)" in err


def test_standard_input_without_mistakes_is_passed_on(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(RIGHT.encode())))
    assert mlmg.main(["check", "--fix", "-"]) == 0
    assert capsys.readouterr().out == RIGHT


def test_in_other_formats_what_was_fixed_is_told_too(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--fix", "--format", "concise", "likely.ms"]) == 1
    out, err = capsys.readouterr()
    assert out == "likely.ms:1:10: error[MS016]: `10` of what? The unit is missing\n"
    assert err.startswith("1 fixed, 1 left")


# --- edits and the files that are used ---


@pytest.fixture
def users() -> list[str]:
    """Return a script and the file that it uses, each with one safe edit."""
    Path("more.ms").write_text("let STROLL = WALK & TALK FOR 2 SEC\nlet TALK_ON = TALK FOR 2 SEC\n", encoding="utf-8")
    Path("user.ms").write_text('use "more.ms"\nTALK_ON\nTALK FOR 3 SEC\n', encoding="utf-8")
    return ["user.ms", "more.ms"]


def test_a_used_file_is_not_edited_unless_it_is_named(users: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    used = Path("more.ms").read_text(encoding="utf-8")
    assert mlmg.main(["check", "--format", "full", "user.ms"]) == 1
    assert "; --fix mends 1, to mend more.ms, name it too" in capsys.readouterr().err
    assert mlmg.main(["check", "--fix", "user.ms"]) == 1
    assert Path("more.ms").read_text(encoding="utf-8") == used
    assert capsys.readouterr().err.startswith("1 fixed, 3 left (3 errors)")


def test_edits_are_counted_by_file_and_what_is_left_is_what_is_left_at_the_end(
    users: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert mlmg.main(["check", *users]) == 1
    assert "; --fix mends 3, --unsafe-fixes 4" in capsys.readouterr().err
    assert mlmg.main(["check", "--fix", *users]) == 1
    assert capsys.readouterr().err.startswith("3 fixed (1 in user.ms, 2 in more.ms), 1 left (1 error)")
    assert mlmg.main(["check", "--unsafe-fixes", *users]) == 0
    assert capsys.readouterr().err.startswith("1 fixed in more.ms, nothing left")


def test_the_demo_library_has_a_name(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], demo_library: Library
) -> None:
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    Path("misspelt.ms").write_text("WLAK for 2 sec\n", encoding="utf-8")
    assert mlmg.main(["check", "--library", "demo", "--format", "concise", "misspelt.ms"]) == 1
    assert "misspelt.ms:1:1: error[MS021]" in capsys.readouterr().out


def test_names_in_a_file_of_definitions_are_spelt_as_the_library_does(
    monkeypatch: pytest.MonkeyPatch, demo_library: Library
) -> None:
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    more = Path("more.ms")
    more.write_text("let STROLL(x) = walk01 with upper_body x\n", encoding="utf-8")
    assert mlmg.main(["check", "--library", "demo", "--fix", "more.ms"]) == 0
    assert more.read_text(encoding="utf-8") == "let STROLL(x) = Walk_01 with Upper-Body x\n"
