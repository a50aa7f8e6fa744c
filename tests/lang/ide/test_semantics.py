"""What the tokens of a script are to a reader: `ide.semantics`."""

from collections.abc import Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.semantics import paint
from mlmg_lang.source import Source, Span

TEXTS = st.text(alphabet='let WALK(x)=x\nfor{}|;:"\\#1. sec走 with Sub ', max_size=80)


def marked(text: str, library: Catalog | None) -> list[str]:
    """Return each marked stretch with what it is; `+` where it is declared."""
    return [
        f"{text[mark.span.start : mark.span.end]} {mark.kind}{'+' * mark.declaration}"
        for mark in paint(analyse(Source(text), library)).marks()
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK", ["WALK tag"]),
        ("Walk_01", ["Walk_01 motion"]),
        ("walk01", ["walk01 motion"]),
        ('"Walk_01"', ['"Walk_01" motion']),
        ("WLAK", ["WLAK name"]),
        ("Upper-Body", ["Upper-Body graph"]),
        ("Upper-Body TALK", ["Upper-Body graph", "TALK tag"]),
        ("WALK with Sub TALK", ["WALK tag", "with keyword", "Sub graph", "TALK tag"]),
        ("Lower-Body TALK", ["Lower-Body graph", "TALK tag"]),
        ("Upper-Body (TALK)", ["Upper-Body graph", "TALK tag"]),
        ("WALK for 10sec # so", ["WALK tag", "for keyword", "10 number", "sec unit", "# so comment"]),
        ("sec", ["sec name"]),
        ("end Upper-Body", ["end keyword", "Upper-Body graph"]),
        ("repeat 2 { IDLE }", ["repeat keyword", "2 number", "IDLE tag"]),
        ('use "a.ms"\nWLAK', ["use keyword", '"a.ms" string', "WLAK name"]),
        ("facing", ["facing keyword"]),
        ('WALK "x', ["WALK tag", '"x string']),
        ("let GO = WALK\nGO", ["let keyword", "GO definition+", "WALK tag", "GO definition"]),
        (
            "let G(x, t = 2 sec) = x with Upper-Body WAVE_HAND for t\nG(WALK, t = 1 sec)\nx",
            [
                *("let keyword", "G definition+", "x parameter+", "t parameter+", "2 number", "sec unit"),
                *("x parameter", "with keyword", "Upper-Body graph", "WAVE_HAND tag", "for keyword", "t parameter"),
                *("G definition", "WALK tag", "t parameter", "1 number", "sec unit", "x name"),
            ],
        ),
        ("let G(x, ) = x with", ["let keyword", "G definition+", "x parameter+", "x parameter", "with keyword"]),
    ],
)
def test_a_name_is_marked_for_what_it_means(text: str, expected: list[str], reference: Catalog) -> None:
    assert marked(text, reference) == expected


def test_without_a_library_names_are_marked_for_their_place_alone() -> None:
    expected = ["Hand graph", "WAVE name", "and keyword", "F definition", "x name"]
    assert marked("Hand WAVE and F(x)", None) == expected


@given(TEXTS)
def test_marks_stand_in_the_order_of_any_text_and_do_not_overlap(left_hand_always: Catalog, text: str) -> None:
    marks = list(paint(analyse(Source(text), left_hand_always)).marks())
    ends = [0, *(mark.span.end for mark in marks)]
    assert all(end <= mark.span.start < mark.span.end for end, mark in zip(ends, marks, strict=False))
    assert ends[-1] <= len(text)


@given(TEXTS, st.integers(0, 80), st.integers(0, 80))
def test_those_of_a_range_are_those_that_touch_it(left_hand_always: Catalog, text: str, one: int, other: int) -> None:
    painting = paint(analyse(Source(text), left_hand_always))
    span = Span(min(one, other), max(one, other))
    touching = [mark for mark in painting.marks() if mark.span.start < span.end and mark.span.end > span.start]
    assert list(painting.within(span)) == touching


@given(st.lists(TEXTS, min_size=2, max_size=4))
def test_a_painting_after_edits_is_that_of_the_text_afresh(left_hand_always: Catalog, texts: list[str]) -> None:
    whole = "\n".join(texts)
    analysis = analyse(Source(whole), left_hand_always)
    painting = paint(analysis)
    for n in range(len(texts)):
        text = "\n".join(texts[n:])
        analysis = analyse_again(analysis, Source(text))
        painting = paint(analysis, painting)
        assert list(painting.marks()) == list(paint(analyse(Source(text), left_hand_always)).marks())


def test_lines_that_an_edit_leaves_alone_are_not_looked_at_again(reference: Catalog) -> None:
    before = analyse(Source("WALK\nIDLE\nGO\nTALK\n"), reference)
    painting = paint(before)
    after = paint(analyse_again(before, Source("WALK\nlet GO = IDLE\nGO\nTALK\n")), painting)
    kept = [any(part is one for one in painting.parts) for part in after.parts]
    assert kept == [True, False, False, True]


def test_another_library_means_another_painting(libraries: Mapping[str, Catalog | None]) -> None:
    text = Source("Left-Hand WAVE")
    painting = paint(analyse(text, libraries["reference"]))
    assert [mark.kind for mark in painting.marks()] == ["graph", "name"]
    again = paint(analyse(text, libraries["left-hand"]), painting)
    assert [mark.kind for mark in again.marks()] == ["graph", "tag"]
