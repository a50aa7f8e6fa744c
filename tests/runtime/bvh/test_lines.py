import pytest

from mlmg_runtime.bvh.lines import Lines, shown
from mlmg_runtime.errors import BvhError


def test_blank_lines_are_passed_over_and_counted() -> None:
    lines = Lines(b"one\n\n \t\n  two \nthree", "clip.bvh")
    assert [(lines.next_line(), lines.line) for _ in range(4)] == [
        ("one", 1),
        ("two", 4),
        ("three", 5),
        (None, 5),
    ]


def test_braces_are_parts_of_their_own() -> None:
    lines = Lines(b"ROOT a b {\n}} x", "clip.bvh")
    assert [lines.next_part() for _ in range(6)] == ["ROOT a b", "{", "}", "}", "x", None]


def test_what_is_not_utf_8_is_read_as_latin_1_with_a_warning() -> None:
    lines = Lines("JOINT Fuß\nJOINT Knie".encode("latin-1"), "clip.bvh")
    assert lines.next_line() == "JOINT Fuß"
    assert lines.next_line() == "JOINT Knie"
    assert lines.warnings == ["line 1 is not UTF-8: read as Latin-1"]


@pytest.mark.parametrize("word", ["0", "-1", "+1.", ".5", "1e3", "-1.25E-3", "00012"])
def test_decimal_numbers_are_numbers(word: str) -> None:
    assert Lines(b"", "clip.bvh").number(word, "a number") == float(word)


@pytest.mark.parametrize(
    "word",
    ["", "nan", "inf", "-Infinity", "1e999", "0x10", "1_0", "１", "1,5", "1.5.2", "1-2", "1e", "--1", "."],
)
def test_nothing_else_is_a_number(word: str) -> None:
    with pytest.raises(BvhError):
        Lines(b"", "clip.bvh").number(word, "a number")


def test_an_error_names_the_file_and_the_line_taken_last() -> None:
    lines = Lines(b"\nx", "clip.bvh")
    lines.next_line()
    error = lines.error("y", shown("x"))
    assert (error.path, error.line, str(error)) == ("clip.bvh", 2, "clip.bvh:2: expected y, found `x`")


def test_what_is_quoted_is_short_and_printable() -> None:
    assert shown("a" * 50) == "`" + "a" * 39 + "…`"
    assert shown("走\x1b[2J") == "`走\N{REPLACEMENT CHARACTER}[2J`"
    assert shown("") == "nothing"
    assert shown(None) == "the end of the file"
