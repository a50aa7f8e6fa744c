"""What the edits make of a script. (That each mends what it is offered for is tested with the wrong scripts.)"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source

Fixed = Callable[..., str]


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK FOR 10 SEC", "WALK for 10 sec"),
        ("WALK WITH Upper-Body TALK For 2 sec", "WALK with Upper-Body TALK for 2 sec"),
        ("END with TALK FOR 10 sec", "END with TALK for 10 sec"),
        ("WALK 10 sec", "WALK for 10 sec"),
        ("WALK for .5 sec", "WALK for 0.5 sec"),
        ("WALK for 1,5 sec", "WALK for 1.5 sec"),
        ("WALK for 1 min 30 sec", "WALK for 90 sec"),
        ("WALK for 1.5 sec 250 ms", "WALK for 1.75 sec"),
        ("WALK for 10", "WALK for 10 sec"),
        ("WALK for 10 secs", "WALK for 10 sec"),
        ("wait for 10 sec", "wait 10 sec"),
        ("WALK for 10 sec with Upper-Body TALK", "WALK with Upper-Body TALK for 10 sec"),
        ("WALK whit Upper-Body TALK", "WALK with Upper-Body TALK"),
        ("WALK Upper-Body TALK", "WALK with Upper-Body TALK"),
        ("WALK & TALK", "WALK and TALK"),
        ("WALK + TALK", "WALK with TALK"),
        ("WALK for 1 sec -> IDLE for 1 sec", "WALK for 1 sec ; IDLE for 1 sec"),
        ("WALK for 1 sec // a stroll", "WALK for 1 sec # a stroll"),
        ("WALK for 1 sec.", "WALK for 1 sec"),
        ("WALK with with TALK", "WALK with TALK"),
        ("WALK for10 sec", "WALK for 10 sec"),
        ("WALK for 1:30 min", "WALK for 90 sec"),
        ("3 sec WALK", "WALK for 3 sec"),
        ("3 sec", "wait 3 sec"),
        ("\u201cWALK\u201d", "WALK"),
        ("\u201eto\u201c", '"to"'),
        ("use gestures", 'use "gestures.ms"'),
        ("let X WALK\nX for 2 sec", "let X = WALK\nX for 2 sec"),
        ("!WALK", "not WALK"),
        ("WALK with (Upper-Body TALK", "WALK with (Upper-Body TALK)"),
        ("WALK)", "WALK"),
        ("Upper-Body not TALK", "not Upper-Body TALK"),
        ("WALK not TALK", "WALK and not TALK"),
        ("WALK（TALK） for 3 sec", "WALK(TALK) for 3 sec"),
        ("Upper--Body", "Upper-Body"),
        ("3d_walk", '"3d_walk"'),
        ("hand😀", '"hand😀"'),
        ("（WALK）", "(WALK)"),
        ('"hand on hip', '"hand on hip"'),
        ('"hand on hip for 3 sec', '"hand on hip" for 3 sec'),
        ('"Walk_01  # a comment', '"Walk_01"  # a comment'),
        ('"standing forward', '"standing forward"'),
        ('"C:\\new"', '"C:\\\\new"'),
        ("TALK with to", 'TALK with "to"'),
        ("repeat 2\n{ WALK }", "repeat 2 { WALK }"),
        ("WALK for ten sec", "WALK for 10 sec"),
    ],
)
def test_a_script_is_mended_as_its_writer_would(script: str, right: str, fixed: Fixed) -> None:
    assert fixed(script) == right


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK ONCE", "WALK once"),
        ("END Upper-Body", "end Upper-Body"),
        ("walk01 with upper_body talk", "Walk_01 with Upper-Body TALK"),
        ("WLAK with Uper-Body TLAK", "WALK with Upper-Body TALK"),
        ("TALK Upper-Body", "Upper-Body TALK"),
        ("WALK TALK", "WALK with TALK"),
        ("Idle_02 with Upper-Body TALK", "IDLE with Upper-Body TALK"),
        ("Upper-Body WALK", "Upper-Body SWING_HAND"),
        ("WALK with sub talk", "WALK with Sub TALK"),
    ],
)
def test_names_are_mended_as_the_library_spells_them(script: str, right: str, fixed: Fixed, reference: Any) -> None:
    assert fixed(script, reference) == right


def test_a_name_that_needs_quotes_is_offered_in_quotes(catalog: Any, fixed: Fixed) -> None:
    library = catalog({"Body": {'hand on "hip"': (), "with": ()}}, {}, start="with")
    assert fixed('"hand_on_hip"', library) == '"hand on \\"hip\\""'
    assert fixed("WITH", library) == '"with"'


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("WALK with Sub WAVE for 2 sec", "WALK with Left-Hand WAVE for 2 sec"),
        ("WALK with upper-body wave", "WALK with Left-Hand WAVE"),
        ("let G(x) = WALK with Upper-Body x\nG(WAVE)", "let G(x) = WALK with Upper-Body x\nG(WAVE_HAND)"),
    ],
)
def test_what_is_on_another_graph_is_said_to_be_on_that(script: str, right: str, fixed: Fixed, left_hand: Any) -> None:
    assert fixed(script, left_hand) == right


def test_a_graph_that_the_command_has_named_already_is_not_offered(fixed: Fixed, hands: Any) -> None:
    script = "WALK with Right-Hand POINT with Left-Hand POINT"
    assert fixed(script, hands) == script


@pytest.mark.parametrize(
    ("script", "right"),
    [
        ("Gehen schön for 2 sec", '"Gehen schön" for 2 sec'),
        ("gehen Schön once", '"Gehen schön" once'),
        ("sehr schnell laufen", '"Sehr schnell_laufen"'),
        ("Stehen with Linke\tHand  winken", 'Stehen with "Linke Hand" WINKEN'),
        ("let Gruß = Gehen schön\nGruß", 'let Gruß = "Gehen schön"\nGruß'),
        ("Stehen and Gehen schön", 'Stehen and "Gehen schön"'),
        (
            'let Gruß = "Gehen schön" with linke hand wave for 1 sec',
            'let Gruß = "Gehen schön" with "Linke Hand" wave for 1 sec',
        ),
    ],
)
def test_a_name_with_a_space_in_it_is_put_in_quotes(script: str, right: str, catalog: Any, fixed: Fixed) -> None:
    whole = {"Stehen": (), "Gehen schön": (), "Sehr schnell_laufen": ()}
    library = catalog({"Ganz": whole, "Linke Hand": {**whole, "Gruß": ("WINKEN",)}}, {"Linke Hand": "Ganz"}, "Stehen")
    assert fixed(script, library) == right


@pytest.mark.parametrize(
    ("script", "is_safe"),
    [
        ("WALK with Upper Body TALK", True),
        ("WALK with left hand wave", True),
        ("wave hand", False),
    ],
)
def test_to_leave_a_space_out_is_safe_where_no_word_beside_it_is_a_name(
    script: str, is_safe: bool, left_hand: Any
) -> None:
    (told,) = (one for one in analyse(Source(script), left_hand).diagnostics if "there is a space" in one.message)
    assert [fix.safe for fix in told.fixes] == [is_safe]


def test_words_of_which_some_are_no_part_of_a_name_are_left_to_be_told_of_by_themselves(left_hand: Any) -> None:
    told = analyse(Source("WALK with Upper Body Left-Hand WAVE"), left_hand).diagnostics
    assert [one.code for one in told] == ["MS010"]
