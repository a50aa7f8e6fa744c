"""All places are found where the same thing is named, and no others."""

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.ide.references import highlights, home_at, references

Marked = Callable[..., Any]


@pytest.fixture
def found(marked: Marked) -> Callable[..., list[tuple[str, int, str]]]:
    """Return a function: a text with a cursor -> file, offset and text of all references."""

    def ask(text: str, **how: Any) -> list[tuple[str, int, str]]:
        at = marked(text, **how)
        return [(place.file, place.span.start, at.written(place)) for place in references(at.analysis, at.offset)]

    return ask


def test_a_definition_is_among_its_references_and_comments_and_hidden_names_are_not(found):
    text = 'let ¦G = WALK # G\nG; "G"\nlet H(G) = G\nrepeat 2 { G with # G\n Upper-Body TALK }\nH(G) for 1 sec\n'
    plain = text.replace("¦", "")
    inside = plain.index("{ G") + 2, plain.index("H(G) for") + 2
    assert found(text) == [("main.ms", at, plain[at:end]) for at, end in ((4, 5), (17, 18), (20, 23))] + [
        ("main.ms", at, "G") for at in inside
    ]


def test_declarations_can_be_left_out(marked):
    at = marked("let ¦G = WALK\nG")
    assert [place.span.start for place in references(at.analysis, at.offset, declarations=False)] == [13]


def test_a_parameter_has_its_labels_with_it(found):
    text = "let G(¦x, t = 1 sec) = x or x for t\nG(x = WALK)\nlet H(x) = x\nG(IDLE)\nH(x = IDLE)\n"
    assert [text.replace("¦", "")[at - 2 : at + 1] for _, at, _ in found(text)] == ["G(x", "= x", "r x", "G(x"]


def test_references_in_used_files_are_found_from_either_side(found):
    used = {"g": 'let HI = BYE\nlet BYE = "HI"\n', "h": "let ALSO = HI\n"}
    expected = [("main.ms", 22, "HI"), ("g.ms", 4, "HI"), ("g.ms", 23, '"HI"'), ("h.ms", 11, "HI")]
    assert found('use "g.ms"\nuse "h.ms"\n¦HI\n', **used) == expected


def test_other_scripts_are_asked_that_use_the_same_file(marked):
    one = marked('use "g.ms"\n¦HI\n', g="let HI = WALK")
    same = marked('use "g.ms"\nIDLE\nHI\n', name="other.ms", g="let HI = WALK").analysis
    foreign = marked("let HI = IDLE\nHI\n", name="foreign.ms").analysis
    places = references(one.analysis, one.offset, (same, foreign))
    assert [(place.file, place.span.start) for place in places] == [("main.ms", 11), ("g.ms", 4), ("other.ms", 16)]


def test_the_file_is_known_that_defines_a_name(marked):
    files = {"g": "let HI(x) = x"}
    for text, home in (("¦HI(WALK)", "g.ms"), ("HI(WALK, ¦x = IDLE)", "g.ms"), ("let A = B\nlet ¦B = WALK", "main.ms")):
        at = marked(f'use "g.ms"\n{text}', **files)
        assert home_at(at.analysis, at.offset) == home
    for text in ("¦WALK", "# ¦HI", "¦HM", 'use "¦g.ms"'):
        at = marked(text, **files)
        assert home_at(at.analysis, at.offset) is None


def test_the_names_of_a_library_are_found_however_they_are_spelt(found):
    text = '¦Walk_01\nwalk01\n"WALK-01" with Upper-Body Talk_01\n# Walk_01\nlet A = Walk_01\nA'
    assert [word for _, _, word in found(text)] == ["Walk_01", "walk01", '"WALK-01"', "Walk_01"]
    assert [word for _, _, word in found("end ¦Upper-Body\nupper_body (TALK)\nUpper-Body TALK")] == [
        "Upper-Body",
        "upper_body",
        "Upper-Body",
    ]


def test_letters_of_several_code_points_are_found(found, catalog):
    odd = catalog({"Body": {"straße": (), "\u00e9t\u00e9": ()}}, {}, start="straße")
    assert [word for _, _, word in found("¦straße\nSTRASSE\n", library=odd)] == ["straße", "STRASSE"]
    assert len(found("¦\u00e9t\u00e9\ne\u0301te\u0301\n", library=odd)) == 2


def test_names_with_quotes_in_them_are_found(found):
    text = 'let ¦"a \\"b\\" \\\\" = WALK\n"a \\"b\\" \\\\"\n'
    assert [word for _, _, word in found(text)] == ['"a \\"b\\" \\\\"'] * 2


def test_without_a_library_names_are_found_by_their_spelling(found):
    assert [at for _, at, _ in found("let G = WALK\nG\n¦G", library=None)] == [4, 13, 15]
    assert found("¦WALK\nWALK", library=None) == []


def test_highlights_are_those_of_the_same_file(marked):
    at = marked('use "g.ms"\n¦HI\nHI', g="let HI = HI2\nlet HI2 = WALK\n")
    source = at.analysis.source
    assert [(source.slice(one.span), one.span.start) for one in highlights(at.analysis, at.offset)] == [
        ("HI", 11),
        ("HI", 14),
    ]
    base = source.base(source.used[0])
    inside = highlights(at.analysis, base + 4)
    assert [(one.span.start - base, one.declares) for one in inside] == [(4, True)]


def test_highlights_of_names_that_mean_nothing_are_those_of_the_same_spelling(marked):
    at = marked("¦HM\nHM\nHMM")
    assert [one.span.start for one in highlights(at.analysis, at.offset)] == [0, 3]


@pytest.mark.parametrize(
    "text", ["", "let", "G (", "let G(x = ", "use", 'use "', "repeat 2 { G ", '"', "}", "choose {|"]
)
def test_whatever_the_text_something_or_nothing_is_found_at_each_offset(text, reference):
    from mlmg_lang.source import Source

    analysis = analyse(Source(f"let G = WALK\n{text}"), reference)
    for offset in range(len(analysis.source.text) + 1):
        places = references(analysis, offset)
        assert all(place.span.end <= len(analysis.source.text) for place in places)
        assert bool(highlights(analysis, offset)) >= bool(places)
