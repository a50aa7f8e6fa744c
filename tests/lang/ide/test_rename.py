"""A definition or a parameter is given another name everywhere, or it is said why not."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mlmg_lang.diagnostics import has_errors
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.references import references
from mlmg_lang.ide.rename import Refusal, Renameable, prepare_rename, rename
from mlmg_lang.source import Source, Span

Marked = Callable[..., Any]


@pytest.fixture
def renamed(marked: Marked, edited: Callable[..., str]) -> Callable[..., dict[str, str] | str]:
    """Return a function: a text with a cursor, a new name -> the texts of all files that change, or the refusal."""

    def ask(text: str, new: str, library: Any = ..., **files: str) -> dict[str, str] | str:
        at = marked(text, **files) if library is ... else marked(text, library, **files)
        edits = rename(at.analysis, at.offset, new)
        if isinstance(edits, Refusal):
            return edits.why
        sources = {file.name: file.text for file in (at.analysis.source, *at.analysis.source.used)}
        return {name: edited(sources[name], own) for name, own in edits.items()}

    return ask


def test_a_definition_is_renamed_where_it_is_used_and_not_in_comments(renamed):
    assert renamed("let G = WALK # G\n(¦G) for 1 sec; repeat 2 {G}", "STROLL") == {
        "main.ms": "let STROLL = WALK # G\n(STROLL) for 1 sec; repeat 2 {STROLL}"
    }


def test_a_parameter_is_renamed_with_its_labels(renamed):
    text = "let G(x, t = 1 sec) = x for ¦t\nG(WALK, t = 2 sec)\nlet H(t) = t\nH(IDLE)"
    assert renamed(text, "length") == {
        "main.ms": "let G(x, length = 1 sec) = x for length\nG(WALK, length = 2 sec)\nlet H(t) = t\nH(IDLE)"
    }


def test_all_files_are_edited_that_use_the_name(renamed):
    changed = renamed('use "g.ms"\nHI¦\n', "走路", g='let HI = WALK\nlet A = "HI"', h="let HI = IDLE")
    assert changed == {"main.ms": 'use "g.ms"\n走路\n', "g.ms": "let 走路 = WALK\nlet A = 走路"}


def test_other_scripts_that_use_the_file_are_edited_too_and_each_file_once(marked):
    files = {"g": "let HI = WALK\nHI"}
    one = marked('use "g.ms"\n¦HI\n', **files)
    other = marked('use "g.ms"\n(HI)\n', name="other.ms", **files).analysis
    edits = rename(one.analysis, one.offset, "BYE", (other,))
    assert not isinstance(edits, Refusal)
    assert {name: [edit.span.start for edit in own] for name, own in edits.items()} == {
        "main.ms": [11],
        "g.ms": [4, 14],
        "other.ms": [12],
    }
    taken = marked('use "g.ms"\nlet BYE = IDLE\nBYE\n', name="other.ms", **files).analysis
    assert rename(one.analysis, one.offset, "BYE", (taken,)) == Refusal("there is a definition `BYE` already")


@pytest.mark.parametrize("place", ["¦G(x, t = 1 sec)", "G(x, ¦t = 1 sec)"])
def test_a_statement_that_cannot_be_read_is_not_edited_in_a_file_that_is_not_seen(marked, place):
    at = marked(f"let {place} = x for t", name="g.ms")
    text = at.analysis.source.text
    user, fine = (
        marked(f'use "g.ms"\n{said}\n', name=name, g=text).analysis
        for name, said in (("user.ms", "G(WALK, t = = 2)"), ("fine.ms", "G(WALK, t = 2 sec); IDLE for for"))
    )
    refused = Refusal("`G` stands in line 2 of user.ms, which cannot be read: mend that first")
    assert rename(at.analysis, at.offset, "H", (fine, user), {"g.ms"}) == refused
    for others, seen in (((fine, user), None), ((fine, user), {"g.ms", "user.ms"}), ((fine,), {"g.ms"})):
        edits = rename(at.analysis, at.offset, "H", others, seen)
        assert not isinstance(edits, Refusal)
        assert "fine.ms" in edits
    taken = marked('use "g.ms"\nlet H = IDLE\n', name="taken.ms", g=text).analysis
    said = rename(at.analysis, at.offset, "H", (taken,), {"g.ms"})
    assert said == Refusal("taken.ms: there is a definition `H` already")


@pytest.mark.parametrize(
    ("new", "written"),
    [
        *(("hand on hip", '"hand on hip"'), ('"hand on hip"', '"hand on hip"'), ('"PLAIN"', "PLAIN")),
        *(("3d", '"3d"'), ("sec", '"sec"'), ('a"b', '"a\\"b"'), ("e\u0301", "\u00e9"), (" PLAIN ", "PLAIN")),
    ],
)
def test_a_name_is_written_in_quotes_where_it_has_to_be_and_in_nfc(renamed, new, written):
    assert renamed("let ¦G = WALK\nG", new) == {"main.ms": f"let {written} = WALK\n{written}"}


def test_a_name_that_would_be_joined_to_a_word_keeps_its_quotes(renamed):
    assert renamed('let ¦"a b"= WALK\nrepeat 2 {"a b"for 1 sec}', "G") == {
        "main.ms": 'let G= WALK\nrepeat 2 {"G"for 1 sec}'
    }


@pytest.mark.parametrize(
    ("new", "why"),
    [
        ("", "a name cannot be empty"),
        ('"  "', "a name cannot be empty"),
        ("with", "`with` is a word of the language"),
        ("ONCE", "`ONCE` is a word of the language"),
        ("sub", "`sub` is a word of the language"),
        ('"open', '`"open` is not a whole name in quotes'),
        ("H", "there is a definition `H` already"),
        ("WALK", "`WALK` is a tag of the library"),
        ("Idle_01", "`Idle_01` is a motion of the library"),
        ("upper-body", "`Upper-Body` is a graph of the library"),
        ("walk01", "`walk01` means something else in line 3 already"),
        ("HM", "`HM` means something else in line 4 already"),
        ("x", "`x` is a parameter of `H`, which uses this definition"),
    ],
)
def test_a_name_that_cannot_be_is_refused_in_words(renamed, new, why):
    assert renamed("let ¦G = WALK\nlet H(x) = x or G\nwalk01\nHM\nH(G)", new) == why


def test_line_ends_and_signs_that_cannot_be_seen_are_refused(renamed):
    for new in ("a\nb", "a\u200bb", "a\tb"):
        assert "cannot be a name" in renamed("let ¦G = WALK\nG", new)


@pytest.mark.parametrize(
    ("new", "why"),
    [
        ("y", "`G` has a parameter `y` already"),
        ("walk01", "`walk01` means something else in `G` already"),
        ("H", "there is a definition `H` already"),
        ("TALK", "`TALK` is a tag of the library"),
        ("a b", "`a b` would have to stand in quotes, which parameters cannot"),
    ],
)
def test_a_parameter_cannot_take_a_name_that_means_something_there(renamed, new, why):
    assert renamed("let H = IDLE\nlet G(x, y) = ¦x or y or walk01\nG(WALK, H)", new) == why


def test_a_parameter_may_be_called_like_one_of_another_definition(renamed):
    assert renamed("let G(¦x) = x\nlet H(y) = y\nG(WALK); H(WALK)", "y") == {
        "main.ms": "let G(y) = y\nlet H(y) = y\nG(WALK); H(WALK)"
    }


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("¦", "there is no name here"),
        ("# ¦G", "there is no name here"),
        ("¦WALK", "`WALK` is a tag of the library; a script can rename what it defines alone"),
        ("end ¦Upper-Body", "`Upper-Body` is a graph of the library; a script can rename what it defines alone"),
        ("WALK with ¦Sub TALK", "`Sub` is a word of the language"),
        ('use "¦g.ms"', "`g.ms` is a file, not a name"),
        ("¦HM", "`HM` is not defined"),
    ],
)
def test_what_no_script_defines_is_not_renamed(marked, text, why):
    at = marked(text)
    assert prepare_rename(at.analysis, at.offset) == Refusal(why)
    assert rename(at.analysis, at.offset, "NEW") == Refusal(why)


def test_what_can_be_renamed_is_told_with_its_place_and_without_quotes(marked):
    at = marked('let G = WALK\nlet "a b" = G\n"a b¦"')
    assert prepare_rename(at.analysis, at.offset) == Renameable(Span(27, 32), "a b")


def test_the_same_name_again_changes_nothing(renamed):
    assert renamed("let ¦G = WALK\nG", "G") == {}


def test_statements_that_cannot_be_read_are_renamed_too(renamed):
    assert renamed("let ¦G = WALK\nG for for\nG with (", "H") == {"main.ms": "let H = WALK\nH for for\nH with ("}


# --- properties ------------------------------------------------------------------------------------------

LINES = (
    "let G = WALK or Walk_01",
    "let H(x, t = 2 sec) = x with Upper-Body (TALK or G) for t",
    "let I(x, y = G) = (x or y) with Sub TALK",
    "G for 1 sec",
    "H(G, t = 3 sec)",
    "H(x = I(G))",
    "I(IDLE) once",
    "repeat 2 { G; I(y = IDLE, x = G) }",
    "choose { G | 2: H(WALK) | }",
    "WALK with Upper-Body G",
    "I(G and WALK) # G",
    "走路 for G G",
)
NEW = ("STROLL", "走路", "hand on hip", "with care", "t", "x", "sec", "then", "loop", "G2", "a-b", 'q"q', "\u00e9", "H")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(st.sampled_from(LINES), min_size=1, max_size=8, unique=True),
    st.sampled_from(NEW),
    st.data(),
)
def test_a_name_that_is_given_back_leaves_the_text_as_it_was_and_between_all_plays_the_same(
    reference, edited, lines, new, data
):
    text = "\n".join(lines)
    before = analyse(Source(text), reference)
    offset = data.draw(st.integers(0, len(text)))
    old = prepare_rename(before, offset)
    edits = rename(before, offset, new)
    if isinstance(edits, Refusal) or isinstance(old, Refusal) or not edits:
        return
    (own,) = edits.values()
    places = references(before, offset)
    assert [edit.span for edit in own] == sorted(place.span for place in places)
    after = analyse_again(before, Source(edited(text, own)))
    assert has_errors(after.diagnostics) == has_errors(before.diagnostics)
    assert without_places(after.resolved) == without_places(before.resolved)
    back = rename(after, own[0].span.start, old.name)
    if isinstance(back, Refusal):
        # Words that cannot be read where they stand may be taken for another mistake by another name.
        assert has_errors(before.diagnostics)
    else:
        assert edited(after.source.text, back["<script>"]) == text


def without_places(value: Any) -> Any:
    """Return a value without its spans and sources."""
    if isinstance(value, Span | Source):
        return None
    if isinstance(value, tuple):
        return tuple(map(without_places, value))
    if is_dataclass(value):
        return (type(value), *(without_places(getattr(value, field.name)) for field in fields(value)))
    return value


def test_every_definition_is_among_its_own_references(reference):
    analysis = analyse(Source("\n".join(LINES)), reference)
    for let in analysis.definitions.lets.values():
        names = (let.name, *(parameter.name for parameter in let.parameters or ()))
        for name in names:
            spans = [place.span for place in references(analysis, name.span.end)]
            assert name.span in spans
            for span in spans:
                assert [place.span for place in references(analysis, span.start)] == spans
