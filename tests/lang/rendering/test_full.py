"""How a diagnostic is drawn for a person."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.diagnostics import Diagnostic, Label, Note
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source, Span


def test_the_drawing_has_the_place_the_line_and_the_remedy() -> None:
    source = Source("\n\nWLAK with Upper-Body TALK for 10 sec", "stroll.ms")
    notes = (Note("nothing is like it"),)
    one = Diagnostic("MS021", "no tag or motion `WLAK` in this library", Span(2, 6), "there is `WALK`", notes)
    assert render_full([one], source) == (
        "error[MS021]: no tag or motion `WLAK` in this library\n"
        "  --> stroll.ms:3:1\n"
        "   |\n"
        " 3 | WLAK with Upper-Body TALK for 10 sec\n"
        "   | ^^^^\n"
        "   = note: nothing is like it\n"
        "   = help: there is `WALK`\n"
    )


def test_the_edge_is_as_wide_as_the_largest_number_of_a_line() -> None:
    source = Source("\n" * 99 + "AB", "a.ms")
    assert render_full([Diagnostic("MS021", "no", Span(100, 101))], source) == (
        "error[MS021]: no\n    --> a.ms:100:2\n     |\n 100 | AB\n     |  ^\n"
    )
    labels = (Label(Span(100, 101), "there"),)
    assert render_full([Diagnostic("MS021", "no", Span(3, 4), labels=labels)], source) == (
        "error[MS021]: no\n    --> a.ms:4:1\n     |\n   4 |\n     | ^\n ...\n 100 | AB\n     |  - there\n"
    )


def test_what_has_no_place_is_told_without_a_drawing() -> None:
    one = Diagnostic("MS044", "no such start", None, "there is `Idle_01`")
    assert render_full([one], Source("A", "a.ms")) == (
        "error[MS044]: no such start\n --> a.ms\n  = help: there is `Idle_01`\n"
    )


def test_several_diagnostics_stand_an_empty_line_apart() -> None:
    ones = [Diagnostic("MS044", "a", None), Diagnostic("MS044", "b", None)]
    assert render_full(ones, Source("A", "a.ms")) == "error[MS044]: a\n --> a.ms\n\nerror[MS044]: b\n --> a.ms\n"


def test_a_note_that_has_a_place_is_drawn_there() -> None:
    source = Source("let GREET = WALK\nlet GREET = TALK", "a.ms")
    notes = (Note("it is defined here first", Span(4, 9)),)
    assert render_full([Diagnostic("MS050", "`GREET` is defined twice", Span(21, 26), notes=notes)], source) == (
        "error[MS050]: `GREET` is defined twice\n"
        "  --> a.ms:2:5\n"
        "   |\n"
        " 1 | let GREET = WALK\n"
        "   |     ----- it is defined here first\n"
        " 2 | let GREET = TALK\n"
        "   |     ^^^^^\n"
    )


def test_a_place_in_a_used_file_is_drawn_below_with_the_name_of_that_file() -> None:
    used = Source("# gestures\nlet GREET = TALK\n", "gestures.ms")
    source = Source('use "gestures.ms"\nlet GREET = WALK\n', "a.ms", (used,))
    begin = len(source.text) + 1 + used.text.index("GREET")
    one = Diagnostic("MS050", "twice", Span(22, 27), "rename it", labels=(Label(Span(begin, begin + 5), "first here"),))
    assert render_full([one], source) == (
        "error[MS050]: twice\n"
        "  --> a.ms:2:5\n"
        "   |\n"
        " 2 | let GREET = WALK\n"
        "   |     ^^^^^\n"
        "  ::: gestures.ms:2:5\n"
        "   |\n"
        " 2 | let GREET = TALK\n"
        "   |     ----- first here\n"
        "   = help: rename it\n"
    )


def test_a_diagnostic_of_a_used_file_is_drawn_there() -> None:
    source = Source('use "b.ms"', "a.ms", (Source("let X = WLAK", "b.ms"),))
    begin = len(source.text) + 1 + 8
    drawn = render_full([Diagnostic("MS021", "no", Span(begin, begin + 4))], source)
    assert drawn == "error[MS021]: no\n  --> b.ms:1:9\n   |\n 1 | let X = WLAK\n   |         ^^^^\n"


def test_colour_is_put_on_and_changes_nothing_else() -> None:
    source = Source("A B C", "a.ms")
    one = Diagnostic("MS043", "no", Span(2, 3), "so", labels=(Label(Span(0, 1), "x"), Label(Span(4, 5), "y")))
    coloured = render_full([one], source, colour=True)
    assert "\x1b[1;33m^\x1b[0m" in coloured
    assert "\x1b[1;34m- y\x1b[0m" in coloured
    plain = coloured
    for code in ("1;33", "1;34", "34", "1", "0"):
        plain = plain.replace(f"\x1b[{code}m", "")
    assert plain == render_full([one], source)


@given(st.text(alphabet=st.characters(), max_size=30), st.data())
def test_any_places_in_any_text_can_be_drawn(text: str, data: st.DataObject) -> None:
    spans = []
    for _ in range(3):
        start = data.draw(st.integers(0, len(text)))
        spans.append(Span(start, data.draw(st.integers(start, len(text)))))
    labels = tuple(Label(span, text) for span in spans[1:])
    told = render_full([Diagnostic("MS021", text, spans[0], labels=labels)], Source(text))
    told.encode("utf-8")
    assert told.count("^") >= 1
