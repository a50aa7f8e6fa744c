from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rapidfuzz import fuzz

from mlmg_lang.spelling import Vocabulary, counted, folded, is_slip_of, joined, listed, nearest, some

KNOWN = ("WALK", "TALK", "WAVE_HAND", "SWING_HAND", "Idle_01", "Music")


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("WLAK", "WALK"),
        ("walk", "WALK"),
        ("WAVEHAND", "WAVE_HAND"),
        ("SWING", "SWING_HAND"),
        ("Idel_1", "Idle_01"),
        ("Misuc", "Music"),
    ],
)
def test_the_nearest_name_is_the_one_meant(written: str, meant: str) -> None:
    assert nearest(written, KNOWN)[0] == meant


def test_a_name_like_no_other_has_none_near() -> None:
    assert nearest("JUGGLE", KNOWN) == ()
    assert nearest("", KNOWN) == ()
    assert nearest("WALK", ()) == ()


def slowly_nearest(name: str, known: Sequence[str], limit: int) -> tuple[str, ...]:
    """Compare a name, which has no wide letters, with one after the other."""
    choices, wanted = list(dict.fromkeys(known)), folded(name)
    alike = {choice: fuzz.ratio(wanted, folded(choice)) for choice in choices}
    by_ratio = sorted((choice for choice in choices if alike[choice] >= 65), key=lambda choice: -alike[choice])
    return tuple(by_ratio or (choice for choice in choices if sorted(folded(choice)) == sorted(wanted)))[:limit]


WORDS = st.text("abAB1_-", max_size=6)


@given(st.lists(WORDS, max_size=12), st.lists(WORDS, min_size=1, max_size=4), st.integers(1, 3))
def test_a_vocabulary_finds_what_comparing_one_name_after_the_other_does(
    known: list[str], unknown: list[str], limit: int
) -> None:
    vocabulary = Vocabulary(known)
    for name in unknown:
        assert vocabulary.nearest(name, limit) == slowly_nearest(name, known, limit)


def test_no_more_names_are_near_than_asked_for() -> None:
    assert nearest("Walk_1", [f"Walk_{at}" for at in range(10, 20)], limit=2) == ("Walk_10", "Walk_11")


@pytest.mark.parametrize("word", ["whit", "wth", "wiht", "withh", "wifh"])
def test_a_slip_is_one_letter_or_two_that_changed_places(word: str) -> None:
    assert is_slip_of(word, "with")


@pytest.mark.parametrize("word", ["with", "while", "and", "w"])
def test_other_words_are_no_slips(word: str) -> None:
    assert not is_slip_of(word, "with")


def test_case_hyphens_and_forms_of_unicode_do_not_matter_folded() -> None:
    assert folded("Upper-Body") == folded("UPPER_body") == "upperbody"
    assert folded("Gr\u00fc\u00dfe") == folded("GRU\u0308SSE")


def test_names_are_listed_as_in_a_sentence() -> None:
    assert listed(["A"]) == "`A`"
    assert listed(["A", "B"], "or") == "`A` or `B`"
    assert joined(["A", "B", "C"]) == "A, B and C"
    assert some(["A", "B", "C"], limit=2) == "`A`, `B` and 1 more"


@pytest.mark.parametrize(("number", "words"), [(0, "0 clips"), (1, "1 clip"), (2, "2 clips")])
def test_of_one_thing_there_is_one(number: int, words: str) -> None:
    assert counted(number, "clip") == words
