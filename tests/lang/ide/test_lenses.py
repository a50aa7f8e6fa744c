"""What can be done with a script and its commands: `ide.lenses`."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.lenses import lenses
from mlmg_lang.source import Source

LINES = st.sampled_from(
    ["WALK\n", "IDLE for 2 sec\n", "repeat 2 { IDLE\nTALK }\n", "let X = WALK\n", "X\n", "WLAK\n", "\n", "Walk_01\n"]
)
TEXTS = st.lists(LINES, max_size=6).map("".join)


def offered(text: str, library: Catalog | None) -> list[str]:
    source = Source(text)
    return [
        f"{source.position(lens.span.start)[0]} {lens.deed}: {lens.title}"
        + ("" if lens.about is None else f" <{source.slice(lens.about)}>")
        for lens in lenses(analyse(source, library))
    ]


def test_a_script_can_be_played_and_explained_and_each_command_has_candidates(reference: Catalog) -> None:
    text = "Idle_01\nlet X = WALK\nX with Upper-Body TALK\nchoose { TALK | repeat 2 {\nWAVE_HAND } }"
    assert offered(text, reference) == [
        "1 play: play to BVH",
        "1 explain: explain",
        "1 candidates: Idle_01 on Full-Body <Idle_01>",
        "3 candidates: 3 candidates on Full-Body, 2 candidates on Upper-Body <X with Upper-Body TALK>",
        "4 candidates: 2 candidates on Full-Body <TALK>",
        "5 candidates: Walk_03 on Full-Body <WAVE_HAND>",
    ]


@pytest.mark.parametrize("text", ["", "# nothing\n", "WLAK", "let X = WALK", "wait 2 sec"])
def test_where_no_command_can_be_played_nothing_is_offered(text: str, reference: Catalog) -> None:
    assert offered(text, reference) == []


@pytest.mark.parametrize("broken", ["WLAK", "IDLE with", "WALK for", "Upper-Body Upper-Body", "("])
def test_around_a_mistake_what_is_sound_is_offered_still(broken: str, reference: Catalog) -> None:
    assert offered(f"IDLE\n{broken}\nX\nlet X = TALK\n", reference) == [
        "1 play: play to BVH",
        "1 explain: explain",
        "1 candidates: 4 candidates on Full-Body <IDLE>",
        "3 candidates: 2 candidates on Full-Body <X>",
    ]


def test_without_a_library_nothing_is_offered() -> None:
    assert offered("WALK", None) == []


@given(TEXTS, TEXTS, TEXTS)
def test_after_an_edit_it_is_what_a_text_afresh_offers(
    left_hand_always: Catalog, before: str, new: str, after: str
) -> None:
    edited = analyse_again(analyse(Source(before + after), left_hand_always), Source(before + new + after))
    assert lenses(edited) == lenses(analyse(edited.source, left_hand_always))
