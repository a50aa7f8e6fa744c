"""What has been written of a word finds what has its letters, the likeliest first."""

from mlmg_lang.ide.fuzzy import matching

NAMES = ["Walk_01", "WALK", "Talk_01", "SWING_HAND", "WAVE_HAND", "Upper-Body", "走路"]


def test_case_does_not_count_and_what_begins_so_comes_first() -> None:
    assert matching("wa", NAMES, str)[:3] == ["Walk_01", "WALK", "WAVE_HAND"]


def test_what_is_the_word_comes_before_what_begins_with_it_however_many_do() -> None:
    names = ["RUN_1", "RUN_2", "RUNNING", "run", "RUN"]
    assert matching("run", names, str) == ["run", "RUN", "RUN_1", "RUN_2", "RUNNING"]
    assert matching("run", names, str, 1) == ["run", "RUN", "RUN_1", "RUN_2"]


def test_a_part_that_begins_so_comes_before_what_holds_it_before_what_has_its_letters() -> None:
    assert matching("hand", ["Shorthand", "WAVE_HAND", "Hello_and", "HANDS"], str) == [
        "HANDS",
        "WAVE_HAND",
        "Shorthand",
        "Hello_and",
    ]


def test_letters_may_be_left_out() -> None:
    assert matching("ubd", NAMES, str) == ["Upper-Body"]
    assert matching("wh", NAMES, str) == ["SWING_HAND", "WAVE_HAND"]


def test_nothing_written_finds_all_and_other_letters_nothing() -> None:
    assert matching("", NAMES, str) == NAMES
    assert matching("xyz", NAMES, str) == []
    assert matching("走", NAMES, str) == ["走路"]


def test_signs_are_letters_too() -> None:
    assert matching(".*", NAMES, str) == []


def test_letters_are_looked_for_once_where_they_come_first() -> None:
    word = "a" * 30
    assert matching(f"{word}b", [word * 1000], str) == []
    assert matching("aab", ["aaab", "abab", "ab"], str) == ["aaab", "abab"]
    assert matching("^-]", ["x^-]", "^-", "x^y-z]"], str) == ["x^-]", "x^y-z]"]


def test_where_enough_begin_with_the_word_the_rest_is_left_out() -> None:
    names = ["a1", "b_a", "a2", "a3", "a4"]
    assert matching("a", names, str, 4) == ["a1", "a2", "a3", "a4", "b_a"]
    assert matching("a", names, str, 2) == ["a1", "a2", "a3"]
    assert matching("", names, str, 2) == names
