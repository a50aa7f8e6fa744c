"""Whatever a text says and wherever the cursor is, an answer is given, and after edits the same as afresh."""

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mlmg_lang.front_end import Analysis, analyse, analyse_again
from mlmg_lang.ide.definition import definition
from mlmg_lang.ide.hover import hover
from mlmg_lang.ide.links import document_links
from mlmg_lang.ide.references import highlights, references
from mlmg_lang.ide.rename import Refusal, prepare_rename, rename
from mlmg_lang.ide.signature import signature_help
from mlmg_lang.source import Source

LINES = (
    *(
        "let G(x, t = 2 sec) = x with Sub TALK for t",
        "let 走 = G(WALK)",
        "let G = WALK",
        'let "a b"(y = G) = y',
        "let x",
    ),
    *(
        "G(IDLE, t = 1 sec)",
        "G(",
        "G(x = 走, ",
        '"a b"(走)',
        "repeat 2 {",
        "}",
        "choose { G | 2: 走 }",
        "with Upper-Body",
    ),
    *(
        "end Upper-Body",
        "WALK for 2 cycles",
        "wait t",
        "走 for for G",
        '"a b',
        'use "g.ms"',
        'use "no.ms"',
        "HI 😀",
        ")",
    ),
    *("Upper-Body (G or Sub G)", "# G", "", "WALK\u2028G", "e\u0301 é", "G;G", "\tG\r", 'HI with"a b"', "let HI = HI2"),
)
TEXTS = st.lists(st.sampled_from(LINES), max_size=8).map("\n".join)
FEW_LINES = st.lists(st.sampled_from(LINES), max_size=4).map("\n".join)


class Folder:
    """One file of definitions, one of them in terms of another."""

    def find(self, path: str, user: str) -> Any:
        if path != "g.ms":
            return f"there is no file `{path}`"
        return Source("let HI = HI2 # HI\nlet HI2(z = WALK) = z with Upper-Body TALK\nlet x for", path), ()


def answers(analysis: Analysis, offset: int) -> tuple[object, ...]:
    """Return all that is said of a place."""
    asked = (hover, definition, references, highlights, prepare_rename, signature_help)
    return (*(ask(analysis, offset) for ask in asked), rename(analysis, offset, "NEW 走"), document_links(analysis))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(FEW_LINES, FEW_LINES, FEW_LINES, FEW_LINES)
def test_after_an_edit_all_is_said_as_of_the_text_afresh(reference, before, old, new, after):
    files = Folder()
    first = analyse(Source(f"{before}\n{old}\n{after}"), reference, files=files)
    text = Source(f"{before}\n{new}\n{after}")
    again, fresh = analyse_again(first, text), analyse(text, reference, files=files)
    for offset in range(fresh.source.end):
        assert answers(again, offset) == answers(fresh, offset), offset


@pytest.mark.parametrize("known", [True, False])
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=TEXTS)
def test_places_hold_the_name_that_was_asked_for(reference, known, text):
    analysis = analyse(Source(text), reference if known else None, files=Folder())
    texts = {file.name: file.text for file in (analysis.source, *analysis.source.used)}
    for offset in range(analysis.source.end):
        found = prepare_rename(analysis, offset)
        if isinstance(found, Refusal):
            continue
        assert found.span.start <= offset <= found.span.end
        there = definition(analysis, offset)
        assert there is not None
        assert there.span == found.span
        places = references(analysis, offset)
        assert there.places[0] in places
        for place in places:
            assert texts[place.file][place.span.start : place.span.end].strip('"') == found.name
        assert {one.span for one in highlights(analysis, offset)} >= {found.span}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(st.sampled_from('GW走"\\(){}|;:,=#-_ \n\r\t\u2028\u0301😀10.s'), max_size=30))
def test_of_any_signs_something_or_nothing_is_said(reference, text):
    analysis = analyse(Source(f"let G = WALK\nlet W(s) = s\n{text}"), reference)
    for offset in range(len(analysis.source.text) + 1):
        answers(analysis, offset)
