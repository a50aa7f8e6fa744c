"""`mlmg check` as a user calls it, without a library."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from mlmg_lang.commands import mlmg

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


def test_no_script_is_wrong_usage() -> None:
    with pytest.raises(SystemExit) as left:
        mlmg.main(["check"])
    assert left.value.code == 2


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
    assert err.startswith("1 fixed, 1 left (1 error); ")


def test_unsafe_fixes_applies_all(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--unsafe-fixes", "likely.ms"]) == 0
    assert likely.read_text(encoding="utf-8") == "WALK for 10 sec\nWALK for 10 sec\n"
    assert capsys.readouterr().err.startswith("2 fixed, nothing left; ")


def test_diff_shows_the_edits_and_makes_none(likely: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["check", "--diff", "likely.ms", "right.ms"]) == 1
    out, err = capsys.readouterr()
    assert out == ("--- likely.ms\n+++ likely.ms\n@@ -1,2 +1,2 @@\n WALK for 10\n-WALK FOR 10 SEC\n+WALK for 10 sec\n")
    assert err.startswith("1 would be fixed, 1 left (1 error); ")
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
