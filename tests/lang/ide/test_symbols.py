"""The outline of a script, and the definitions of several: `ide.symbols`."""

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.symbols import Found, LibraryName, Symbol, document_symbols, workspace_symbols
from mlmg_lang.source import Source

TEXTS = st.text(alphabet='let G(x)={repeat 2choose}|1:\n;use "a.ms"end', max_size=80)


class OneFile:
    """A folder with one file of definitions in it."""

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]]:
        return Source("# 走\nlet WAVE_BACK(x) = x with Sub WAVE_HAND\n", path), ()


def lines(text: str, symbols: tuple[Symbol, ...], depth: int = 0) -> list[str]:
    found = []
    for one in symbols:
        shown = text[one.selection.start : one.selection.end]
        found.append(f"{'  ' * depth}{one.kind}: {one.name} [{one.detail}] <{' '.join(shown.split())}>")
        found += lines(text, one.children, depth + 1)
    return found


def test_an_outline_has_definitions_files_blocks_and_commands_in_their_order() -> None:
    text = """use "a.ms"
let GREET(x, t = 2 sec) = x
    with Upper-Body WAVE_HAND for t
repeat 2 {
    IDLE
    choose { 3: wait 1 sec | GREET(WALK); end Upper-Body }
}
"""
    assert lines(text, document_symbols(analyse(Source(text)))) == [
        "file: a.ms [use] <" + '"a.ms">',
        "definition: GREET [x with Upper-Body WAVE_HAND for t] <GREET>",
        "  parameter: x [] <x>",
        "  parameter: t [= 2 sec] <t>",
        "block: repeat 2 [] <repeat 2>",
        "  command: IDLE [] <IDLE>",
        "  block: choose [] <choose>",
        "    branch: branch 1 [weight 3] <3: wait 1 sec>",
        "      command: wait 1 sec [] <wait 1 sec>",
        "    branch: branch 2 [] <GREET(WALK); end Upper-Body>",
        "      command: GREET(WALK) [] <GREET(WALK)>",
        "      command: end Upper-Body [] <end Upper-Body>",
    ]


def test_of_what_is_broken_that_is_listed_which_could_be_read() -> None:
    text = "WALK with with\nIDLE\nlet = \nTALK"
    assert [one.name for one in document_symbols(analyse(Source(text)))] == ["WALK with with", "IDLE", "TALK"]


def test_a_long_command_is_cut_short() -> None:
    text = " or ".join(["WALK"] * 40)
    (symbol,) = document_symbols(analyse(Source(text)))
    assert len(symbol.name) <= 60
    assert symbol.name.endswith("...")
    assert symbol.span.end == len(text)


@given(TEXTS)
def test_of_any_text_symbols_hold_what_is_in_them_and_come_in_order(text: str) -> None:
    def check(symbols: tuple[Symbol, ...], start: int, end: int) -> None:
        for one in symbols:
            assert start <= one.span.start <= one.selection.start <= one.selection.end <= one.span.end <= end
            check(one.children, one.span.start, one.span.end)
            start = one.span.end

    check(document_symbols(analyse(Source(text))), 0, len(text))


@given(TEXTS, TEXTS, TEXTS)
def test_after_an_edit_symbols_are_those_of_the_text_afresh(before: str, new: str, after: str) -> None:
    edited = analyse_again(analyse(Source(f"{before}\n{after}")), Source(f"{before}\n{new}\n{after}"))
    assert document_symbols(edited) == document_symbols(analyse(edited.source))


def test_definitions_of_several_scripts_are_found_by_their_letters(reference: Catalog) -> None:
    one = analyse(Source("let WALK_BY = WALK\nlet BOW_LOW = IDLE", "one.ms"), reference)
    other = analyse(Source("let BYE = IDLE\n", "other.ms"), reference)
    told = workspace_symbols([one, other], "by")
    assert [(found.symbol.name, found.file) for found in told if isinstance(found, Found)] == [
        ("BYE", "other.ms"),
        ("WALK_BY", "one.ms"),
    ]
    assert len(workspace_symbols([one, other], "")) == 3


def test_a_definition_in_a_used_file_has_its_place_there_and_is_listed_once() -> None:
    using = 'use "gestures.ms"\nWAVE_BACK(IDLE)'
    scripts = [analyse(Source(text), files=OneFile()) for text in (using, f"IDLE\n{using}")]
    (found,) = workspace_symbols(scripts, "wave")
    assert isinstance(found, Found)
    assert found.file == "gestures.ms"
    assert (found.symbol.selection.start, found.symbol.detail) == (8, "x with Sub WAVE_HAND")


def test_names_of_libraries_are_looked_among_too_and_only_the_likeliest_are_returned() -> None:
    script = analyse(Source("let slow_walk = WALK\nlet walk_off = WALK", "one.ms"))
    names = [LibraryName("WALK", True), LibraryName("Walk_01", False)]
    found = workspace_symbols([script], "walk", names)
    told = [one.name if isinstance(one, LibraryName) else one.symbol.name for one in found]
    assert told == ["WALK", "walk_off", "Walk_01", "slow_walk"]
    assert workspace_symbols([script], "walk", names, most=2) == found[:2]
