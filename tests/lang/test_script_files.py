from __future__ import annotations

import io
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.script_files import read_script, source_from_bytes, used_files


def test_a_script_is_read_as_utf_8_without_its_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "a.ms"
    path.write_bytes("\ufeff走路\r\n".encode())
    source, wrong = read_script(path)
    assert (source.text, source.name, wrong) == ("走路\r\n", str(path), ())


def test_bytes_that_are_no_text_are_one_clear_mistake() -> None:
    source, (one,) = source_from_bytes("走\nGr".encode() + b"\xfc\xdfe", "a.ms")
    assert one.code == "MS001"
    assert one.span is not None
    assert source.location(one.span) == (2, 3, 2, 4)
    assert "0xFC" in one.message


def test_a_place_is_right_after_a_byte_order_mark_and_a_character_that_stands_for_a_wrong_byte() -> None:
    source, (one,) = source_from_bytes(b"\xef\xbb\xbf\xef\xbf\xbdA\xff", "a.ms")
    assert one.span is not None
    assert source.location(one.span) == (1, 3, 1, 4)


@pytest.mark.parametrize("data", [b"HIERARCHY\r\nROOT Hips\r\n{\r\n", b"\n HIERARCHY ROOT x\n\xff"])
def test_a_clip_is_said_to_be_one(data: bytes) -> None:
    _, (one,) = source_from_bytes(data, "Walk_01.bvh")
    assert (one.code, one.message.split(",")[0]) == ("MS008", "this is a clip (BVH)")


def test_a_script_that_begins_like_a_clip_is_a_script() -> None:
    assert source_from_bytes(b"HIERARCHY with ROOT", "a.ms")[1] == ()


def test_utf_16_is_recognised() -> None:
    _, (one,) = source_from_bytes("WALK".encode("utf-16"), "a.ms")
    assert one.help is not None
    assert "UTF-16" in one.help


def test_a_hyphen_is_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"WALK")))
    source, _ = read_script("-")
    assert (source.text, source.name) == ("WALK", "<stdin>")


def test_a_file_that_is_not_there_is_an_error_of_the_system(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_script(tmp_path / "none.ms")


# --- the files that a script uses ---


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with plays and moves, in which the test stands."""
    for name, text in {
        "plays/main.ms": 'use "near.ms"',
        "plays/near.ms": "let NEAR = WALK",
        "plays/deep/er.ms": "let DEEPER = WALK",
        "moves/far.ms": "let FAR = WALK",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def found(path: str, script: str = "plays/main.ms", user: str | None = None, allowed: tuple[str, ...] = ()) -> str:
    """Return the name of the file that is found, or why there is none."""
    outcome = used_files(script, allowed).find(path, user or script)
    return outcome if isinstance(outcome, str) else outcome[0].name


OUTSIDE = (
    "lies outside of the script's own folders; `--allow-use FOLDER`, or `mlmg.allowUse` in an editor, would allow it"
)


def test_a_used_file_is_found_from_the_folder_of_the_one_that_names_it(folder: Path) -> None:
    assert found("near.ms") == "plays/near.ms"
    assert found("deep/er.ms") == "plays/deep/er.ms"
    assert found("./deep/../near.ms") == "plays/near.ms"
    assert found("../near.ms", user="plays/deep/er.ms") == "plays/near.ms"
    assert found("er.ms", user="plays/deep/er.ms") == "plays/deep/er.ms"
    assert found(str(folder / "plays/near.ms")) == str(folder / "plays/near.ms")


def test_a_script_that_is_named_in_full_finds_the_same(folder: Path) -> None:
    assert found("near.ms", script=str(folder / "plays/main.ms")) == str(folder / "plays/near.ms")


def test_standard_input_stands_in_the_current_folder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder / "plays")
    assert found("near.ms", script="-", user="<stdin>") == "near.ms"
    assert found("../moves/far.ms", script="-", user="<stdin>") == f"`../moves/far.ms` {OUTSIDE}"


def test_a_script_finds_itself_under_its_own_name(folder: Path) -> None:
    (folder / "plays/same.ms").symlink_to("main.ms")
    assert found("main.ms") == "plays/main.ms"
    assert found("same.ms") == "plays/main.ms"
    assert found("../plays/./main.ms") == "plays/main.ms"


@pytest.mark.parametrize("path", ["../moves/far.ms", "/etc/hostname", "../../..", "..", "/dev/zero", "../none.ms"])
def test_what_lies_outside_cannot_be_used(path: str, folder: Path) -> None:
    assert found(path) == f"`{path}` {OUTSIDE}"


def test_a_link_that_leads_outside_is_not_followed(folder: Path) -> None:
    (folder / "plays/far.ms").symlink_to(folder / "moves/far.ms")
    (folder / "plays/all").symlink_to(folder / "moves")
    assert found("far.ms") == f"`far.ms` {OUTSIDE}"
    assert found("all/far.ms") == f"`all/far.ms` {OUTSIDE}"


def test_a_link_inside_is_followed(folder: Path) -> None:
    (folder / "plays/other.ms").symlink_to("near.ms")
    outcome = used_files("plays/main.ms").find("other.ms", "plays/main.ms")
    assert not isinstance(outcome, str)
    assert outcome[0].text == "let NEAR = WALK"


def test_a_folder_whose_name_begins_alike_is_outside(folder: Path) -> None:
    (folder / "plays2").mkdir()
    (folder / "plays2/x.ms").write_text("let X = WALK", encoding="utf-8")
    assert found("../plays2/x.ms") == f"`../plays2/x.ms` {OUTSIDE}"


def test_a_folder_that_is_allowed_is_not_outside(folder: Path) -> None:
    assert found("../moves/far.ms", allowed=("moves",)) == "moves/far.ms"
    assert found("../moves/far.ms", allowed=("moves/../moves/",)) == "moves/far.ms"
    (folder / "plays/far.ms").symlink_to(folder / "moves/far.ms")
    assert found("far.ms", allowed=(str(folder / "moves"),)) == "plays/far.ms"
    assert found("../moves/far.ms", allowed=("moves/deep",)) == f"`../moves/far.ms` {OUTSIDE}"


def test_an_allowed_folder_may_be_a_link(folder: Path) -> None:
    (folder / "shortcut").symlink_to(folder / "moves")
    assert found("../moves/far.ms", allowed=("shortcut",)) == "moves/far.ms"
    assert found("../shortcut/far.ms", allowed=("shortcut",)) == "shortcut/far.ms"


def test_the_folder_of_the_settings_is_the_scripts_own(folder: Path) -> None:
    (folder / "mlmg.toml").write_text("", encoding="utf-8")
    assert found("../moves/far.ms") == "moves/far.ms"
    (folder / "plays/mlmg.toml").write_text("", encoding="utf-8")
    assert found("../moves/far.ms") == f"`../moves/far.ms` {OUTSIDE}"


def test_the_scripts_that_could_be_used_are_listed_as_paths_name_them(folder: Path) -> None:
    (folder / "plays/more.ms").write_text("", encoding="utf-8")
    (folder / "plays/notes.txt").write_text("", encoding="utf-8")
    (folder / "plays/folder.ms").mkdir()
    files = used_files("plays/main.ms")
    assert files.paths("", "plays/main.ms") == files.paths("mo", "plays/main.ms") == ("more.ms", "near.ms")
    assert files.paths("deep/x", "plays/main.ms") == ("deep/er.ms",)
    assert files.paths("../moves/", "plays/main.ms") == ()
    assert used_files("plays/main.ms", ("moves",)).paths("../moves/", "plays/main.ms") == ("../moves/far.ms",)
    assert files.paths("none/", "plays/main.ms") == files.paths("\0/", "plays/main.ms") == ()


def test_a_missing_file_is_answered_with_one_of_nearly_that_name(folder: Path) -> None:
    assert found("naer.ms") == "there is no file `naer.ms`; there is `near.ms`"
    assert found("near.txt") == "there is no file `near.txt`; there is `near.ms`"
    assert found("something else") == "there is no file `something else`"
    assert found("none/near.ms") == "there is no file `none/near.ms`"


def test_what_is_no_file_cannot_be_used(folder: Path) -> None:
    os.mkfifo(folder / "plays/pipe.ms")
    assert found("deep") == "`deep` is not a file"
    assert found("pipe.ms") == "`pipe.ms` is not a file"
    assert found("near.ms/x.ms") == "`near.ms/x.ms` cannot be read: Not a directory"
    (folder / "plays/loop.ms").symlink_to("loop.ms")
    assert found("loop.ms").startswith("`loop.ms` cannot be read: ")


@pytest.mark.parametrize("path", ["a\0b.ms", "\0", "\ud800.ms", "x" * 300, "a/" * 3_000 + "b.ms", "~/x.ms"])
def test_any_path_is_answered(path: str, folder: Path) -> None:
    assert path in found(path)


def test_a_file_that_may_not_be_read_says_so(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refuse)
    assert found("near.ms") == "`near.ms` cannot be read: Permission denied"


def test_bytes_that_are_no_text_are_told_with_the_file(folder: Path) -> None:
    (folder / "plays/latin.ms").write_bytes(b"let A = \xe9")
    outcome = used_files("plays/main.ms").find("latin.ms", "plays/main.ms")
    assert not isinstance(outcome, str)
    source, (one,) = outcome
    assert (source.name, one.code) == ("plays/latin.ms", "MS001")


def test_a_circle_by_way_of_links_ends(folder: Path) -> None:
    (folder / "plays/again").symlink_to(".")
    (folder / "plays/main.ms").write_text('use "again/near.ms"', encoding="utf-8")
    (folder / "plays/near.ms").write_text('use "again/near.ms"', encoding="utf-8")
    source, _ = read_script("plays/main.ms")
    assert {one.code for one in analyse(source, files=used_files("plays/main.ms")).diagnostics} <= {"MS058", "MS059"}


def test_a_script_with_all_that_it_uses_is_analysed_from_the_disk(folder: Path, reference: Any) -> None:
    (folder / "plays/main.ms").write_text('use "near.ms"\nuse "deep/er.ms"\nNEAR with DEEPER', encoding="utf-8")
    (folder / "plays/deep/er.ms").write_text('use "../near.ms"\nlet DEEPER = Upper-Body TLAK', encoding="utf-8")
    source, _ = read_script("plays/main.ms")
    analysis = analyse(source, reference, files=used_files("plays/main.ms"))
    (one,) = analysis.diagnostics
    assert one.span is not None
    file, _ = analysis.source.file(one.span.start)
    assert (one.code, file.name, analysis.source.location(one.span)) == ("MS021", "plays/deep/er.ms", (2, 25, 2, 29))
