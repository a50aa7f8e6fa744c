from __future__ import annotations

import io
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix, Note, Severity
from mlmg_lang.rendering import render_concise, render_full, render_json, wants_colour
from mlmg_lang.source import Source, Span


def drawn(text: str, start: int, end: int) -> list[str]:
    """Return the line that is drawn and the carets below it, without their edge."""
    diagnostic = Diagnostic("MS021", "no", Span(start, end))
    lines = render_full([diagnostic], Source(text)).splitlines()
    return [line[5:] for line in lines[3:5]]


def test_the_drawing_has_the_place_the_line_and_the_remedy() -> None:
    source = Source("\n\nWLAK with Upper-Body TALK for 10 sec", "stroll.ms")
    note = Note("it is here", Span(0, 0))
    one = Diagnostic("MS021", "no tag or motion `WLAK` in this library", Span(2, 6), "there is `WALK`", (note,))
    assert render_full([one], source) == (
        "error[MS021]: no tag or motion `WLAK` in this library\n"
        "  --> stroll.ms:3:1\n"
        "   |\n"
        " 3 | WLAK with Upper-Body TALK for 10 sec\n"
        "   | ^^^^\n"
        "   = note: it is here (stroll.ms:1:1)\n"
        "   = help: there is `WALK`\n"
    )


def test_the_edge_is_as_wide_as_the_number_of_the_line() -> None:
    source = Source("\n" * 99 + "AB", "a.ms")
    assert render_full([Diagnostic("MS021", "no", Span(100, 101))], source) == (
        "error[MS021]: no\n    --> a.ms:100:2\n     |\n 100 | AB\n     |  ^\n"
    )


def test_what_has_no_place_is_told_without_a_drawing() -> None:
    one = Diagnostic("MS044", "no such start", None, "there is `Idle_01`")
    assert render_full([one], Source("A", "a.ms")) == (
        "error[MS044]: no such start\n --> a.ms\n  = help: there is `Idle_01`\n"
    )


@pytest.mark.parametrize(
    ("text", "start", "end", "line", "carets"),
    [
        ("a\tb", 2, 3, "a   b", "    ^"),
        ("\t\tb", 2, 3, "        b", "        ^"),
        ("走路 x", 3, 4, "走路 x", "     ^"),
        ("走路", 0, 2, "走路", "^^^^"),
        ("e\u0301 x", 3, 4, "e\u0301 x", "  ^"),
        ("😀 x", 2, 3, "😀 x", "   ^"),
        ("👩\u200d👧 x", 4, 5, "👩\u200d👧 x", "   ^"),
        ("👍🏽 x", 3, 4, "👍🏽 x", "   ^"),
        ("❤\ufe0f x", 3, 4, "❤\ufe0f x", "   ^"),
        ("🇩🇪 x", 3, 4, "🇩🇪 x", "   ^"),
        ("a\x07\u202eb", 3, 4, "a\ufffd\ufffdb", "   ^"),
        ("ab", 2, 2, "ab", "  ^"),
        ("ab\ncd", 1, 5, "ab", " ^"),
        ("a\r\nb", 0, 2, "a", "^"),
        ("", 0, 0, "", "^"),
    ],
)
def test_carets_stand_below_what_they_point_at(text: str, start: int, end: int, line: str, carets: str) -> None:
    shown = drawn(text, start, end)
    assert shown == [line, carets]


def test_of_a_long_line_only_what_is_around_the_place_is_drawn() -> None:
    line, carets = drawn("a" * 5000 + "X" + "b" * 5000, 5000, 5001)
    assert len(line) < 200
    assert line[len(carets) - 1] == "X"
    assert line[0] == line[-1] == "…"


def test_a_message_cannot_make_a_terminal_do_things_or_fill_it() -> None:
    source = Source("A", "a.ms")
    told = render_concise([Diagnostic("MS021", f"no `\x1b[2J{'x' * 10_000}`", Span(0, 1))], source)
    assert "\x1b" not in told
    assert len(told) < 1000


def test_the_concise_form_is_one_line_each() -> None:
    source = Source("A\nB", "a.ms")
    diagnostics = [Diagnostic("MS021", "no", Span(2, 3)), Diagnostic("MS044", "start", None)]
    assert render_concise(diagnostics, source) == "a.ms:2:1: error[MS021]: no\na.ms: error[MS044]: start\n"


def test_json_has_spans_in_lines_and_columns_of_code_points() -> None:
    source = Source("A\n走 B", "a.ms")
    one = Diagnostic("MS020", "so", Span(4, 5), "write `C`", (Note("n"),), (Fix(Span(4, 5), "C", safe=True),))
    assert json.loads(render_json([(source, [one])])) == [
        {
            "file": "a.ms",
            "code": "MS020",
            "severity": "hint",
            "span": [2, 3, 2, 4],
            "message": "so",
            "help": "write `C`",
            "notes": [{"message": "n", "span": None}],
            "fixes": [{"span": [2, 3, 2, 4], "replacement": "C", "applicability": "safe"}],
        }
    ]


def test_no_diagnostics_are_an_empty_json_list() -> None:
    assert json.loads(render_json([(Source("A"), [])])) == []


def test_colour_is_put_on_and_changes_nothing_else() -> None:
    source = Source("A B", "a.ms")
    one = Diagnostic("MS043", "no", Span(2, 3), "so")
    coloured = render_full([one], source, colour=True)
    assert "\x1b[1;33m" in coloured
    plain = coloured
    for code in ("1;33", "34", "1", "0"):
        plain = plain.replace(f"\x1b[{code}m", "")
    assert plain == render_full([one], source)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_colour_is_for_terminals_alone_and_never_with_no_color(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert wants_colour(Terminal())
    assert not wants_colour(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not wants_colour(Terminal())


@given(st.text(alphabet=st.characters(), max_size=30), st.data())
def test_any_place_in_any_text_can_be_drawn(text: str, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, len(text)))
    told = render_full([Diagnostic("MS021", text, Span(start, end))], Source(text))
    told.encode("utf-8")
    assert told.count("^") >= 1


def test_every_code_has_a_title_and_a_severity() -> None:
    assert all(rule.title and isinstance(rule.severity, Severity) for rule in CODES.values())
    assert list(CODES) == sorted(CODES)
