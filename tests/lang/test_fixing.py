"""Edits applied again and again."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.diagnostics import Diagnostic, Fix, has_errors
from mlmg_lang.fixing import MAX_ROUNDS, Diagnose, Fixed, fix_all
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source, Span


def fixed(text: str, diagnose: Diagnose, unsafe: bool = False) -> Fixed:
    source, diagnostics = diagnose(Source(text))
    return fix_all(source, diagnostics, diagnose, unsafe)


def told_by(library: Any = None) -> Diagnose:
    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        analysis = analyse(source, library)
        return analysis.source, analysis.diagnostics

    return diagnose


def replacing(*words: tuple[str, str], safe: bool = True, code: str = "MS047") -> Diagnose:
    """Return what offers to replace each first word by the second, wherever it stands."""

    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        spans = [(word, right, source.text.find(word)) for word, right in words]
        return source, [
            Diagnostic(code, word, Span(at, at + len(word)), fixes=(Fix(Span(at, at + len(word)), right, safe),))
            for word, right, at in spans
            if at >= 0
        ]

    return diagnose


def test_safe_edits_are_applied_and_others_left(reference: Any) -> None:
    after = fixed("WLAK FOR 2 SEC\nwalk01 for 2 sec\n", told_by(reference))
    assert after.source.text == "WLAK for 2 sec\nWalk_01 for 2 sec\n"
    assert after.n_fixed == 2
    assert [one.code for one in after.diagnostics] == ["MS021"]


def test_unsafe_edits_are_applied_if_asked_for_the_first_of_each_diagnostic(reference: Any) -> None:
    after = fixed("WLAK FOR 2 SEC\nUpper-Body TALKK for 2 sec", told_by(reference), unsafe=True)
    assert after.source.text == "WALK for 2 sec\nUpper-Body TALK for 2 sec"
    assert (after.n_fixed, after.diagnostics) == (3, ())


def test_a_safe_edit_behind_an_unsafe_one_is_found() -> None:
    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        fixes = (Fix(Span(0, 1), "X", safe=False), Fix(Span(0, 1), "Y", safe=True))
        return source, [Diagnostic("MS047", "m", Span(0, 1), fixes=fixes)] if source.text == "A" else []

    assert fixed("A", diagnose).source.text == "Y"


def test_of_edits_that_overlap_the_first_wins_and_the_other_waits() -> None:
    after = fixed("abcd", replacing(("abc", "x"), ("bcd", "y"), ("xd", "z")))
    assert (after.source.text, after.n_fixed) == ("z", 2)


def test_edits_beside_each_other_are_applied_at_once() -> None:
    asked = []
    diagnose = replacing(("ab", "1"), ("cd", "2"))

    def counting(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        asked.append(source.text)
        return diagnose(source)

    assert fixed("abcd", counting).source.text == "12"
    assert asked == ["abcd", "12"]


def test_of_two_insertions_at_one_place_the_second_waits_to_be_asked_for_again() -> None:
    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        wanted = [letter for letter in "xy" if letter not in source.text]
        return source, [Diagnostic("MS047", x, Span(0, 0), fixes=(Fix(Span(0, 0), x, safe=True),)) for x in wanted]

    assert fixed("a", diagnose).source.text == "yxa"


def test_a_round_that_makes_a_script_worse_is_taken_back() -> None:
    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        fixes = (Fix(Span(0, 1), "worse", safe=True),)
        return source, [Diagnostic("MS021", "m", Span(0, 1), fixes=fixes)] * (1 + source.text.count("worse"))

    after = fixed("A", diagnose)
    assert (after.source.text, after.n_fixed, len(after.diagnostics)) == ("A", 0, 1)


def test_of_a_round_that_makes_a_script_worse_the_good_edits_are_kept() -> None:
    diagnose = replacing(("bad", "worse"), ("low", "above"), ("up", "down"))

    def judging(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        errors = [Diagnostic("MS021", "m", None)] * source.text.count("worse")
        return source, [*diagnose(source)[1], *errors]

    after = fixed("low bad up", judging)
    assert (after.source.text, after.n_fixed) == ("above bad down", 2)


def test_edits_that_undo_each_other_end() -> None:
    after = fixed("a", replacing(("a", "b"), ("b", "a")))
    assert after.n_fixed == MAX_ROUNDS


def test_an_edit_of_a_used_file_is_not_applied_to_the_script() -> None:
    used = Source("walk01", "b.ms")

    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        span = Span(len(source.text) + 1, len(source.text) + 7)
        whole = Source(source.text, source.name, (used,))
        return whole, [Diagnostic("MS020", "m", span, fixes=(Fix(span, "Walk_01", safe=True),))]

    after = fixed("A", diagnose)
    assert (after.source.text, after.n_fixed) == ("A", 0)


def test_line_ends_are_kept() -> None:
    assert fixed("WALK FOR 2 SEC\r\n\rIDLE 2 sec\n", told_by()).source.text == "WALK for 2 sec\r\n\rIDLE for 2 sec\n"


PIECES = ["WALK", "wlak", "upper_body", "TALK", "WITH", "with", "for", "FOR 10 SEC", "10", "1,5 sec", "(", ")", "\n",
          "&", "NOT", "once", "# mlmg: ignore[MS020]\n", '"a', "let X =", "X", "repeat 2 {", "}", "loop 2 {", "then",
          "/*", "*/", "//", "\uff08", "\uff09", "\uff1b", "def X :=", "pause", "1e3", ", IDLE", "X(WALK)"]  # fmt: skip


@given(script=st.lists(st.sampled_from(PIECES), max_size=15).map(" ".join), unsafe=st.booleans())
def test_no_edit_makes_any_script_worse_and_safe_ones_leave_none_behind(
    left_hand_always: Any, script: str, unsafe: bool
) -> None:
    diagnose = told_by(left_hand_always)
    before = [one for one in diagnose(Source(script))[1] if has_errors((one,))]
    after = fixed(script, diagnose, unsafe)
    assert len([one for one in after.diagnostics if has_errors((one,))]) <= len(before)
    assert tuple(after.diagnostics) == tuple(diagnose(Source(after.source.text))[1])
