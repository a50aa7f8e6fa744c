"""What is offered at a cursor is what is valid there, the best first."""

import random
from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse
from mlmg_lang.ide.offers import Completion, What
from mlmg_lang.source import Source, Span

Texts = Callable[..., list[str]]
Offers = Callable[..., list[Completion]]
UPPER = ["IDLE", "Idle_01", "SWING_HAND", "Walk_01", "Walk_02", "WAVE_HAND", "Walk_03", "Music", "Music_01"]
UPPER += ["TALK", "Talk_01", "Talk_02"]


def test_a_command_may_begin_with_what_the_whole_body_does_then_with_parts_then_with_words(offers: Offers) -> None:
    found = offers("¦")
    kinds = list(dict.fromkeys((one.what, one.graph) for one in found))
    assert kinds[:2] == [(What.TAG, "Full-Body"), (What.MOTION, "Full-Body")]
    assert (What.GRAPH, None) in kinds
    assert kinds[-1] == (What.WORD, None)
    assert [one.text for one in found if one.graph == "Upper-Body"] == ["SWING_HAND"]


def test_after_a_graph_come_only_its_tags_and_motions(texts: Texts) -> None:
    assert texts("WALK with Upper-Body ¦") == UPPER
    assert texts("Upper-Body ¦") == UPPER
    assert texts("Upper-Body (TALK or ¦") == [*UPPER, "not"]
    assert texts("Upper-Body (not ¦") == [*UPPER, "not"]


def test_after_with_come_only_graphs_below_that_rule_1_allows(texts: Texts, left_hand: Catalog) -> None:
    assert "Upper-Body" in texts("WALK with ¦")
    assert "Full-Body" not in texts("WALK with ¦")
    assert texts("Idle_02 with ¦") == []
    assert texts("WALK with Upper-Body TALK with ¦") == []
    below = texts("WALK with Upper-Body TALK with ¦", left_hand)
    assert "Left-Hand" in below
    assert "Upper-Body" not in below


def test_with_is_offered_only_where_it_leaves_a_graph(texts: Texts, left_hand: Catalog) -> None:
    assert texts("WALK ¦") == ["with", "for", "once", "and", "or"]
    assert texts("Idle_02 ¦") == ["for", "once", "and", "or"]
    assert texts("WALK with Upper-Body TALK ¦") == ["for", "once", "and", "or"]
    assert texts("WALK with Upper-Body TALK ¦", left_hand)[0] == "with"


def test_sub_is_the_part_below(texts: Texts) -> None:
    assert "Sub" in texts("WALK with ¦")
    assert texts("WALK with Sub ¦") == UPPER


def test_sub_is_any_of_the_parts_right_below(texts: Texts, hands: Catalog) -> None:
    for text in ("WALK with Sub ¦", "WALK with Sub (¦)", "WALK with Sub (¦", "WALK with Sub (POINT or ¦)"):
        found = set(texts(text, hands)) - {"not"}
        assert {"WAVE", "POINT", "Point_01"} <= found
        for one in found:
            whole = text.replace("¦", one) + ")" * (text.count("(") - text.count(")"))
            told = analyse(Source(whole), hands, "Walk_01").diagnostics
            assert not [m.message for m in told if m.severity == "error"], whole
    assert "WAVE" not in texts("WALK with Sub (POINT and ¦)", hands)
    assert "Sub" in texts("WALK with ¦", hands)
    assert "Sub" not in texts("WALK with Left-Hand WAVE with ¦", hands)


def test_a_part_that_rule_1_forbids_now_is_not_offered(texts: Texts) -> None:
    assert "SWING_HAND" not in texts("¦", playing="Idle_02")
    assert "Upper-Body" not in texts("¦", playing="Idle_02")


def test_units_come_after_a_number(texts: Texts) -> None:
    for text in ("WALK for 10 ¦", "WALK for 10¦", "WALK for 1.5 s¦", "wait 3 ¦"):
        assert texts(text) == ["sec", "ms", "min", "frames", "cycles"]


def test_after_a_whole_statement_nothing_is_offered(texts: Texts) -> None:
    assert texts("WALK for 10 sec ¦") == []
    assert texts("WALK once ¦") == []


def test_nothing_is_offered_where_a_new_name_is_made_or_in_a_comment(texts: Texts) -> None:
    assert texts("let ¦") == []
    assert texts("let G(x, ¦") == []
    assert texts("WALK # ¦") == []
    assert texts("end ¦") == []


def test_definitions_and_parameters_are_offered(texts: Texts) -> None:
    assert "GREET" in texts("¦", defined="let GREET(x) = x with Upper-Body TALK")
    found = texts("let G(who, t = 2 sec) = ¦")
    assert {"who", "WALK"} <= set(found)
    assert set(texts("let G(who, t = 2 sec) = WALK for ¦")) == {"who", "t"}


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        ("let G(x, t = 2 sec) = ¦", {"x"}),
        ("let G(x, y = WALK) = x for ¦", set()),
        ("let G(x, t) = x for ¦", {"t"}),
        ("let G(x, t) = x with ¦", {"x", "t"}),
        ("let G(x, s, t) = H(x, t = s) with ¦", {"x", "t"}),
        ("let G(x, s, t) = H(x, ¦", {"s", "t", "t = "}),
        ("let G(x, t = ¦", set()),
    ],
)
def test_parameters_are_offered_where_what_they_stand_for_may_stand(
    text: str, offered: set[str], offers: Offers
) -> None:
    found = offers(text, defined="let H(x, t = 2 sec) = x for t")
    assert {one.text for one in found if one.what in (What.PARAMETER, What.ARGUMENT)} == offered


@pytest.mark.parametrize(
    ("text", "names", "takes_motion"),
    [
        ("H(¦", ["x = ", "t = "], True),
        ("H(WALK, ¦", ["t = "], False),
        ("H(WALK, t = ¦", [], False),
        ("H(x = ¦", [], True),
        ("H(t = 2 sec, ¦", ["x = "], False),
        ("H(WALK, 2 sec, ¦", [], False),
        ("H((¦", [], True),
        ("H(WALK or ¦", [], True),
        ("H(WALK with Upper-Body TALK, ¦", ["t = "], False),
        ("WALK with M(TALK, ¦", ["y = "], True),
        ("Upper-Body (¦", [], True),
    ],
)
def test_between_the_parentheses_of_a_definition_its_parameters_are_named_and_what_they_take_is_offered(
    text: str, names: list[str], takes_motion: bool, offers: Offers
) -> None:
    found = offers(text, defined="let H(x, t = 2 sec) = x for t\nlet M(x, y = TALK) = x or y")
    assert [one.text for one in found if one.what is What.ARGUMENT] == names
    assert (not {What.TAG, What.MOTION}.isdisjoint(one.what for one in found)) == takes_motion
    assert ("not" in [one.text for one in found]) == takes_motion


def test_what_says_how_long_is_offered_as_a_whole_statement_alone(texts: Texts) -> None:
    defined = "let G(x, t = 2 sec) = x with Upper-Body TALK for t\nlet ONCE = WALK once\nlet H(x) = x"
    for text in ("¦", "IDLE\n¦", "repeat 2 {\n¦"):
        assert {"G", "ONCE", "H"} <= set(texts(text, defined=defined))
    for text in ("WALK with ¦", "not ¦", "(WALK or ¦", "WALK and ¦", "(¦", "let B = ¦", "H(¦", "IDLE\nWALK or ¦"):
        assert {"G", "ONCE", "H"} & set(texts(text, defined=defined)) == {"H"}


def test_behind_a_graph_that_cannot_be_there_nothing_is_offered(texts: Texts, left_hand: Catalog) -> None:
    assert texts("Idle_02 with Upper-Body ¦") == []
    assert texts("WALK with Upper-Body TALK with Upper-Body ¦", left_hand) == []
    assert texts("WALK with Full-Body ¦") == []


def test_behind_and_stands_what_has_something_in_common_or_can_run_at_the_same_time(texts: Texts) -> None:
    defined = "let PAIR = WALK with Upper-Body TALK\nlet SET = Walk_01 or TALK\nlet NOTHING = Idle_02"
    upper = ["Music", "TALK", "Talk_01", "Talk_02", "SWING_HAND"]
    assert not {"Idle_02", "PAIR", "NOTHING"} & set(texts("WALK and ¦", defined=defined))
    assert {"Walk_01", "WAVE_HAND", "SET", *upper} <= set(texts("WALK and ¦", defined=defined))
    assert {"Idle_01", "IDLE", "Idle_02"} & set(texts("Idle_02 and ¦")) == {"IDLE", "Idle_02"}
    assert texts("Upper-Body (TALK and ¦") == ["IDLE", "TALK", "Talk_01", "Talk_02", "not"]
    assert texts("WALK with Upper-Body (TALK and ¦") == ["IDLE", "TALK", "Talk_01", "Talk_02", "not"]
    assert "SWING_HAND" in texts("TALK and Upper-Body ¦")
    assert "Idle_02" in texts("WALK and not ¦")
    assert "Idle_02" in texts("WALK or ¦")
    assert {"for", "once", "and", "or"} <= set(texts("WALK and PAIR ¦", defined=defined))


@pytest.mark.parametrize("playing", ["Idle_01", "Walk_01", "Idle_02"])
@pytest.mark.parametrize("library", ["reference", "left-hand", "hands"])
def test_a_name_behind_and_is_offered_as_what_it_would_do_there(
    library: str, playing: str, offers: Offers, libraries: Any
) -> None:
    texts = ["WALK and ¦", "IDLE and ¦", "TALK and ¦", "Idle_02 and ¦", "TALK and IDLE and ¦"]
    texts += ["IDLE with Walk_01 and ¦"]
    if library == "hands":
        texts += ["WAVE and ¦", "WALK and Left-Hand ¦", "Left-Hand WAVE and ¦", "WALK with POINT and ¦"]
    else:
        texts += ["WALK and Upper-Body ¦", "Upper-Body TALK and ¦", "Upper-Body (TALK and ¦", "WALK with TALK and ¦"]
        texts += ["SWING_HAND and ¦"]
    n_shared = 0
    for text in texts:
        found = [one for one in offers(text, libraries[library], playing) if one.graph is not None]
        shared = [one.beside is not None for one in found]
        assert shared == sorted(shared)
        n_shared += sum(shared)
        for one in found:
            written = text.replace("¦", one.text) + ")" * text.count("(")
            analysis = analyse(Source(f"{playing}\n{written}"), libraries[library])
            assert not [told for told in analysis.diagnostics if told.severity == "error"], written
            assert analysis.resolved is not None
            layers = {layer.graph: layer.candidates for layer in analysis.resolved.statements[1].layers}
            assert set(layers[one.graph]) <= set(one.motions), written
            assert one.beside is None or one.beside in layers, written
            if text.startswith("WALK and ") and "(" not in text:
                assert len(layers) == (1 if one.beside is None else 2), written
    assert n_shared


def test_behind_and_what_has_most_in_common_with_what_is_played_comes_first(offers: Offers) -> None:
    found = offers("Walk_02 and ¦")
    assert [(one.name, one.motions, one.beside) for one in found][:2] == [
        ("WALK", ("Walk_02",), None),
        ("Walk_02", ("Walk_02",), None),
    ]
    shared = [one for one in found if one.beside is not None]
    assert {(one.graph, one.beside) for one in shared} == {("Upper-Body", "Full-Body")}
    assert "IDLE" in [one.name for one in shared]


DEFINED = """
let NOD = Upper-Body TALK
let EXPLAIN = WALK with Upper-Body TALK
let GREET = WAVE
let TALKING = TALK
let LASTING = WALK for 2 sec
let WITH_WHOM(x) = x with Upper-Body TALK
let ROUND = ROUND
"""


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        ("¦", {"NOD", "EXPLAIN", "GREET", "TALKING", "LASTING", "WITH_WHOM"}),
        ("WALK with ¦", {"NOD", "GREET", "TALKING", "WITH_WHOM"}),
        ("WALK with (¦", {"NOD", "GREET", "TALKING", "WITH_WHOM"}),
        ("WALK with Upper-Body TALK with ¦", {"GREET", "WITH_WHOM"}),
        ("NOD with ¦", {"GREET", "WITH_WHOM"}),
        ("EXPLAIN with ¦", {"GREET", "WITH_WHOM"}),
        ("WALK with NOD with GREET with ¦", set()),
        ("Idle_02 with ¦", set()),
    ],
)
def test_only_definitions_are_offered_that_fit(text: str, offered: set[str], texts: Texts, left_hand: Catalog) -> None:
    names = {line.split()[1].partition("(")[0] for line in DEFINED.split("\n") if line}
    found = texts(text, left_hand, defined=DEFINED)
    assert names & set(found) == offered
    for one in offered - {"WITH_WHOM"}:
        whole = text.replace("¦", one) + ")" * text.count("(")
        # What is wrong with a definition that is not used is told there.
        told = analyse(Source(f"{DEFINED.replace('let ROUND = ROUND', '')}{whole}"), left_hand, "Walk_01").diagnostics
        assert not [m.message for m in told if m.severity == "error"], whole


def test_a_definition_that_rule_1_forbids_now_is_not_offered(texts: Texts) -> None:
    assert "NOD" not in texts("¦", playing="Idle_02", defined="let NOD = Upper-Body TALK")
    assert "NOD" in texts("¦", playing="Idle_01", defined="let NOD = Upper-Body TALK")


def test_where_no_graph_is_left_nothing_is_offered(texts: Texts) -> None:
    assert texts("WALK with Upper-Body TALK with ¦", defined="let NOD = Upper-Body TALK") == []
    assert "not" in texts("WALK with ¦")


BEHIND = [
    *("¦ with Upper-Body TALK", "¦ with Left-Hand WAVE for 2 sec", "¦ with WAVE", "¦ and SWING_HAND", "¦ and WAVE"),
    *("¦ or WAVE", "WALK with ¦ with WAVE", "WALK with (¦ and TALK)", "WALK with Upper-Body ¦ with Left-Hand WAVE"),
    *("WALK with Upper-Body (¦ and SWING_HAND) with WAVE", "Upper-Body ¦ with Left-Hand Wave_01", "¦ for 2 sec"),
    *("¦\nwith Upper-Body TALK\nwith Left-Hand WAVE\nWALK", "¦ # so\n\n  with Left-Hand WAVE\nonce", "(¦\n) with WAVE"),
    *("HAND(¦)", "HAND(¦) for 2 sec", "TWO(WALK, ¦)", "TWO(x = ¦, y = TALK)", "TWO(¦, Left-Hand WAVE)", "HAND((¦))"),
    *("repeat 2 { ¦ with Upper-Body SWING_HAND }", "choose { | IDLE | ¦ with Left-Hand WAVE }", "HAND(¦"),
]
TAKEN = """let HAND(x) = x with Left-Hand x
let TWO(x, y) = x with y
let NOD = Upper-Body TALK
let WHOLE = Idle_02
let LONG = WALK for 3 sec
let BOTH = WALK with Upper-Body TALK
"""


@pytest.mark.parametrize("text", BEHIND)
@pytest.mark.parametrize("playing", ["Walk_01", "Idle_02"])
def test_what_stands_behind_the_cursor_counts(text: str, playing: str, offers: Offers, left_hand: Catalog) -> None:
    def wrong(name: str) -> list[str]:
        written = text.replace("¦", name) + ")" * (text.count("(") - text.count(")"))
        told = analyse(Source(f"{TAKEN}{playing}\n{written}"), left_hand, playing).diagnostics
        return [one.message for one in told if one.severity == "error"]

    kinds = (What.MOTION, What.TAG, What.DEFINITION)
    offered = {one.text for one in offers(text, left_hand, playing, TAKEN) if one.what in kinds} - {"HAND", "TWO"}
    alone = text.partition("¦")[0] + "¦"
    known = {one.text for one in offers(alone, left_hand, playing, TAKEN) if one.what in kinds} - {"HAND", "TWO"}
    right = {name for name in known if not wrong(name)}
    assert offered == (right or known)
    assert offered


@pytest.mark.parametrize(
    ("text", "alone"),
    [
        ("¦ with Left-Hand WALK", "¦"),
        ("¦ with Left-Hand NOBODY", "¦"),
        ("¦ with with", "¦"),
        ("¦ with WALK with Left-Hand WAVE", "¦"),
        ("WALK with (¦\nIDLE for 2 sec", "WALK with (¦"),
        ("¦\nUpper-Body TALK", "¦"),
        ("¦ with Left-Hand (WAVE", "¦"),
    ],
)
def test_where_all_would_be_as_wrong_nothing_is_left_out(
    text: str, alone: str, texts: Texts, left_hand: Catalog
) -> None:
    assert texts(text, left_hand) == texts(alone, left_hand)


def test_a_graph_is_offered_before_what_is_on_it(texts: Texts, left_hand: Catalog) -> None:
    assert texts("WALK with ¦ WAVE", left_hand) == ["Left-Hand", "not"]


def test_below_a_parameter_all_parts_are_offered(texts: Texts) -> None:
    assert {"TALK", "Upper-Body"} <= set(texts("let G(x) = x with ¦"))


@pytest.mark.parametrize(
    ("text", "defined", "hidden"),
    [
        ("¦", "let WALK = IDLE", {"WALK"}),
        ("¦", "let Walk = IDLE\nlet walk_01 = IDLE", set()),
        ("¦", "let WALK = \nIDLE", {"WALK"}),
        ("Upper-Body ¦", "let TALK = WAVE", {"TALK"}),
        ("WALK with Upper-Body (¦", "let TALK = WAVE", {"TALK"}),
        ("WALK with ¦", "let Talk_01 = WAVE", {"Talk_01"}),
        ("let G(WALK, IDLE = WALK) = ¦", "", {"WALK", "IDLE"}),
        ("let G(WALK, IDLE = ¦", "", set()),
        ("let WALK = ¦", "", {"WALK"}),
    ],
)
def test_names_of_the_library_that_mean_something_else_in_the_script_are_not_offered(
    text: str, defined: str, hidden: set[str], offers: Offers
) -> None:
    found = {one.name for one in offers(text, defined=defined) if one.graph is not None}
    assert found == {one.name for one in offers(text.replace("WALK = ¦", "X = ¦")) if one.graph is not None} - hidden


def test_a_name_that_is_spelt_in_two_ways_is_hidden_in_both(offers: Offers, catalog: Any) -> None:
    composed, apart = "caf\N{LATIN SMALL LETTER E WITH ACUTE}", "cafe\N{COMBINING ACUTE ACCENT}"
    library = catalog({"Body": {apart: (), "other": ()}}, {}, start="other")
    found = offers("¦", library, playing="other", defined=f"let {composed} = other")
    assert [one.name for one in found if one.graph] == ["other"]


def test_a_definition_is_not_offered_in_itself_nor_where_a_parameter_is_called_so(offers: Offers) -> None:
    defined = "let A = WALK\nlet B = WALK"
    for text, known in (("let A = ¦", {"B"}), ("let G(B) = ¦", {"A"}), ("let C = ¦", {"A", "B"})):
        assert {one.name for one in offers(text, defined=defined) if one.what is What.DEFINITION} == known


def test_own_names_stand_behind_the_best_ten_of_the_library_and_first_where_a_word_is_begun(
    texts: Texts, catalog: Any
) -> None:
    clips = [f"clip_{number:02}" for number in range(30)]
    library = catalog({"Body": dict.fromkeys(clips, ("ALL",)), "Arm": {"clip_00": ()}}, {"Arm": "Body"}, start=clips[0])
    for text, own in (("¦", ["cut"]), ("let G(c) = ¦", ["c", "cut"])):
        found = texts(text, library, playing=clips[0], defined="let cut = clip_03")
        assert found[: 10 + len(own)] == ["ALL", *clips[:9], *own]
        found = texts(text.replace("¦", "c¦"), library, playing=clips[0], defined="let cut = clip_03")
        assert found[: len(own)] == own


def test_in_braces_there_is_no_let(texts: Texts) -> None:
    inside = texts("repeat 2 {\n¦")
    assert {"WALK", "wait", "choose"} <= set(inside)
    assert not {"let", "use"} & set(inside)


def test_a_line_after_a_command_may_go_on_with_it(texts: Texts) -> None:
    assert {"with", "for", "WALK", "let"} <= set(texts("IDLE\n¦"))
    assert not {"with", "for"} & set(texts("IDLE;\n¦"))


def test_a_statement_with_a_mistake_before_the_cursor_is_offered_nothing(texts: Texts) -> None:
    assert texts("WALK for for ¦") == []


@pytest.mark.parametrize(
    ("text", "word"),
    [
        *(("WA¦", "WA"), ("WALK with Upper-¦", "Upper-"), ("WALK with Upper-Bo¦", "Upper-Bo"), ('"hand o¦', '"hand o')),
        *(("14¦", "14"), ("14_¦", "14_"), ("not 14_0¦", "14_0"), ("GO(14_0¦", "14_0"), ("WALK for 2s¦", "s")),
        *(("WALK for 2¦", ""), ("GO(2¦", ""), ("repeat 2¦", "")),
    ],
)
def test_what_has_been_written_of_a_word_is_replaced(text: str, word: str, reference: Catalog) -> None:
    from mlmg_lang.ide.cursor import cursor_at
    from mlmg_lang.parsing.tokenize import tokenize

    before = text.partition("¦")[0]
    cursor = cursor_at(tokenize(Source(before)), len(before))
    assert cursor is not None
    assert before[cursor.span.start : cursor.span.end] == word
    assert cursor.word == word.strip('"')


def test_names_that_need_quotes_are_offered_in_quotes(texts: Texts, catalog: Any) -> None:
    odd = catalog({"Body": {"hand on hip": (), "with": (), "走路": ()}}, {}, start="走路")
    assert texts("¦", odd, playing="走路")[:3] == ['"hand on hip"', '"with"', "走路"]


def test_a_name_that_begins_with_a_digit_is_offered_in_quotes_where_a_motion_may_stand(
    texts: Texts, catalog: Any
) -> None:
    clips = catalog({"Body": {"14_02": (), "14_04": ()}, "Arm": {"14_02": ()}}, {"Arm": "Body"}, start="14_02")
    for written in ("14¦", "14_0¦", "let X = 14_0¦", "choose { 3: 14_0¦", '"14_04" or not 14_0¦'):
        assert texts(written, clips, playing="14_02")[:1] == ['"14_02"']
    assert texts('"14_02" with Arm 14_¦', clips, playing="14_02")[:1] == ['"14_02"']
    assert texts('"14_02" for 14¦', clips, playing="14_02") == ["sec", "ms", "min", "frames", "cycles"]
    assert texts("repeat 14¦", clips, playing="14_02") == []


def test_behind_a_quote_names_alone_are_offered_and_all_in_quotes(texts: Texts, catalog: Any) -> None:
    odd = catalog({"Body": {"hand on hip": (), "with": (), "走路": ()}}, {}, start="走路")
    assert texts('"¦', odd, playing="走路") == ['"hand on hip"', '"with"', '"走路"']
    assert texts('走路 for 3 "¦', odd, playing="走路") == []
    assert "Sub" in texts("WALK with ¦")
    assert {'"Sub"', '"not"'}.isdisjoint(texts('WALK with "¦'))


def test_of_a_name_without_its_second_quote_what_stands_behind_the_cursor_stays(reference: Catalog) -> None:
    from mlmg_lang.ide.cursor import cursor_at
    from mlmg_lang.parsing.tokenize import tokenize

    for text, replaced in (('"ha for 2 sec', '"ha'), ('"ha on hip" for 2 sec', '"ha on hip"')):
        cursor = cursor_at(tokenize(Source(text)), 3)
        assert cursor is not None
        assert (text[cursor.span.start : cursor.span.end], cursor.word) == (replaced, "ha")


def test_what_has_been_used_more_comes_first_among_equals(reference: Catalog) -> None:
    from mlmg_lang.ide.completion import Surroundings, complete
    from mlmg_lang.ide.cursor import cursor_at
    from mlmg_lang.ide.offers import Offers
    from mlmg_lang.planning import flow
    from mlmg_lang.planning.names import Names

    class Alike:
        def fits(self, graph: str, above: object) -> dict[str, float]:
            return dict.fromkeys(names.motions(graph), 1.0)

    names = Names(reference)
    definitions = analyse(Source(""), reference).definitions
    offers = Offers(names, Alike(), {"TALK": 3, "Walk_02": 1})
    around = Surroundings(names, definitions, flow.begin(names, "Idle_01"), offers)
    assert [one.text for one in complete(cursor_at((), 0), 0, around).found][:2] == ["TALK", "Walk_02"]


def test_names_are_ranked_by_the_best_of_their_motions_then_by_use_then_as_the_library_has_them(
    reference: Catalog,
) -> None:
    from mlmg_lang.ide.completion import Offered
    from mlmg_lang.ide.offers import Offers
    from mlmg_lang.planning.names import Names

    class Fitting:
        def fits(self, graph: str, above: object) -> dict[str, float]:
            return fits

    names, draw = Names(reference), random.Random(1)
    for _ in range(50):
        fits = {motion: draw.choice((0.0, 0.5, 2.0)) for motion in names.motions(names.root) if draw.random() < 0.6}
        uses = {entry.name: draw.randrange(3) for entry in names.entries(names.root)}
        known = [
            (min(fits[motion] for motion in entry.motions if motion in fits), -uses[entry.name], at, entry.name)
            for at, entry in enumerate(names.entries(names.root))
            if any(motion in fits for motion in entry.motions)
        ]
        found = Offers(names, Fitting(), uses).on(names.root, ()).found
        told = Offered(Span(0, 0), found, {(names.root, None): fits})
        assert [(told.fit(one), one.name) for one in found] == [(fit, name) for fit, _, _, name in sorted(known)]


def test_whatever_is_offered_for_a_finished_motion_is_understood(texts: Texts, left_hand: Catalog) -> None:
    for text in (
        "¦",
        "WALK with ¦",
        "WALK with Upper-Body ¦",
        "Upper-Body ¦",
        "WALK with Upper-Body TALK with ¦",
        "IDLE or ¦",
        *("WALK and ¦", "Idle_02 and ¦", "SWING_HAND and ¦", "WALK and IDLE or WALK and ¦", "Upper-Body TALK and ¦"),
        *("WALK with TALK and ¦", "TALK and IDLE and ¦", "WALK and Upper-Body ¦"),
    ):
        for one in texts(text, left_hand):
            whole = text.replace("¦", one)
            if one not in ("Upper-Body", "Left-Hand", "Sub", "not", "wait", "end", "repeat", "choose", "let", "use"):
                told = analyse(Source(whole), left_hand, "Walk_01").diagnostics
                assert not [m.message for m in told if m.severity == "error"], whole
