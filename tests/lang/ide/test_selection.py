"""Ever larger stretches around a place: `ide.selection`."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.selection import selection
from mlmg_lang.source import Source, Span

TEXTS = st.text(alphabet='repeat 2choose{}|()#WALKwith or \n;"let=', max_size=80)


def selected(text: str) -> list[str]:
    """Return the stretches around `¦`, without the last, which is the file."""
    before, _, after = text.partition("¦")
    source = Source(before + after)
    spans = selection(analyse(source), len(before))
    assert spans[-1] == Span(0, len(source.text))
    return [source.slice(span) for span in spans[:-1]]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("IDLE\nWALK with Upper-Body TA¦LK for 2 sec\n", "TALK|Upper-Body TALK|WALK with Upper-Body TALK|{} for 2 sec"),
        ("IDLE\nWALK for 10¦ sec\n", "10|10 sec|WALK for 10 sec"),
        ("IDLE\nG¦(WALK)\n", "G|G(WALK)"),
        ("IDLE\nG(WALK or ID¦LE, 2 sec)\n", "IDLE|WALK or IDLE|WALK or IDLE, 2 sec|G(WALK or IDLE, 2 sec)"),
        ("IDLE\nA or B¦ or C\n", "B|A or B|A or B or C"),
        ("IDLE\nnot (WA¦LK)\n", "WALK|(WALK)|not (WALK)"),
        ("IDLE\nlet G(x¦) = x\n", "x|let G(x) = x"),
        ("IDLE\n# some wo¦rds\n", "# some words"),
        ("IDLE\nWALK with wi¦th TALK\n", "with|WALK with with TALK"),
        ("¦", ""),
    ],
)
def test_a_selection_grows_from_the_word_to_the_command(text: str, expected: str) -> None:
    said = expected.split("|") if expected else []
    assert selected(text) == [one.replace("{}", said[at - 1]) for at, one in enumerate(said)]


def test_it_grows_over_blocks_and_branches() -> None:
    text = "choose {\n  IDLE\n  WA¦LK\n| repeat 2 { TALK }\n}\n"
    whole = text.replace("¦", "").rstrip()
    assert selected(text) == ["WALK", "IDLE\n  WALK", whole.removeprefix("choose {")[:-1], whole]


def test_a_block_that_is_not_closed_is_selected_up_to_its_last_statement() -> None:
    assert selected("TALK\nrepeat 2 {\n  IDLE\n  WA¦LK") == ["WALK", "\n  IDLE\n  WALK", "repeat 2 {\n  IDLE\n  WALK"]


@given(TEXTS, st.integers(-2, 90))
def test_in_any_text_each_stretch_holds_the_one_before_it_and_is_larger(text: str, offset: int) -> None:
    spans = selection(analyse(Source(text)), offset)
    assert spans[-1] == Span(0, len(text))
    for inner, outer in pairwise(spans):
        assert outer.start <= inner.start <= inner.end <= outer.end
        assert inner != outer
    assert all(span.start <= max(0, min(offset, len(text))) <= span.end for span in spans)


@given(TEXTS, TEXTS, TEXTS, st.integers(0, 160))
def test_after_an_edit_it_is_that_of_the_text_afresh(before: str, new: str, after: str, offset: int) -> None:
    edited = analyse_again(analyse(Source(f"{before}\n{after}")), Source(f"{before}\n{new}\n{after}"))
    assert selection(edited, offset) == selection(analyse(edited.source), offset)
