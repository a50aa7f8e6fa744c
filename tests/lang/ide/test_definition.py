"""A name leads to where it gets its meaning."""

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.front_end import analyse_again
from mlmg_lang.ide.definition import definition
from mlmg_lang.ide.links import document_links, paths_in, use_leading_to
from mlmg_lang.ide.occurrences import Place
from mlmg_lang.source import Source, Span

Marked = Callable[..., Any]
GESTURES = "let GREET(who, t = 2 sec) = who with Upper-Body WAVE_HAND for t\nlet 走路 = WALK\n"


@pytest.fixture
def leads(marked: Marked) -> Callable[..., list[tuple[str, int]]]:
    """Return a function: a text with a cursor -> the files and offsets that its name leads to."""

    def ask(text: str, **files: str) -> list[tuple[str, int]]:
        at = marked(text, **files)
        found = definition(at.analysis, at.offset)
        return [] if found is None else [(place.file, place.span.start) for place in found.places]

    return ask


@pytest.mark.parametrize("use", ["¦STROLL", "STR¦OLL", "STROLL¦", "STROLL¦;", "(STROLL¦)", "repeat 2 { STROLL¦ }"])
def test_a_definition_is_found_from_any_letter_of_its_name_and_from_its_end(leads, use):
    assert leads(f"let STROLL = WALK\n{use}") == [("main.ms", 4)]


def test_a_definition_may_stand_after_its_use_and_leads_to_itself(leads):
    assert leads("¦G\nlet G = WALK") == [("main.ms", 6)]
    assert leads("G\nlet ¦G = WALK") == [("main.ms", 6)]


def test_a_parameter_is_found_from_its_uses_and_from_its_label(leads):
    text = "let G(x, t = 1 sec) = x with Upper-Body TALK for t\nG(x = WALK, t = 2 sec)"
    for use in ("= ¦x with", "for ¦t", "G(¦x = ", ", ¦t = 2"):
        plain = use.replace("¦", "")
        assert leads(text.replace(plain, use)) == [("main.ms", text.index("x" if "x" in use else "t = 1"))], use


def test_a_parameter_hides_a_definition_but_not_in_a_default(leads):
    assert leads("let x = IDLE\nlet G(x = WALK) = ¦x\nG") == [("main.ms", 19)]
    assert leads("let x = IDLE\nlet G(x = ¦x) = x\nG") == [("main.ms", 4)]


def test_a_name_of_a_used_file_leads_into_that(leads):
    assert leads('use "g.ms"\n😀\n走路¦', g=GESTURES) == [("g.ms", GESTURES.index("走路"))]
    assert leads('use "g.ms"\nGREET(¦who = WALK)', g=GESTURES) == [("g.ms", GESTURES.index("who"))]


def test_a_used_file_is_found_and_one_that_is_not_there_leads_nowhere(leads):
    assert leads('use "¦g.ms"', g=GESTURES) == [("g.ms", 0)]
    assert leads('use "¦h.ms"', g=GESTURES) == []


def test_a_name_in_a_used_file_is_asked_for_behind_the_script(marked):
    at = marked('use "g.ms"\nHI\n', g='use "h.ms"\nlet HI = BYE', h="let BYE = WALK")
    source = at.analysis.source
    for written, there in (("BYE", ("h.ms", 4)), ('"h.ms"', ("h.ms", 0))):
        offset = source.base(source.used[0]) + source.used[0].text.index(written)
        found = definition(at.analysis, offset)
        assert found is not None
        assert [(place.file, place.span.start) for place in found.places] == [there]
        assert found.span == Span(offset, offset + len(written))


@pytest.mark.parametrize("text", ["¦", "WALK ¦ WALK", "# ¦G\nlet G = WALK\nG", "¦WALK", "¦NOTHING", "WALK for 1¦0 sec"])
def test_other_places_lead_nowhere(leads, text):
    assert leads(text) == []


def test_names_in_statements_that_cannot_be_read_are_found_too(leads):
    assert leads("let G = WALK\nG for G ¦G") == [("main.ms", 4)]
    assert leads("let G(x) = x\nG(WALK, ¦G") == [("main.ms", 4)]
    assert leads('let "a b" = WALK\nrepeat 2 {\n"a ¦b" with\n') == [("main.ms", 4)]


def test_names_that_are_spelt_in_two_ways_of_unicode_are_the_same(leads):
    assert leads("let e\u0301te\u0301 = WALK\n¦\u00e9t\u00e9") == [("main.ms", 4)]


def test_of_a_definition_that_stands_twice_the_first_is_meant(leads):
    assert leads("let G = WALK\nlet G = IDLE\n¦G") == [("main.ms", 4)]


def test_a_parameter_of_a_definition_that_stands_twice_leads_somewhere(leads):
    assert leads("let G = WALK\nlet G(¦x) = x\nG") == [("main.ms", 19)]


def test_after_an_edit_places_are_those_of_the_text_now(marked):
    at = marked('use "g.ms"\nIDLE\n走路\n', g=GESTURES)
    again = analyse_again(at.analysis, Source('use "g.ms"\nIDLE\nIDLE\n走路\n', "main.ms"))
    found = definition(again, len('use "g.ms"\nIDLE\nIDLE\n'))
    assert found is not None
    assert found.places == (Place("g.ms", Span(GESTURES.index("走路"), GESTURES.index("走路") + 2)),)
    used = again.source.used[0]
    inside = again.source.base(used) + GESTURES.index("who with")
    assert definition(again, inside).places[0].span.start == GESTURES.index("who")


class Built:
    """A library whose files are known."""

    def motion(self, motion: str) -> Place:
        return Place(f"{motion}.bvh", Span(0, 0))

    def tag(self, tag: str, graph: str | None) -> tuple[Place, ...]:
        return (Place(f"library.toml of {graph}", Span(3, 7)),)

    def graph(self, graph: str) -> None:
        return None


def test_names_of_a_library_lead_to_what_it_was_built_from(marked):
    def places(text: str) -> list[str]:
        at = marked(text)
        found = definition(at.analysis, at.offset, Built())
        return [] if found is None else [place.file for place in found.places]

    assert places("¦walk01") == ["Walk_01.bvh"]
    assert places("¦WALK") == ["library.toml of Full-Body"]
    for text in (
        "WALK with Upper-Body ¦TALK",
        "WALK with Upper-Body (¦TALK or not WAVE_HAND)",
        "repeat 2 { Upper-Body ¦TALK }",
        "let G = WALK with Sub (¦TALK)\nG",
    ):
        assert places(text) == ["library.toml of Upper-Body"]
    assert places("HM with Upper-Body ¦TALK") == ["library.toml of None"]
    assert places("¦Upper-Body TALK") == []


def test_links_are_the_paths_that_lead_to_files(marked):
    at = marked('use "g.ms"\nuse "none.ms"\nWALK\nuse "h.ms"\n', g="let A = WALK", h='use "i.ms"', i="")
    links = document_links(at.analysis)
    assert [(at.analysis.source.slice(link.span), link.file) for link in links] == [
        ('"g.ms"', "g.ms"),
        ('"h.ms"', "h.ms"),
    ]


def test_the_use_that_leads_to_a_file_is_known_be_it_by_way_of_others(marked: Callable[..., Any]) -> None:
    files = {"fine": "let a = WALK\n", "more": 'use "deep.ms"\n', "deep": "let b = WALK\n"}
    analysis = marked('use "fine.ms"\n\nuse "more.ms"\na\nb\n', **files).analysis
    found = {name: use_leading_to(analysis, f"{name}.ms") for name in (*files, "none")}
    said = {name: span and analysis.source.slice(span) for name, span in found.items()}
    assert said == {"fine": '"fine.ms"', "more": '"more.ms"', "deep": '"more.ms"', "none": None}


def test_what_a_text_may_use_is_found_without_reading_it():
    assert paths_in('use "a.ms"\nUSE "b \\"c\\".ms" # use "d.ms"\n"x y" "open\n') == ("a.ms", 'b "c".ms', "d.ms", "x y")
    assert paths_in('"x y" for 2 sec\n') == ()
