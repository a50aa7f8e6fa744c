"""Lines that are wider than the terminal are broken at words, and go on below what they say."""

import pytest

from mlmg_lang.repl.terminal.wrapping import wrapped


@pytest.mark.parametrize(
    ("text", "width", "expected"),
    [
        ("one two three\n", 13, "one two three\n"),
        ("one two three\n", 12, "one two\n    three\n"),
        ("  one two three\n", 14, "  one two\n      three\n"),
        (".state  what is playing\n", 20, ".state  what is\n        playing\n"),
        (".save FILE.bvh  write the motion\n", 18, ".save FILE.bvh\n    write the\n    motion\n"),
        ("  1.  Walk_03  after 1.5 s  taken\n", 29, "  1.  Walk_03  after 1.5 s\n      taken\n"),
        ("│  ├─ one two three\n", 16, "│  ├─ one two\n│  │      three\n"),
        ("└─ one two three\n", 13, "└─ one two\n       three\n"),
        ("   = help: write `WALK`\n", 22, "   = help: write\n           `WALK`\n"),
        (" 1 | WALK with Upper-Body\n   | ^^^^ this one\n", 10, " 1 | WALK with Upper-Body\n   | ^^^^ this one\n"),
        ("  --> my stroll.ms:3:1\n", 12, "  --> my stroll.ms:3:1\n"),
        ("走路 走路 走路\n", 9, "走路 走路\n    走路\n"),
        ("\x1b[34mone\x1b[0m two three\n", 13, "\x1b[34mone\x1b[0m two three\n"),
        ("\x1b[34mone\x1b[0m two three\n", 12, "\x1b[34mone\x1b[0m two\n    three\n"),
        ("unbreakable word\n", 6, "unbreakable\n    word\n"),
        ("\n", 6, "\n"),
        ("", 6, ""),
    ],
)
def test_a_line_is_broken_at_words_and_indented(text: str, width: int, expected: str) -> None:
    assert wrapped(text, width) == expected


@pytest.mark.parametrize("width", range(1, 90))
def test_no_word_is_lost_at_any_width(width: int) -> None:
    text = "│  ├─ 1.  Talk_01  OMS 588,616 (1.0 of usual)    about 3.2 s  cost 1.34\n.undo [N]  take the last back\n"
    lines = wrapped(text, width)
    assert [word for word in lines.split() if word not in ("│", "├─")] == [
        word for word in text.split() if word not in ("│", "├─")
    ]
