"""What may be playing where one writes, whatever stands there already."""

from __future__ import annotations

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.here import state_before, statement_start, tokens_around
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source


def playing(text: str, library: Catalog, graph: str = "Full-Body") -> set[str]:
    """Return what may drive a graph before the statement at `|`."""
    offset = text.index("|")
    analysis = analyse(Source(text.replace("|", "", 1)), library)
    part = state_before(analysis, offset, Names(library)).parts.get(graph)
    return set() if part is None else set(part.motions)


@pytest.mark.parametrize(
    "text",
    [
        "IDLE\nWalk_01\n|",
        "IDLE\nWalk_01\n|TALK\nIDLE\n",
        "IDLE\nWalk_01; WLAK wi|th (",
        "IDLE\nrepeat 2 {\nWalk_01\n|\nwait 1 sec\n}\nIDLE\n",
        "IDLE\nWalk_01\nchoose {\n| |IDLE\n| TALK\n}\n",
    ],
)
def test_what_comes_before_says_what_is_playing(text, reference):
    assert playing(text, reference) == {"Walk_01"}


def test_at_the_beginning_it_is_what_the_character_starts_in(reference):
    assert playing("|", reference) == {reference.start}


def test_a_part_that_runs_is_playing_until_it_is_ended(reference):
    assert playing("Walk_01 with Upper-Body Talk_02 for 1 sec\n|", reference, "Upper-Body") == {"Talk_02"}
    assert playing("Walk_01 with Upper-Body Talk_02 for 1 sec\nend Upper-Body\n|", reference, "Upper-Body") == set()


def test_it_is_the_same_after_an_edit(reference):
    before = analyse(Source("IDLE\nWalk_01\nIDLE\n"), reference)
    text = "IDLE\nWalk_01\nIDLE\nx"
    again = analyse_again(before, Source(text))
    names = Names(reference)
    fresh = analyse(Source(text), reference)
    assert {graph: part.motions for graph, part in state_before(again, len(text), names).parts.items()} == {
        graph: part.motions for graph, part in state_before(fresh, len(text), names).parts.items()
    }


def test_the_statement_begins_where_its_first_word_does():
    text = "IDLE\nWALK\n  with Upper-Body TA"
    analysis = analyse(Source(text))
    assert statement_start(tokens_around(analysis, len(text)), len(text)) == text.index("WALK")
