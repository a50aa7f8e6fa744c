"""What may be playing where one writes, whatever stands there already."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse, analyse_again, analyse_for
from mlmg_lang.ide.completion import Surroundings, complete
from mlmg_lang.ide.cursor import cursor_at
from mlmg_lang.ide.here import state_before, statement_start, tokens_around
from mlmg_lang.ide.offers import Offers
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source

WRITTEN = """let GREET(who,
    t = 2 sec) = who
    with Upper-Body WAVE for t
IDLE # first
WALK
with Upper-Body (TALK and
    not IDLE
    or WAVE)
repeat 2 {
    Walk_01; wait 2 sec
    choose {
        | GREET(WALK,
            t = 3 sec)
        | 3: IDLE
            once
    }
    end Upper-Body

}
"Walk_02" or TALK"""
CURSORS = range(len(WRITTEN) + 1)


def playing(text: str, library: Catalog, graph: str = "Full-Body") -> set[str]:
    """Return what may drive a graph before the statement at `|`."""
    offset = text.index("|")
    analysis = analyse(Source(text.replace("|", "", 1)), library)
    part = state_before(analysis, offset, Names(library)).state.parts.get(graph)
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
    assert {graph: part.motions for graph, part in state_before(again, len(text), names).state.parts.items()} == {
        graph: part.motions for graph, part in state_before(fresh, len(text), names).state.parts.items()
    }


def test_it_is_found_out_once_while_the_statement_is_written(reference):
    names = Names(reference)
    text = "IDLE\nrepeat 2 {\nWalk_01\n"
    analysis = analyse(Source(f"{text}W\nIDLE\n}}\n"), reference)
    first = state_before(analysis, len(text), names)
    again = analyse_again(analysis, Source(f"{text}WALK wi\nTALK\n}}\n"))
    assert state_before(again, len(text) + 7, names, first) is first
    other = analyse_again(again, Source(f"{text.replace('Walk_01', 'Walk_02')}WALK wi\nTALK\n}}\n"))
    assert set(state_before(other, len(text) + 7, names, first).state.parts["Full-Body"].motions) == {"Walk_02"}


def test_it_is_found_out_again_with_another_library_or_in_other_used_files(reference, left_hand):
    text = 'use "own.ms"\nstroll\n'

    class Own:
        def __init__(self, says):
            self.says = says

        def find(self, path, user):
            return Source(f"let stroll = {self.says}\n", path), ()

    one = analyse(Source(text), reference, files=Own("Walk_01"))
    known = state_before(one, len(text), Names(reference))
    two = analyse_for(Source(text), replace(one.question, files=Own("Walk_02")))
    assert set(state_before(two, len(text), Names(reference), known).state.parts["Full-Body"].motions) == {"Walk_02"}
    again = analyse_for(replace(Source(text), used=()), replace(one.question, files=Own("Walk_02")))
    same_question = replace(again, question=one.question)
    found = state_before(same_question, len(text), Names(reference), known)
    assert set(found.state.parts["Full-Body"].motions) == {"Walk_02"}


def test_the_statement_begins_where_its_first_word_does():
    text = "IDLE\nWALK\n  with Upper-Body TA"
    analysis = analyse(Source(text))
    assert statement_start(tokens_around(analysis, len(text)), len(text)) == text.index("WALK")


def test_what_is_around_says_of_a_text_that_is_being_written_what_all_of_it_says():
    whole = analyse(Source(WRITTEN))
    for end in CURSORS:
        for analysis in (whole, *(analyse(Source(text)) for text in (WRITTEN[:end], f"{WRITTEN[:end]}\n"))):
            near = cursor_at(tokens_around(analysis, end), end)
            assert near == cursor_at(tokenize(analysis.source), end), analysis.source.text


def test_a_line_end_behind_the_text_makes_no_difference(reference, in_order):
    names = Names(reference)

    def offered(text, offset):
        analysis = analyse(Source(text), reference)
        definitions, before = analysis.made.gathered.definitions, state_before(analysis, offset, names)
        around = Surroundings(names, definitions, before.state, Offers(names, in_order(names)))
        found = complete(cursor_at(tokens_around(analysis, offset), offset), offset, around)
        return found.span, found.found

    for end in CURSORS:
        assert offered(WRITTEN[:end], end) == offered(f"{WRITTEN[:end]}\n", end), WRITTEN[:end]
