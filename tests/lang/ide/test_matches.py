"""Of what could be written, what has the letters that are: also names of several words that lack their quotes."""

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.ide.completion import Surroundings
from mlmg_lang.ide.matches import Matches, matches
from mlmg_lang.ide.offers import Offers
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source

MOST = 100


@pytest.fixture
def found(catalog, in_order):
    """Return a function: a text with `¦` for the cursor -> what is meant there."""
    on = {"Whole Body": {"wave hand": ("say hello to all",), "wave": ("GO_UP",)}, "Upper-Body": {"wave hand": ()}}
    library = catalog(on, {"Upper-Body": "Whole Body"}, start="wave hand")
    names = Names(library)

    def ask(text: str, defined: str = 'let "my own" = wave') -> tuple[Matches, list[tuple[str, str]]]:
        before, _, after = text.partition("¦")
        source = Source(before + after)
        definitions = analyse(Source(defined), library).definitions
        around = Surroundings(names, definitions, flow.begin(names, "wave hand"), Offers(names, in_order(names)))
        meant = matches(source, tokenize(source), len(before), around, MOST)
        return meant, [(source.slice(meant.offered.span), one.text) for one in meant.found]

    return ask


@pytest.mark.parametrize(
    ("text", "replaced", "offered"),
    [
        ("wave ha¦", "wave ha", '"wave hand"'),
        ("wave   HA¦nd for 2 sec", "wave   HAnd", '"wave hand"'),
        ('"wave hand" with Upper Bo¦', "Upper Bo", "Upper-Body"),
        ("Upper-Body wave ha¦", "wave ha", '"wave hand"'),
        ("go u¦", "go u", "GO_UP"),
        ("wave or say hello t¦", "say hello t", '"say hello to all"'),
        ("(my ow¦", "my ow", '"my own"'),
        ("wave\nwave ha¦", "wave ha", '"wave hand"'),
        ("wave h¦", "wave h", '"wave hand"'),
    ],
)
def test_names_that_lack_their_quotes_take_the_place_of_all_their_words(found, text, replaced, offered):
    meant, shown = found(text)
    assert shown == [(replaced, offered)]
    assert meant.apart
    assert not meant.is_final


@pytest.mark.parametrize(
    "text", ["wave\nha¦", "wave; ha¦", '"wave ha¦', "wave with ha¦", "wave say h¦", "end wave ha¦"]
)
def test_words_that_are_of_no_name_stay(found, text):
    meant, _ = found(text)
    assert not meant.apart


def test_words_of_the_language_come_before_names_that_a_row_may_be_of(found):
    meant, shown = found("wave f¦")
    assert shown == [("f", "for")]
    # With the next letter it may be a name.
    assert not meant.is_final
    assert found("wav¦")[0].is_final


def test_of_names_that_are_as_like_the_word_the_script_s_own_come_first(found):
    defined = "let waving = wave\nlet w = wave\nlet up = wave"
    assert [name for _, name in found("w¦", defined)[1]][:3] == ["w", "waving", '"wave hand"']
    assert [name for _, name in found("wave¦", defined)[1]] == ["wave", '"wave hand"']
    assert [name for _, name in found("UP¦", defined)[1]] == ["up", "Upper-Body", "GO_UP"]


def test_however_many_definitions_there_are_those_that_are_meant_are_tried(found):
    defined = "\n".join(f'let D_{number} = "wave hand"' for number in range(60)) + "\nlet D_ARM = Upper-Body wave"
    assert "D_59" in [name for _, name in found("D_59¦", defined)[1]]
    assert [name for _, name in found("wave with D_59¦", defined)[1]] == []


@pytest.fixture
def in_large(catalog, in_order):
    """Return a function: a text with `¦` for the cursor -> what is meant there, in a library of many motions."""
    clips = [f"m_{number:03}" for number in range(400)]
    arm = dict.fromkeys((*clips[390:], "other"), ())
    library = catalog({"Body": dict.fromkeys((*clips, "other"), ()), "Arm": arm}, {"Arm": "Body"}, start=clips[0])
    names = Names(library)

    def ask(text: str) -> Matches:
        before, _, after = text.partition("¦")
        source = Source(before + after)
        around = Surroundings(
            names, analyse(Source("")).definitions, flow.begin(names, clips[395]), Offers(names, in_order(names))
        )
        return matches(source, tokenize(source), len(before), around, MOST)

    return ask


@pytest.mark.parametrize("text", ["m¦ with Arm m_391", "¦ with Arm m_391 for 2 sec", "(m¦) with m_391"])
def test_what_is_right_with_what_stands_behind_is_found_among_however_many_names(in_large, text):
    meant = in_large(text)
    assert [one.name for one in meant.found if one.graph][:10] == [f"m_{number}" for number in range(390, 400)]
    assert not meant.is_final


def test_what_begins_so_and_would_be_wrong_is_not_offered_where_another_name_would_be_right(in_large):
    assert [one.name for one in in_large("m_00¦ with Arm m_391").found] == []
    assert [one.name for one in in_large("m_39¦ with Arm m_391").found] == [f"m_{number}" for number in range(390, 400)]
    assert in_large("m_39¦ with Arm m_391").is_final


def test_a_word_that_stands_right_behind_the_cursor_would_be_of_the_name(in_large):
    assert in_large("¦Arm m_391").found == in_large("¦").found
