"""Railroad diagrams: all words of a rule are on them, each inside its box, and all boxes on the picture."""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree import ElementTree

import pytest

from mlmg_grammar import grammar_text
from mlmg_grammar.definitions import Definition, definitions
from mlmg_grammar.expressions import Choice, Optional, Pattern, Repeat, Sequence, Symbol, Text, walk
from mlmg_grammar.railroad import railroad
from mlmg_grammar.readable import readable

RULES = [one for section in readable(grammar_text()) for one in section.definitions if one.name.islower()]
SVG = "{http://www.w3.org/2000/svg}"
Box = tuple[float, float, float, float]


def drawn(picture: str) -> Iterator[tuple[str, Box]]:
    """Yield the words on a picture with their boxes: left, top, right, bottom."""
    yield from _inside(ElementTree.fromstring(picture), 0, 0)


def _inside(node: ElementTree.Element, x: float, y: float) -> Iterator[tuple[str, Box]]:
    moved = re.fullmatch(r"translate\((\d+) (\d+)\)", node.get("transform", ""))
    if moved:
        x, y = x + int(moved[1]), y + int(moved[2])
    for box, text in zip(list(node), list(node)[1:], strict=False):
        if box.tag == f"{SVG}rect" and text.tag == f"{SVG}text":
            left, top = x + float(box.get("x", "")), y + float(box.get("y", ""))
            yield text.text or "", (left, top, left + float(box.get("width", "")), top + float(box.get("height", "")))
    for child in node:
        yield from _inside(child, x, y)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_all_words_of_a_rule_are_on_its_picture(rule: Definition) -> None:
    words = [part for part in walk(rule.expression) if isinstance(part, Symbol | Text)]
    assert sorted(word for word, _ in drawn(railroad(rule))) == sorted(
        word.name if isinstance(word, Symbol) else word.text for word in words
    )


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_no_box_covers_another_or_leaves_the_picture(rule: Definition) -> None:
    picture = railroad(rule)
    whole = ElementTree.fromstring(picture)
    boxes = [box for _, box in drawn(picture)]
    for at, (left, top, right, bottom) in enumerate(boxes):
        assert 0 < left < right < float(whole.get("width", ""))
        assert 0 < top < bottom < float(whole.get("height", ""))
        for other in boxes[:at]:
            assert right <= other[0] or other[2] <= left or bottom <= other[1] or other[3] <= top


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_a_box_has_room_for_its_word(rule: Definition) -> None:
    for word, (left, _, right, _) in drawn(railroad(rule)):
        assert right - left >= 8.5 * len(word) + 10


A, B = Symbol("a"), Text("b")


@pytest.mark.parametrize(
    ("expression", "ordered"),
    [
        (Sequence((A, B)), "right"),
        (Choice((A, B)), "below"),
        (Repeat(A, B), "below"),
        (Sequence((Optional(A), Repeat(B))), "right"),
    ],
)
def test_what_follows_stands_to_the_right_and_what_may_stand_instead_below(expression: object, ordered: str) -> None:
    picture = railroad(Definition("x", expression))  # type: ignore[arg-type]
    (_, first), (_, second) = drawn(picture)
    assert (first[2] < second[0]) if ordered == "right" else (first[3] < second[1])


def test_what_words_mean_to_svg_does_not_matter() -> None:
    ((word, _),) = drawn(railroad(Definition("x", Pattern('<&">'))))
    assert word == '/<&">/'


def test_a_picture_has_colours_for_dark_pages_and_says_the_rule_to_those_who_cannot_see_it() -> None:
    picture = railroad(Definition("x", Sequence((A, B))))
    assert "prefers-color-scheme:dark" in picture
    assert "<title>x = a &quot;b&quot;</title>" in picture


def test_pictures_are_made_of_rules_alone() -> None:
    assert {rule.name for rule in RULES} < {name.lstrip("_") for name in definitions(grammar_text())}
