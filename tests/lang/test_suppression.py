"""Comments that ask for silence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source

Told = Callable[..., list[tuple[str, int]]]


@pytest.fixture
def told(reference: Any) -> Told:
    """Return a function: script -> the codes of its diagnostics, each with its line."""

    def ask(text: str, **options: Any) -> list[tuple[str, int]]:
        analysis = analyse(Source(text, "a.ms"), reference, **options)
        return [
            (one.code, analysis.source.position(one.span.start)[0] if one.span else 0) for one in analysis.diagnostics
        ]

    return ask


class Files:
    """One file, whatever is asked for."""

    def __init__(self, text: str) -> None:
        self.text = text

    def find(self, path: str, user: str) -> tuple[Source, tuple[()]]:
        return Source(self.text, path), ()


def test_a_comment_at_the_end_of_a_line_silences_that_line(told: Told) -> None:
    assert told("walk01 for 2 sec  # mlmg: ignore[MS020]\nwalk02 for 2 sec") == [("MS020", 2)]


def test_a_comment_on_its_own_line_silences_the_next_statement(told: Told) -> None:
    assert told("# mlmg: ignore[MS020]\n\nwalk01\n  with talk for 2 sec\nwalk02 for 2 sec") == [("MS020", 5)]


def test_of_several_statements_in_the_next_line_the_first_is_silenced(told: Told) -> None:
    assert told("# mlmg: ignore[MS020]\nwalk01 for 2 sec; walk02 for 2 sec") == [("MS020", 2)]


def test_a_comment_before_a_block_silences_all_of_it(told: Told) -> None:
    assert told("# mlmg: ignore[MS020]\nrepeat 2 {\n  walk01 for 2 sec\n}\nwalk02 for 1 sec") == [("MS020", 5)]


def test_a_comment_in_a_block_silences_the_next_statement_of_it(told: Told) -> None:
    script = "repeat 2 {\n  # mlmg: ignore[MS020]\n  walk01 for 2 sec\n  walk02 for 2 sec\n}"
    assert told(script) == [("MS020", 4)]


def test_a_comment_before_a_weighted_branch_silences_its_first_statement(told: Told) -> None:
    assert told("choose {\n  # mlmg: ignore[MS020]\n  2: walk01 for 2 sec\n | IDLE for 2 sec }") == []


def test_a_comment_within_a_statement_silences_what_is_left_of_it(told: Told) -> None:
    assert told("walk01\n  # mlmg: ignore[MS020]\n  with talk for 2 sec\nwalk02 for 2 sec") == [
        ("MS020", 1),
        ("MS020", 4),
    ]


def test_a_comment_at_the_end_of_any_line_of_a_statement_silences_what_is_said_of_all_of_it(told: Told) -> None:
    assert told("Idle_01\nWALK\n  with TALK  # mlmg: ignore[MS047]\nIDLE for 2 sec") == []


def test_a_comment_for_the_file_silences_it_wherever_it_stands(told: Told) -> None:
    assert told("walk01 for 2 sec\nwalk02 for 2 sec\n# mlmg: ignore-file[MS020]\n") == []


def test_several_codes_can_be_named_in_any_case_and_a_reason_given(told: Told) -> None:
    assert told("Idle_01\nwalk01  #mlmg:ignore[ ms020 ,MS047 ] it is only passed through\nIDLE for 2 sec") == []


def test_other_diagnostics_are_told_as_before(told: Told) -> None:
    assert told("walk01 for 0 sec  # mlmg: ignore[MS020]") == [("MS045", 1)]


def test_a_comment_that_ignores_nothing_is_told_so(told: Told) -> None:
    assert told("WALK for 2 sec  # mlmg: ignore[MS020]") == [("MS070", 1)]
    assert told("walk01 for 2 sec\n# mlmg: ignore[MS020]") == [("MS020", 1), ("MS070", 2)]


def test_whether_a_comment_is_idle_is_not_told_while_something_is_not_known(told: Told) -> None:
    assert told("WLAK for 2 sec\nWALK for 2 sec  # mlmg: ignore[MS047]") == [("MS021", 1)]
    assert analyse(Source("WALK for 2 sec  # mlmg: ignore[MS020]")).diagnostics == ()


def test_an_error_cannot_be_silenced(told: Told) -> None:
    assert told("WLAK for 2 sec  # mlmg: ignore[MS021]") == [("MS021", 1), ("MS072", 1)]
    assert told("# mlmg: ignore-file[MS021]\nWLAK for 2 sec") == [("MS072", 1), ("MS021", 2)]


@pytest.mark.parametrize(
    "comment",
    ["# mlmg: ignore", "# mlmg: ignore[]", "# mlmg: ignore MS020", "# mlmg: ingore[MS020]", "# mlmg: ignore[X]"],
)
def test_a_comment_that_is_not_understood_is_told_so(comment: str, told: Told) -> None:
    assert told(f"WALK for 2 sec  {comment}") == [("MS071", 1)]


def test_other_comments_are_for_people(told: Told) -> None:
    assert told("WALK for 2 sec  # mlmg plays this; ignore[MS020]\n# see mlmg: ignore[MS020]") == []


def test_a_comment_in_a_used_file_silences_that_file(told: Told) -> None:
    script = 'use "more.ms"\nSTROLL for 2 sec\nwalk02 for 2 sec'
    loud = "let STROLL = walk01\n"
    assert told(script, files=Files(loud)) == [("MS020", 3), ("MS020", 1)]
    assert told(script, files=Files(f"# mlmg: ignore[MS020]\n{loud}")) == [("MS020", 3)]
    assert told(script, files=Files(f"{loud}# mlmg: ignore-file[MS020]\n")) == [("MS020", 3)]
    assert told(f"{script} # mlmg: ignore-file[MS020]", files=Files(loud)) == [("MS020", 1)]


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK for 2 sec  # mlmg: ignore[MS020]\n", "WALK for 2 sec\n"),
        ("WALK for 2 sec\n  # mlmg: ignore[MS020]\nIDLE for 2 sec", "WALK for 2 sec\nIDLE for 2 sec"),
        ("# mlmg: ignore[MS020]\r\nWALK for 2 sec\r\n", "WALK for 2 sec\r\n"),
        ("walk01 for 2 sec # mlmg: ignore[MS045, MS020] so", "walk01 for 2 sec # mlmg: ignore[MS020] so"),
        ("WALK for 2 sec # mlmg: ignore[MS020] # a stroll", "WALK for 2 sec # a stroll"),
        ("WALK for 2 sec # mlmg: ignore[MS021]", "WALK for 2 sec"),
        ("WALK for 2 sec # mlmg: ignore[MS999]", "WALK for 2 sec"),
        ("WALK for 2 sec # mlmg: ignore", "WALK for 2 sec"),
    ],
)
def test_an_idle_comment_is_taken_out_safely(
    script: str, right: str, fixed: Callable[..., str], reference: Any
) -> None:
    (one,) = analyse(Source(script), reference).diagnostics
    assert [fix.safe for fix in one.fixes] == [True]
    assert fixed(script, reference) == right


def test_an_unknown_code_is_answered_with_those_like_it(reference: Any) -> None:
    (one,) = analyse(Source("WALK for 2 sec # mlmg: ignore[MS0020]"), reference).diagnostics
    assert one.help is not None
    assert "`MS020`" in one.help
