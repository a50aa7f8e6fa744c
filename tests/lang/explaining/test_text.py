"""An explanation as text: what a person reads, however odd what it tells of."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.explaining.text import render_text
from mlmg_lang.explaining.tree import Tree, n_columns, table, tree_lines
from mlmg_lang.explaining.wording import seconds, share
from mlmg_lang.planning.estimate import Estimate, exactly
from mlmg_lang.rendering.colour import Painter

ESCAPE = re.compile(r"\x1b\[[\d;]*m")
PLAIN = Painter(False)


def test_the_first_line_sums_up(explained):
    first = render_text(explained("Idle_01 for 2 sec\nwait 1 sec\nrepeat 2 { WALK for 1 sec }")).splitlines()[0]
    assert re.fullmatch(r"script\.ms: 2 commands from Idle_01 on, about [\d.]+ s \([\d.]+ to [\d.]+\)", first)


def test_colours_change_nothing_but_colour(explained):
    told = explained("IDLE for 2 sec\nSWING_HAND for 1 sec\nWALK and TALK for 1 sec")
    coloured = render_text(told, colour=True)
    assert "\x1b[" in coloured
    assert ESCAPE.sub("", coloured) == render_text(told)


@pytest.mark.parametrize("width", [40, 60, 100])
def test_lines_keep_to_the_width(explained, width):
    told = explained("IDLE for 2 sec\nchoose { WALK with Sub TALK with Left-Hand WAVE | repeat 2 { not IDLE } }\nWALK")
    lines = render_text(told, width).splitlines()
    # A row of a table or a long name has no place to be broken within so few columns.
    assert all(n_columns(line) <= width for line in lines if " -> " not in line), max(lines, key=n_columns)


def test_nothing_is_cut_where_lines_are_broken(explained):
    told = explained("IDLE for 2 sec\nWALK with Sub TALK with Left-Hand WAVE\nWALK")
    words = [re.sub(r"[│├└─]", " ", text).split() for text in (render_text(told, 50), render_text(told, 1000))]
    assert words[0] == words[1]


@given(data=st.data())
def test_any_explanation_can_be_told(data, explanations):
    told = data.draw(explanations)
    text = render_text(told, colour=data.draw(st.booleans()))
    assert text.endswith("\n")
    assert not re.search(r"[\x00-\x09\x0b-\x1a\x1c-\x1f\x7f-\x9f]", text), "nothing that a terminal acts upon"


def test_of_very_many_candidates_the_first_are_told_and_the_others_counted(catalog_of_many, explained):
    told = explained("Start\nALL for 1 sec", catalog_of_many)
    text = render_text(told)
    assert "20.  " in text
    assert "21.  " not in text
    assert "and 10 more, one of which is taken in 0%" in text


@pytest.fixture
def catalog_of_many(made_library):
    """Return a library with a tag of thirty motions."""
    from dataclasses import replace

    import numpy as np

    from mlmg_runtime.motion_graph import TRANSITION

    n = 31
    rows = [(0, 20, b, 12 + b, 0.1, 0.1) for b in range(1, n)] + [(b, 60, 0, 20, 0.1, 0.1) for b in range(1, n)]
    names = ("Start", *(f"M_{at:02}" for at in range(1, n)))
    root = replace(
        made_library.root,
        motions=names,
        tags={name: ("ALL",) if name != "Start" else () for name in names},
        n_frames=np.full(n, 100),
        transitions=np.array(rows, dtype=TRANSITION),
        oms=np.ones((n, n)),
        hops=np.where(np.eye(n, dtype=bool), 0, 2),
    )
    return replace(made_library, by_name={root.name: root}, start="Start")


def test_an_estimate_that_is_known_is_told_without_a_range():
    assert seconds(exactly(2.0)) == "2.0 s"
    assert seconds(Estimate(2.0, 1.96, 2.04)) == "2.0 s"
    assert seconds(Estimate(2.0, 1.0, 3.25)) == "about 2.0 s (1.0 to 3.2)"


@pytest.mark.parametrize(
    ("chance", "expected"), [(0.0, "0%"), (0.001, "under 1%"), (0.5, "50%"), (0.999, "over 99%"), (1.0, "100%")]
)
def test_a_chance_that_is_not_quite_nothing_or_everything_does_not_look_like_it(chance, expected):
    assert share(chance) == expected


# --- trees ---


def lines(tree: Tree, width: int = 100) -> list[str]:
    return list(tree_lines(tree, width, PLAIN))


def test_a_tree_is_drawn_with_its_branches():
    tree = Tree("a", "b", (Tree("c", children=(Tree("d"),)), Tree("e", "f")))
    assert lines(tree) == ["a: b", "├─ c", "│  └─ d", "└─ e: f"]


def test_of_two_equal_branches_the_last_is_drawn_as_the_last():
    same = Tree("x")
    assert lines(Tree("a", children=(same, Tree("x")))) == ["a", "├─ x", "└─ x"]
    assert lines(Tree("a", children=(same, same))) == ["a", "├─ x", "└─ x"]


def test_a_broken_line_goes_on_beside_its_branches():
    tree = Tree("a", "one two three four five six", (Tree("c"),))
    assert lines(tree, 24) == ["a: one two three four", "│  five six", "└─ c"]
    assert lines(Tree("", children=(tree,)), 28)[2] == "   │  five six"


def test_wide_characters_take_two_columns():
    assert table([("走路", "a"), ("xy", "b")]) == ["走路  a", "xy    b"]


def test_a_column_that_is_empty_takes_no_room():
    assert table([("a", "", "b"), ("c", "", "d")]) == ["a  b", "c  d"]
