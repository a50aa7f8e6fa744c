import pytest
from PIL.Image import new
from PIL.ImageDraw import Draw

from mlmg_runtime.view import lettering
from mlmg_runtime.view.lettering import Pen


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


def test_a_letter_that_no_font_has_is_spelt_out(monkeypatch, pen):
    monkeypatch.setattr(lettering, "_FALLBACKS", ())
    lettering._font_for.cache_clear()
    assert pen.width("→") == pytest.approx(pen.width("->"))
    lettering._font_for.cache_clear()
