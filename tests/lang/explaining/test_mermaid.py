"""The flowchart: every arrow leads from a box to a box, and no text can end a label."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.explaining.mermaid import escaped, render_mermaid

LABEL = r'"[^"\n]*"'
BOX = re.compile(rf"(s\d+)(?:\(\[{LABEL}\]\)|\[{LABEL}\]|\{{\{{{LABEL}\}}\}}|\{{{LABEL}\}})")
ARROW = re.compile(rf"(s\d+) -->(?:\|({LABEL})\|)? (s\d+)")
GROUP = re.compile(rf"subgraph (g\d+)\[{LABEL}\]")


def parts(chart: str) -> tuple[list[str], list[tuple[str, str]]]:
    """Return the boxes of a chart and its arrows; fail where a line is none of what a chart is made of."""
    first, *lines = chart.splitlines()
    assert first == "flowchart TD"
    boxes, arrows, depth = [], [], 0
    for line in map(str.strip, lines):
        if box := BOX.fullmatch(line):
            boxes.append(box[1])
        elif arrow := ARROW.fullmatch(line):
            arrows.append((arrow[1], arrow[3]))
        else:
            depth += 1 if GROUP.fullmatch(line) else -1
            assert line == "end" or GROUP.fullmatch(line), line
            assert depth >= 0
    assert depth == 0
    return boxes, arrows


def check(chart: str) -> None:
    boxes, arrows = parts(chart)
    assert len(set(boxes)) == len(boxes)
    assert {box for arrow in arrows for box in arrow} <= set(boxes)
    assert {target for _, target in arrows} >= set(boxes[1:]), "every box but the first is led to"


@given(data=st.data())
def test_any_explanation_gives_a_chart(data, explanations):
    check(render_mermaid(data.draw(explanations)))


def test_statements_stand_one_after_the_other(explained):
    boxes, arrows = parts(render_mermaid(explained("IDLE for 1 sec\nWALK\nTALK")))
    assert arrows == [("s0", "s1"), ("s1", "s2"), ("s2", "s3"), ("s3", "s4")]
    assert len(boxes) == 5


def test_a_loop_leads_back_to_its_beginning_and_on(explained):
    _, arrows = parts(render_mermaid(explained("repeat 2 { WALK; TALK }\nIDLE")))
    assert arrows == [("s1", "s2"), ("s2", "s3"), ("s3", "s1"), ("s0", "s1"), ("s3", "s4"), ("s4", "s5")]


def test_the_branches_of_a_choice_meet_again(explained):
    chart = render_mermaid(explained("choose { WALK | 3: TALK | }\nIDLE"))
    _, arrows = parts(chart)
    assert arrows == [
        *[("s1", "s2"), ("s1", "s3"), ("s0", "s1")],
        *[("s2", "s4"), ("s3", "s4"), ("s1", "s4"), ("s4", "s5")],
    ]
    assert '-->|"60%"|' in chart


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK_01 for 1.5 sec (50%)", "WALK_01 for 1.5 sec (50%)"),
        ('a "b"', "a #34;b#34;"),
        ("#35; <br/> `x`", "#35;35#59; #60;br/#62; #96;x#96;"),
        ("__x__ *y* [z]", "#95;#95;x#95;#95; #42;y#42; #91;z#93;"),
        ("\\n $$", "#92;\u200bn #36;\u200b#36;\u200b"),
        ("走路 😀", "走路 😀"),
    ],
)
def test_a_label_says_what_is_meant_and_nothing_that_acts(text, expected):
    assert escaped(text) == expected
