from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from mlmg_lang.script_files import read_script, source_from_bytes


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
