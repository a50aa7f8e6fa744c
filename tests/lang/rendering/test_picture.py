"""Places and the lines that are drawn for them."""

from __future__ import annotations

import pytest

from mlmg_lang.diagnostics import Diagnostic, Label
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source, Span


def drawn(text: str, place: tuple[int, int], *labels: tuple[tuple[int, int], str]) -> list[str]:
    """Return the rows of a picture, without the edge of one-digit numbers."""
    others = tuple(Label(Span(*span), words) for span, words in labels)
    diagnostic = Diagnostic("MS021", "no", Span(*place), labels=others)
    return [line[5:] for line in render_full([diagnostic], Source(text)).splitlines()[3:]]


@pytest.mark.parametrize(
    ("text", "start", "end", "line", "carets"),
    [
        ("a\tb", 2, 3, "a   b", "    ^"),
        ("\t\tb", 2, 3, "        b", "        ^"),
        ("走\tb", 2, 3, "走  b", "    ^"),
        ("a\tb", 1, 2, "a   b", " ^^^"),
        ("走路 x", 3, 4, "走路 x", "     ^"),
        ("走路", 0, 2, "走路", "^^^^"),
        ("ｗａｌｋ x", 5, 6, "ｗａｌｋ x", "         ^"),
        ("e\u0301 x", 3, 4, "e\u0301 x", "  ^"),
        ("e\u0301", 1, 2, "e\u0301", "^"),
        ("\u1112\u1161\u11ab\u1100\u1173 x", 6, 7, "\u1112\u1161\u11ab\u1100\u1173 x", "     ^"),
        ("नमस्ते x", 7, 8, "नमस्ते x", "     ^"),
        ("😀 x", 2, 3, "😀 x", "   ^"),
        ("👩\u200d👩\u200d👧\u200d👦 x", 8, 9, "👩\u200d👩\u200d👧\u200d👦 x", "   ^"),
        ("👩\u200d❤\ufe0f\u200d👨 x", 7, 8, "👩\u200d❤\ufe0f\u200d👨 x", "   ^"),
        ("👩\u200d👧", 2, 3, "👩\u200d👧", "^^"),
        ("👍🏽 x", 3, 4, "👍🏽 x", "   ^"),
        ("☝🏽 x", 3, 4, "☝🏽 x", "   ^"),
        ("❤\ufe0f x", 3, 4, "❤\ufe0f x", "   ^"),
        ("1\ufe0f\u20e3 x", 4, 5, "1\ufe0f\u20e3 x", "   ^"),
        ("🇩🇪🇫🇷 x", 5, 6, "🇩🇪🇫🇷 x", "     ^"),
        ("🇩🇪🇫🇷", 2, 3, "🇩🇪🇫🇷", "  ^^"),
        ("🏴\U000e0067\U000e0062\U000e007f x", 5, 6, "🏴\U000e0067\U000e0062\U000e007f x", "   ^"),
        ("a\x07\u202eb", 3, 4, "a\ufffd\ufffdb", "   ^"),
        ("WA\u200bLK\u00ad x", 7, 8, "WA\ufffdLK\ufffd x", "       ^"),
        ("WA\u200dLK", 2, 3, "WA\ufffdLK", "  ^"),
        ("ab", 2, 2, "ab", "  ^"),
        ("a\r\nb", 0, 2, "a", "^"),
        ("", 0, 0, "", "^"),
    ],
)
def test_carets_stand_below_what_they_point_at(text: str, start: int, end: int, line: str, carets: str) -> None:
    assert drawn(text, (start, end)) == [line, carets]


def test_letters_from_right_to_left_keep_their_columns_whether_or_not_a_terminal_turns_them_about() -> None:
    shalom, olam = "\u05e9\u05dc\u05d5\u05dd", "\u05e2\u05d5\u05dc\u05dd"
    line, carets = drawn(f"{shalom} {olam} x", (5, 9))
    mark = "\u200e"
    assert line == f"{mark}{shalom} {mark}{olam}{mark} x{mark}"
    assert carets == "     ^^^^"


def test_a_stretch_over_lines_is_underlined_in_each_without_its_indentation() -> None:
    assert drawn("A (\n  B and\n\n  C)", (2, 17)) == ["A (", "  ^", "  B and", "  ^^^^^", "", "  C)", "  ^^"]


def test_a_stretch_that_ends_with_its_line_goes_no_further() -> None:
    assert drawn("ab\ncd", (0, 3)) == ["ab", "^^"]
    assert drawn("ab\ncd", (1, 2), ((0, 3), "all")) == ["ab", "-^ all"]


def test_of_a_stretch_over_many_lines_the_first_two_and_the_last_are_drawn() -> None:
    text = "\n".join("abcdefg")
    assert drawn(text, (0, len(text))) == ["a", "^", "b", "^", "", "g", "^"]


def test_words_stand_behind_the_last_place_of_a_line_and_hang_below_the_others() -> None:
    assert drawn("WALK with Full-Body TALK", (10, 19), ((0, 4), "said here")) == [
        "WALK with Full-Body TALK",
        "----      ^^^^^^^^^",
        "|",
        "said here",
    ]
    assert drawn("A B C D", (2, 3), ((0, 1), "a"), ((4, 5), "c"), ((6, 7), "d")) == [
        "A B C D",
        "- ^ - - d",
        "|   |",
        "|   c",
        "a",
    ]


def test_words_stand_at_the_end_of_a_stretch_over_lines() -> None:
    assert drawn("A B\nC D", (0, 1), ((2, 5), "both")) == ["A B", "^ -", "C D", "- both"]


def test_the_place_itself_is_drawn_over_others() -> None:
    assert drawn("A B C", (2, 3), ((0, 5), "all")) == ["A B C", "--^-- all"]


def test_a_single_line_between_two_is_drawn_and_more_are_left_out() -> None:
    assert drawn("a\nb\nc", (4, 5), ((0, 1), "x")) == ["a", "- x", "b", "c", "^"]
    assert drawn("a\nb\nb\nc", (6, 7), ((0, 1), "x")) == ["a", "- x", "", "c", "^"]


def test_of_a_long_line_only_what_is_around_the_place_is_drawn() -> None:
    line, carets = drawn("a" * 5000 + "X" + "b" * 5000, (5000, 5001))
    assert line == f"…{'a' * 30}X{'b' * 89}…"
    assert line[len(carets) - 1] == "X"


def test_a_long_line_of_wide_characters_is_cut_by_columns() -> None:
    line, carets = drawn("走" * 500, (100, 101))
    assert line == f"…{'走' * 60}…"
    assert carets == " " * 31 + "^^"


def test_a_long_place_is_underlined_as_far_as_it_is_drawn() -> None:
    line, carets = drawn("a" * 500, (0, 500))
    assert line == f"{'a' * 120}…"
    assert carets == "^" * 120


def test_a_place_that_a_long_line_is_cut_before_is_drawn_at_the_edge() -> None:
    line, carets, *rest = drawn("a" * 500, (200, 201), ((0, 1), "left"), ((499, 500), "right"))
    assert (line[0], line[-1]) == ("…", "…")
    assert carets == f"-{' ' * 30}^{' ' * 89}- right"
    assert rest == ["|", "left"]


def test_a_character_of_endless_marks_does_not_make_a_drawing_endless() -> None:
    line, _ = drawn("a" + "\u0301" * 10_000 + " b", (0, 1))
    assert len(line) < 1000


def test_words_cannot_make_a_terminal_do_things() -> None:
    assert "\x1b" not in "".join(drawn("A B", (0, 1), ((2, 3), "\x1b[2J"), ((0, 1), "\x1b[2J")))
