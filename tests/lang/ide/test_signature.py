"""Between the parentheses of a definition's use it is told what that takes."""

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.front_end import analyse_again
from mlmg_lang.ide.signature import SignatureHelp, signature_help
from mlmg_lang.source import Source

LETS = "let GREET(x, t = 2 sec) = x with Upper-Body WAVE_HAND for t\nlet BOTH(a, b = WALK or\n IDLE) = a or b\n"
Ask = Callable[..., SignatureHelp | None]


@pytest.fixture
def helps(marked: Callable[..., Any]) -> Ask:
    """Return a function: a text with a cursor, after some definitions -> what it is helped with."""

    def ask(text: str, before: str = LETS, **files: str) -> SignatureHelp | None:
        at = marked(before + text, **files)
        return signature_help(at.analysis, at.offset)

    return ask


@pytest.mark.parametrize(
    ("text", "active"),
    [
        *(("GREET(¦", 0), ("GREET(¦)", 0), ("GREET(WALK¦", 0), ("GREET(WALK,¦", 1), ("GREET(WALK, ¦)", 1)),
        *(("GREET (WALK\n, ¦)", 1), ("GREET(t = 1 sec, x = ¦", 0), ("GREET(t =¦", 1), ("GREET(WALK, 1 sec, ¦", None)),
        *(("GREET(no = ¦", None), ("GREET((WALK, ¦", 0), ("GREET((WALK or TALK), ¦)", 1), ("WALK and GREET(¦", 0)),
        *(("GREET(IDLE # (, ,\n, ¦)", 1), ("repeat 2 { GREET(IDLE, ¦ }", 1), ("IDLE for for GREET(¦", 0)),
        *(("GREET(t = 1 sec, ¦)", 0), ("GREET(x = WALK, ¦", 1), ("GREET(WALK, t = 1 sec, ¦", None)),
        *(("GREET(no = 1, ¦", 0), ("GREET(t = 1 sec, WALK, ¦", None)),
        *(("GREET(\n¦WALK\n", 0), ("GREET(WALK,\n¦\nwait 1 sec", 1)),
        *(("GREET(Upper-Body (TALK ¦", 0), ("GREET(BOTH(WALK, IDLE), ¦", 1), ('"GREET"(¦', 0)),
    ],
)
def test_the_parameter_is_told_that_is_being_written(helps, text, active):
    found = helps(text)
    assert found is not None
    assert found.label == "GREET(x, t = 2 sec)"
    assert found.active == active


@pytest.mark.parametrize(
    "text",
    [
        *("¦GREET()", "GREET¦()", "GREET()¦", "GREET(WALK); ¦", "(¦", "WALK(¦", "Upper-Body (¦", ""),
        *("GREET(WALK\n}\n¦", "# GREET(¦", "let NEW(¦", "let GREET(¦x) = x", "LONE(¦"),
    ],
)
def test_elsewhere_there_is_no_help(helps, text):
    assert helps(text if "¦" in text else "¦", LETS + "let LONE = WALK\n") is None


def test_the_label_is_what_is_written_on_one_line_and_parameters_have_their_place_in_it(helps):
    found = helps("BOTH(¦")
    assert found is not None
    assert found.label == "BOTH(a, b = WALK or IDLE)"
    assert [found.label[one.start : one.end] for one in found.parameters] == ["a", "b = WALK or IDLE"]
    assert [one.says for one in found.parameters] == ["a motion", "a motion"]
    greet = helps("GREET(¦")
    assert greet is not None
    assert [one.says for one in greet.parameters] == ["a motion", "a duration"]


def test_the_innermost_definition_is_told(helps):
    found = helps("GREET(BOTH(WALK, ¦")
    assert found is not None
    assert (found.label[:4], found.active) == ("BOTH", 1)


def test_a_definition_of_a_used_file_is_told_and_asked_for_in_that(helps, marked):
    found = helps("走(IDLE, ¦", 'use "g.ms"\n', g="let 走(x, y) = x or y")
    assert found is not None
    assert (found.label, found.active) == ("走(x, y)", 1)
    at = marked('use "g.ms"\nA', g="let A = 走(IDLE, WALK)\nlet 走(x, y) = x or y")
    file = at.analysis.source.used[0]
    inside = signature_help(at.analysis, at.analysis.source.base(file) + file.text.index("WALK"))
    assert inside is not None
    assert inside.active == 1


def test_definitions_with_mistakes_are_told_without_kinds(helps):
    found = helps("A(¦", "let A(x) = B(x)\nlet B(x) = A(x)\n")
    assert found is not None
    assert [one.says for one in found.parameters] == [""]


def test_after_an_edit_the_place_is_that_of_the_text_now(marked):
    at = marked(f"{LETS}IDLE\nGREET(WALK, 1 sec)\n")
    text = f"{LETS}IDLE\nIDLE\nGREET(WALK, \n"
    found = signature_help(analyse_again(at.analysis, Source(text, "main.ms")), len(text) - 1)
    assert found is not None
    assert (found.label, found.active) == ("GREET(x, t = 2 sec)", 1)
