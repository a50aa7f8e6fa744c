"""What there is to say of what stands at a place."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pytest

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.hover import Hover, hover, hover_mistakes
from mlmg_lang.ide.markdown import code
from mlmg_lang.ide.words import UNIT_SAYS, WORDS
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.source import Source, Span

Says = Callable[..., list[str]]


class Bones:
    """A library of whose graphs more is known than names."""

    def joints(self, graph: str) -> Sequence[str]:
        return {"Upper-Body": ("Spine", "Head")}.get(graph, tuple(f"Joint_{at}" for at in range(12)))

    def transitions(self, graph: str, motion: str) -> Mapping[str, int]:
        return {"Walk_02": 1, "Talk_01": 3, "Idle_01": 0} if motion == "Walk_01" else {}


@pytest.fixture
def found(marked: Callable[..., Any]) -> Callable[..., Hover | None]:
    """Return a function: a text with a cursor -> what is said there."""

    def ask(text: str, **how: Any) -> Hover | None:
        at = marked(text, **how)
        return hover(at.analysis, at.offset, Bones())

    return ask


@pytest.fixture
def says(found: Callable[..., Hover | None]) -> Says:
    """Return the same, as lines."""

    def ask(text: str, **how: Any) -> list[str]:
        said = found(text, **how)
        return [] if said is None else [part.text for part in said.parts]

    return ask


def test_a_motion_is_told_with_its_length_its_tags_and_where_it_leads_by_graph(says):
    assert says("walk¦01") == [
        "motion `Walk_01`: 13.33 sec, 400 frames",
        "- on `Full-Body`: `WALK`; 4 transitions to `Talk_01` (3) and `Walk_02` (1)",
        "- on `Upper-Body`: `SWING_HAND`; 4 transitions to `Talk_01` (3) and `Walk_02` (1)",
    ]
    assert says("¦Idle_02") == [
        "motion `Idle_02`: 13.33 sec, 400 frames",
        "- on `Full-Body`: `IDLE`; no transitions lead on",
    ]


def test_a_motion_is_told_without_transitions_where_they_are_not_known(marked):
    at = marked("¦Idle_02")
    assert hover(at.analysis, at.offset).parts[1].text == "- on `Full-Body`: `IDLE`"


def test_a_tag_is_told_with_its_motions_by_graph_what_is_most_like_what_may_play_before_first(says, reference):
    far = replace(reference, far={("Full-Body", "Idle_01", "Walk_01"): 3.0, ("Full-Body", "Idle_01", "Walk_03"): 0.5})
    assert says("WALK¦", library=far, name="m") == [
        "tag `WALK`",
        "- on `Full-Body`: `Walk_03`, `Walk_02` and `Walk_01`, by likeness to what may play before",
    ]
    assert says("let A = WALK¦", library=far)[1] == "- on `Full-Body`: `Walk_01`, `Walk_02` and `Walk_03`"


def test_very_many_motions_stay_in_the_order_of_the_configuration(says, catalog):
    many = catalog({"Body": {f"M{n}": ("T",) for n in range(6000)}}, {}, start="M1")
    told = says("¦T", library=many)[1]
    assert told.startswith("- on `Body`: `M0`, `M1`, ")
    assert told.endswith("`M7` and 5992 more")


def test_on_a_part_motions_are_told_by_likeness_to_what_the_command_does_above(says, reference):
    far = replace(reference, far={("Upper-Body", "Walk_01", "Talk_01"): 3.0})
    lines = says("Walk_01 with Upper-Body TALK¦", library=far)
    assert lines[2] == "- on `Upper-Body`: `Talk_02` and `Talk_01`, by likeness to what may play before"


def test_a_graph_is_told_with_joints_parent_children_and_motions(says, left_hand):
    assert says("¦upper_body TALK", library=left_hand) == [
        "graph `Upper-Body`: below `Full-Body`; above `Left-Hand`",
        "- 2 joints: `Spine` and `Head`",
        "- 7 motions: `Idle_01`, `Walk_01`, `Walk_02`, `Walk_03`, `Music_01`, `Talk_01` and `Talk_02`",
    ]
    root = says("Full¦-Body TALK", library=left_hand)
    assert root[0] == "graph `Full-Body`: the whole body; above `Upper-Body`"
    assert root[1].startswith("- 12 joints: `Joint_0`, ")
    assert root[1].endswith("`Joint_7` and 4 more")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("WALK with ¦Sub TALK", "Upper-Body"),
        ("WALK with Upper-Body TALK with Su¦b WAVE", "Left-Hand"),
        ("WALK with Sub (TALK) with ¦Sub WAVE", "Left-Hand"),
        ("let G = WALK with ¦Sub TALK", "Upper-Body"),
    ],
)
def test_sub_is_told_as_what_it_means_here(says, left_hand, text, meant):
    assert says(text, library=left_hand)[0].startswith(f"`Sub` is `{meant}` here")
    assert says(text, library=left_hand)[1].startswith(f"graph `{meant}`")


@pytest.mark.parametrize(
    "text", ["¦Sub TALK", "let G(x) = x with ¦Sub TALK", "HM with ¦Sub TALK", "WALK with ¦Sub for"]
)
def test_where_sub_means_nothing_yet_it_is_told_what_the_word_is_for(says, text):
    assert says(text) == ["`Sub`: the graph below the one that is named before `with`"]


def test_a_definition_is_told_with_its_text_and_its_type(found):
    said = found("let G = WALK\n with Upper-Body TALK\n¦G for 1 sec")
    assert said is not None
    assert said.parts[0].code
    assert [part.text for part in said.parts] == [
        "let G = WALK with Upper-Body TALK",
        "a motion",
        "- on `Full-Body`: `Walk_01`, `Walk_02` and `Walk_03`",
        "- on `Upper-Body`: `Talk_01` and `Talk_02`",
    ]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("let ¦A = WALK or SWING_HAND", ["Full-Body: Walk_01, Walk_02, Walk_03"]),
        ("let A = WALK or SWING_HAND\nUpper-Body ¦A for 1 sec", ["Upper-Body: Walk_01, Walk_02"]),
        ("let A = TALK or SWING_HAND\nWALK with ¦A", ["Upper-Body: Walk_01, Walk_02, Talk_01, Talk_02"]),
        ("let A = TALK or IDLE\nWALK and ¦A", ["Upper-Body: Idle_01, Music_01, Talk_01, Talk_02"]),
        ("let A = TALK\nlet B = WALK with ¦A", ["Upper-Body: Talk_01, Talk_02"]),
        ("let A = WALK\n(not ¦A) and IDLE for 1 sec", ["Full-Body: Walk_01, Walk_02, Walk_03"]),
        (
            "let A = WALK or TALK\nA with Left-Hand WAVE with Upper-Body ¦A",
            ["Upper-Body: Talk_01, Talk_02"],
        ),
        (
            "let A = WALK or TALK\n¦A with Left-Hand WAVE with Upper-Body A",
            ["Full-Body: Walk_01, Walk_02, Walk_03, Talk_01, Talk_02"],
        ),
        ("let A = TALK\nlet G(x) = WALK with x with Left-Hand WAVE\nG(¦A)", ["Upper-Body: Talk_01, Talk_02"]),
        (
            "let A = TALK\nlet G(x) = WALK with x for 1 sec\n¦G(A)",
            ["Full-Body: Walk_01, Walk_02, Walk_03", "Upper-Body: Talk_01, Talk_02"],
        ),
        ("let A = SWING_HAND and (Walk_01 or Talk_01)\nUpper-Body (SWING_HAND and ¦A)", ["Upper-Body: Walk_01"]),
        ("Idle_02\nlet A = Walk_01\nSWING_HAND and ¦A and WAVE", ["Full-Body: Walk_01"]),
        ("Idle_01\nlet A = Walk_01\nSWING_HAND and ¦A and WAVE", ["Upper-Body: Walk_01"]),
        ("let A = TALK\nlet G(x) = x with ¦A", []),
        ("let A = TALK\nlet G(x) = WALK\nG(¦A)", []),
        ("let A = TALK\nWALK with Upper-Body ¦A with Upper-Body A", []),
    ],
)
def test_the_type_of_a_definition_is_that_which_it_has_there(says, left_hand, text, meant):
    told = [line.replace("`", "").replace(" and", ",") for line in says(text, library=left_hand)]
    assert [line.removeprefix("- on ") for line in told if line.startswith("- on ")] == meant


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("WALK", "a motion"),
        ("WALK with Upper-Body TALK", "a motion"),
        ("WALK for 2 sec", "a whole statement, which lasts `2 sec`"),
        ("WALK once", "a whole statement, which plays once"),
    ],
)
def test_a_definition_is_told_to_be_a_motion_or_a_whole_statement(says, text, kind):
    assert says(f"let ¦A = {text}\nA")[1] == kind
    assert says(f"let A = {text}\n¦A", library=None)[1] == kind


def test_a_use_is_told_with_what_it_stands_for_there(says):
    text = "let HI(x, t = 2 sec) = x with Upper-Body (A or WAVE_HAND) for t\nlet A = TALK\n"
    assert says(f"{text}¦HI(WALK or IDLE, t = 3 sec)")[1:6] == [
        "a whole statement, which lasts `t`",
        "- `x`: a motion",
        "- `t`: a duration",
        "which stands here for",
        "(WALK or IDLE) with Upper-Body (TALK or WAVE_HAND) for 3 sec",
    ]
    assert says(f"{text}¦HI(WALK)")[5] == "WALK with Upper-Body (TALK or WAVE_HAND) for 2 sec"
    assert len(says(f"{text}¦HI")) == 4


def test_a_parameter_is_told_with_its_kind_and_its_default(says):
    text = "let HI(x = A or B, t = 2 sec) = x with Upper-Body WAVE_HAND for t\n"
    assert says(text.replace("= x with", "= ¦x with")) == ["parameter `x` of `HI`: a motion", "without it, `A or B`"]
    assert says(f"{text}HI(¦t = 1 sec)") == ["parameter `t` of `HI`: a duration", "without it, `2 sec`"]
    assert says("let HI(¦t) = WALK") == ["parameter `t` of `HI`"]


def test_a_definition_of_a_used_file_is_told_and_names_in_that_are(says, marked):
    assert says('use "g.ms"\n¦走', g="let 走 = WALK")[0] == "let 走 = WALK"
    at = marked('use "g.ms"\n', g="let A = 走 # 走\nlet 走 = WALK for 3 sec")
    source = at.analysis.source
    base, text = source.base(source.used[0]), source.used[0].text
    for word, line in (("走", "let 走 = WALK for 3 sec"), ("WALK", "tag `WALK`"), ("3 sec", "3 sec, 90 frames")):
        said = hover(at.analysis, base + text.index(word))
        assert said is not None
        assert said.parts[0].text.startswith(line)
        assert source.slice(said.span) == word
    word = hover(at.analysis, base + text.index("for"))
    assert word is not None
    assert source.slice(word.span) == "for"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("WALK for ¦10 sec", "10 sec, 300 frames at 30 frames a second"),
        ("WALK for 1.5¦min", "90 sec, 2700 frames at 30 frames a second"),
        ("wait 100 ms¦", "0.1 sec, 3 frames at 30 frames a second"),
        ("repeat 2 { wait 45 ¦frames }", "1.5 sec, 45 frames at 30 frames a second"),
        ("let G(t = ¦2 s) = WALK for t", "2 sec, 60 frames at 30 frames a second"),
    ],
)
def test_a_number_with_a_unit_is_told_in_seconds_and_frames(says, text, line):
    assert says(text) == [line]


def test_cycles_are_told_by_the_clips_that_they_may_be_of(says):
    line = "passes of the topmost motion that is named; after `wait`, of the command before"
    assert says("WALK with Upper-Body TALK for ¦2 cycles") == [
        f"2 {line}",
        "here 26.666667 sec, 800 frames at 30 frames a second",
    ]
    assert says("wait ¦2 cycles") == [f"2 {line}"]
    assert says("HM for ¦2 cycles") == [f"2 {line}"]


def test_without_a_library_what_the_script_says_itself_is_told(says):
    assert says("let G = WALK\n¦G", library=None) == ["let G = WALK", "a motion"]
    assert says("¦WALK", library=None) == []
    assert says("WALK for ¦2 min", library=None) == ["120 sec"]
    assert says("WALK for ¦2 frames", library=None) == ["2 frames; how long they last depends on the library"]
    assert says("WALK with ¦Sub TALK", library=None) == ["`Sub`: the graph below the one that is named before `with`"]


@pytest.mark.parametrize("word", [word.lower() for word in WORDS])
def test_each_word_of_the_language_is_told(says, word):
    assert says(f"IDLE\n{word}¦ x") == [f"`{word}`: {WORDS[word.upper()]}"]


def test_all_units_have_something_said_of_them():
    assert set(UNIT_SAYS) == set(UNITS.values())


@pytest.mark.parametrize("text", ["¦", "# WALK¦", "¦HM", "WALK ¦ for 1 sec", "(¦ WALK)", "WALK for 1 sec\n\n¦"])
def test_of_nothing_nothing_is_said(says, text):
    assert says(text) == []


def test_the_name_is_shown_whole_with_its_quotes(found, catalog):
    odd = catalog({"Body": {"a `b` c": (), "走路": ()}}, {}, start="走路")
    said = found('走路\n"a `b`¦ c"', library=odd)
    assert said is not None
    assert (said.span.start, said.span.end) == (3, 12)
    assert said.parts[0].text.startswith("motion ``a `b` c``: ")


def test_names_are_code_whatever_is_in_them():
    assert [code("a"), code("a`b"), code("`"), code("``a")] == ["`a`", "``a`b``", "`` ` ``", "``` ``a ```"]


def test_long_expansions_are_cut(says):
    text = "let A = WALK or WALK or WALK\n" + "".join(f"let A{n} = (A or A{n - 1 or ''})\n" for n in range(1, 40))
    assert len(says(f"{text}¦A39")[2]) < 700


@pytest.mark.parametrize(
    "text",
    [
        'use "g.ms"\nlet G(x, t = 2 sec) = x with Sub TALK for t\nG(WALK); 走 for for WALK\nWALK with Sub (TALK',
        "let A = A\nA\nlet B(x) = x\nB(\nWALK with Upper-Body TALK for 2 cycles\nIDLE\n}",
        'repeat 2 { "WALK" with "Upper-Body" TALK\nchoose { 2: IDLE | WAVE_HAND and WALK } }\nend Upper-Body',
    ],
)
def test_after_an_edit_the_same_is_said_as_of_the_text_afresh(marked, text):
    old = marked(f"IDLE\n{text}", g="let 走 = TALK").analysis
    new = Source(f"IDLE\nWalk_02\nTALK\n{text}", "main.ms")
    again = analyse_again(old, new)
    fresh = analyse(new, old.question.catalog, files=old.question.files)
    for offset in range(fresh.source.end):
        assert hover(again, offset, Bones()) == hover(fresh, offset, Bones()), offset


def test_what_is_wrong_at_a_place_is_told_with_what_it_means(marked: Callable[..., Any]) -> None:
    at = marked("IDLE for 2 sec\nWL¦AK for 2 sec\nTALK")
    found = hover_mistakes(at.analysis, at.offset, errors=True)
    assert found is not None
    assert at.analysis.source.slice(found.span) == "WLAK"
    said, helped, meant, why = (part.text for part in found.parts)
    assert said == "**error:** no tag or motion `WLAK` in this library"
    assert helped.startswith("help: ")
    assert "`WALK`" in helped
    assert meant.startswith("**MS021** No graph of the library has a motion or tag of this name")
    assert why.startswith("A script is read against one library")
    assert hover_mistakes(at.analysis, at.offset, errors=False) is None
    assert hover_mistakes(at.analysis, 2, errors=True) is None


def test_all_that_is_wrong_at_a_place_is_told_before_what_it_means(marked: Callable[..., Any]) -> None:
    at = marked("WLAK¦ with TLAK")
    between = replace(at.analysis, diagnostics=tuple(replace(one, span=Span(0, 9)) for one in at.analysis.diagnostics))
    found = hover_mistakes(between, at.offset, errors=True)
    assert found is not None
    bold = [part.text[:9] for part in found.parts if part.text.startswith("**")]
    assert bold == ["**error:*", "**error:*", "**MS021**"]


def test_a_warning_is_told_apart_from_mistakes(marked: Callable[..., Any]) -> None:
    at = marked("let gr¦eet = WALK\nIDLE")
    found = hover_mistakes(at.analysis, at.offset, errors=False)
    assert found is not None
    assert found.parts[0].text.startswith("**warning:** ")
    assert hover_mistakes(at.analysis, at.offset, errors=True) is None
