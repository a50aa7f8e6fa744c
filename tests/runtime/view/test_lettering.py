import sys

import pytest
from PIL.Image import new
from PIL.ImageDraw import Draw
from PIL.ImageFont import truetype

from mlmg_runtime.view import lettering
from mlmg_runtime.view.lettering import Pen, letters_without_font


@pytest.fixture
def sheet():
    return new("L", (300, 60))


@pytest.fixture
def pen(sheet):
    return Pen(Draw(sheet), 16)


def test_a_line_is_as_wide_as_it_says(sheet, pen):
    end = pen.write(10, 10, "Walk_01", 255)
    left, top, right, bottom = sheet.getbbox()
    assert left >= 9
    assert abs(right - end) < 3
    assert 8 < top < bottom < 36
    assert end - 10 == pytest.approx(pen.width("Walk_01"))


def test_a_long_text_is_broken_between_words_and_then_cut(pen):
    lines = pen.lines("WALK with Upper-Body TALK for 10 sec and on and on", 120, 2)
    assert len(lines) == 2
    assert lines[0] == "WALK with"
    assert lines[1].endswith("…")
    assert all(pen.width(line) <= 120 for line in lines)


def test_a_text_that_fits_stays_as_it_is(pen):
    assert pen.cut("IDLE", 100) == "IDLE"
    assert pen.lines("IDLE", 100, 2) == ["IDLE"]


@pytest.fixture
def bare(monkeypatch):
    """Stand on a system with no fonts but Pillow's own."""
    monkeypatch.setattr(lettering, "_FALLBACKS", ())
    monkeypatch.setattr(lettering.shutil, "which", lambda _: None)
    lettering._font_for.cache_clear()
    yield
    lettering._font_for.cache_clear()


@pytest.fixture
def font_program(bare, tmp_path, monkeypatch):
    """Return a function: what the system's fc-match answers, and how it ends."""

    def answer(text, code=0):
        program = tmp_path / "fc-match"
        program.write_text(f"#!{sys.executable}\nprint({text!r}, end='')\nraise SystemExit({code})\n")
        program.chmod(0o755)
        monkeypatch.setattr(lettering.shutil, "which", lambda _: str(program))
        lettering._font_for.cache_clear()

    return answer


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize(("text", "spelt"), [("→", "->"), ("走路", r"\u8d70\u8def"), ("😀", r"\U0001f600")])
def test_a_letter_that_no_font_has_is_spelt_out(pen, text, spelt):
    assert pen.width(text) == pytest.approx(pen.width(spelt))


@pytest.mark.usefixtures("bare")
def test_letters_that_no_font_has_are_told_once_and_those_with_a_plain_spelling_not():
    assert letters_without_font(["走 → 路", "Upper-Body", "路走×"]) == "走路"
    assert letters_without_font(["WALK for 3 sec", "Upper-Body"]) == ""


@pytest.mark.usefixtures("bare")
def test_a_letter_taken_apart_is_written_as_the_one_that_it_is(pen):
    assert pen.width("e\u0301") == pen.width("\u00e9")


def other_font():
    try:
        return truetype("DejaVuSans.ttf", 16)
    except OSError:
        pytest.skip("the font DejaVu Sans is not installed")


@pytest.mark.skipif(sys.platform == "win32", reason="fontconfig is elsewhere")
def test_the_systems_font_for_a_letter_is_found(pen, font_program):
    font = other_font()
    font_program(f"{font.path}\n0")
    assert letters_without_font(["Ж走"]) == "走"
    assert pen.width("♞") == pytest.approx(font.getlength("♞"))
    assert pen.width("♞走") == pytest.approx(font.getlength("♞") + pen.width(r"\u8d70"))


@pytest.mark.skipif(sys.platform == "win32", reason="fontconfig is elsewhere")
@pytest.mark.parametrize(("answer", "code"), [("", 0), ("/no/such/font.ttf\n0", 0), ("x", 1), ("x\ny", 0)])
def test_a_system_that_finds_no_font_does_no_harm(pen, font_program, answer, code):
    font_program(answer, code)
    assert pen.width("走") == pytest.approx(pen.width(r"\u8d70"))
