"""What is kept of scripts that cannot be read, and where a `;` has to stay."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from mlmg_lang.formatting.format_script import format_script
from mlmg_lang.parsing.layout import MAX_DEPTH
from mlmg_lang.source import Source

Formatted = Callable[[str], str]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A;\nwith B", "A;\nwith B\n"),
        ("A # c\n # d\n; with B", "A;  # c\n# d\nwith B\n"),
        ("repeat 2 { A };\nwith B", "repeat 2 {\n    A\n}\nwith B\n"),
        ("repeat 2; { A;B }", "repeat 2; { A;B }\n"),
        ("(A; B)", "(A;\nB)\n"),
        ("(A\nB; C\nD)", "(A\nB;\nC\nD)\n"),
        ("(A; B; C", "(A\nB\nC\n"),
        ('"a\n; with B', '"a\n;\nwith B\n'),
        ("A with; B", "A with\nB\n"),
    ],
)
def test_a_semicolon_stays_where_what_is_wrong_would_run_into_the_next_line(
    text: str, expected: str, formatted: Formatted
) -> None:
    assert formatted(text) == expected


@pytest.mark.parametrize(
    "kept",
    ["A   with", "A  (\tB", "repeat   2", "reapeat  2  {A;B}", "A  { B;C   }", "{A ;B}", "3 :", '"a  b   # no comment'],
)
def test_what_cannot_be_read_is_kept_to_the_letter(kept: str, formatted: Formatted) -> None:
    assert formatted(f"repeat 2 {{ IDLE\n\t{kept}\n;TALK }}\n") == f"repeat 2 {{\n    IDLE\n    {kept}\n    TALK\n}}\n"


def test_all_is_kept_from_a_block_that_is_not_closed_to_the_end(formatted: Formatted) -> None:
    rest = "repeat 2 {\n A;B }\n   repeat  2 {\n  A;B\n\n\n   # c"
    assert formatted(f"A;B\n{rest[:16]}A;B\n\n") == f"A\nB\n{rest[:16]}A;B\n"
    assert formatted(f"A;B\n{rest}") == "A\nB\nrepeat 2 {\n    A\n    B\n}\nrepeat  2 {\n  A;B\n\n\n   # c\n"


def test_all_is_kept_that_stands_before_a_brace_that_closes_nothing(formatted: Formatted) -> None:
    assert formatted("\n\n   # c\n  A;B\n\n\n  }  A;B") == "   # c\n  A;B\n\n\n  }\nA\nB\n"


def test_blocks_that_are_nested_too_deeply_are_kept_together(formatted: Formatted) -> None:
    deep = "repeat 1 { " * (MAX_DEPTH + 1) + "A;B" + " }" * (MAX_DEPTH + 1)
    assert formatted(f"A;B\n{deep} C;D") == f"A\nB\n{deep}\nC\nD\n"


def test_line_ends_become_lf_in_what_is_kept_too(formatted: Formatted) -> None:
    assert formatted("A (\r\n B\r and\r\n)\rC\r\n") == "A (\n B\n and\n)\nC\n"


@pytest.mark.parametrize(("text", "whole"), [("A;B", True), ("A;B with", False), ("3: A", False), ("{ A }", False)])
def test_it_is_said_whether_all_could_be_read(text: str, whole: bool) -> None:
    assert format_script(Source(text)).whole is whole


@pytest.mark.parametrize("text", ["", "\n\n", " \t ", "\ufeff", ";", ";\n;"])
def test_a_script_without_anything_is_empty(text: str, formatted: Formatted) -> None:
    assert formatted(text) == ""


def test_nesting_as_deep_as_is_allowed_is_written(formatted: Formatted) -> None:
    text = formatted("repeat 1 { " * MAX_DEPTH + "A" + " }" * MAX_DEPTH)
    assert text.splitlines()[MAX_DEPTH] == f"{' ' * 4 * MAX_DEPTH}A"
