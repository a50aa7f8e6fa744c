"""What of a text can be folded away: `ide.folding`."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.folding import folds
from mlmg_lang.source import Source, Span

TEXTS = st.text(alphabet='repeat 2choose{}|()#WALKwith\n;"\r', max_size=80)


def folded(text: str) -> list[tuple[int, int, bool]]:
    """Return first and last line of each fold, and whether it is comments."""
    source = Source(text)
    places = [(source.location(fold.span), fold.is_comment) for fold in folds(analyse(source))]
    return [(first, last, is_comment) for (first, _, last, _), is_comment in places]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK\nIDLE", []),
        ("repeat 2 { IDLE }", []),
        ("repeat 2 {\nIDLE\n}\n", [(1, 3, False)]),
        ("repeat 2 {\nrepeat 3 {\nIDLE\n}\n}", [(1, 5, False), (2, 4, False)]),
        ("choose {\nIDLE\nWALK\n| TALK\n}", [(1, 5, False), (2, 3, False)]),
        ("IDLE\nWALK\n  with Upper-Body TALK\n  for 2 sec\n", [(2, 4, False)]),
        ("let G = (\nWALK\nor (IDLE or\nTALK)\n)", [(1, 5, False), (3, 4, False)]),
        ("# a\n# b\n# c\nWALK", [(1, 3, True)]),
        ("# a\n\n# b\nWALK", []),
        ("WALK # a\n# b", []),
        ("WALK # a\n# b\n# c", [(2, 3, True)]),
        ("repeat 2 {\n  # a\n  # b\n  IDLE", [(1, 4, False), (2, 3, True)]),
        ("(\nWALK", []),
        ("# a\r\n# b\r\n", [(1, 2, True)]),
    ],
)
def test_blocks_parentheses_comments_and_long_commands_fold(text: str, expected: list[tuple[int, int, bool]]) -> None:
    assert folded(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("repeat 2 {\nIDLE\n}\n", [(1, 2)]),
        ("repeat 2 {\r\n  IDLE\r\n\t} # c\r\n", [(1, 2)]),
        ("repeat 2 {\nrepeat 3 {\nIDLE\n} }; WALK", [(1, 3), (2, 3)]),
        ("choose {\nrepeat 2 {\nIDLE\n}\n| TALK\n}", [(1, 5), (2, 3)]),
        ("let G = (\nWALK\nor (IDLE or\nTALK)\n)", [(1, 4), (3, 4)]),
        ("repeat 2 {\n}", []),
        ("repeat 2 {\nIDLE }", [(1, 2)]),
        ("repeat 2 {\n  IDLE\n\n", [(1, 2)]),
        ("IDLE\n  with Upper-Body (\nTALK\n) for 2 sec", [(1, 4), (2, 3)]),
        ("# a\n# }\n", [(1, 2)]),
    ],
)
def test_where_whole_lines_are_folded_a_line_that_only_closes_stays(text: str, expected: list[tuple[int, int]]) -> None:
    source = Source(text)
    places = (source.location(fold.span) for fold in folds(analyse(source), whole_lines=True))
    assert [(first, last) for first, _, last, _ in places] == expected


@given(TEXTS)
def test_of_any_text_each_fold_is_on_several_lines_and_none_is_given_twice(text: str) -> None:
    found = [(first, last) for first, last, _ in folded(text)]
    assert all(first < last for first, last in found)
    assert len(set(found)) == len(found)
    assert sorted(found, key=lambda one: one[0]) == found


@given(TEXTS, TEXTS, TEXTS)
def test_after_an_edit_folds_are_those_of_the_text_afresh(before: str, new: str, after: str) -> None:
    edited = analyse_again(analyse(Source(f"{before}\n{after}")), Source(f"{before}\n{new}\n{after}"))
    for whole_lines in (False, True):
        assert folds(edited, whole_lines) == folds(analyse(edited.source), whole_lines)


def test_comments_that_come_to_stand_together_fold_together() -> None:
    before = analyse(Source("IDLE\nWALK\n# a\nIDLE\n"))
    together = analyse_again(before, Source("IDLE\n# WALK\n# a\nIDLE\n"))
    assert [fold.span for fold in folds(together)] == [Span(5, 15)]
