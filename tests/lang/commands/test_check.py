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
    assert err.startswith("1 error; ")


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
    assert entries[0]["fixes"] == [{"span": [1, 6, 1, 16], "replacement": "for 10 sec", "applicability": "safe"}]


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
