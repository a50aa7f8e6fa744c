"""What can be rewritten without another meaning: `ide.actions`."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import Analysis, analyse, analyse_again
from mlmg_lang.ide.actions import Action, Kind, actions
from mlmg_lang.source import Source, Span

LINES = (
    *("let X = WALK\n", "let Y = X or (TALK)\n", "let Z = WALK with Upper-Body TALK\n", "let W = Walk_01 # so\n"),
    *("let G(x, t = 2 sec) = x with Upper-Body WAVE_HAND for t\n", "let H(x) = x and not Y\n", "let N = not H(X)\n"),
    *(
        "let R(Y) = H(Y) or X\n",
        "let O = Talk_01 once\n",
        "let Q(t) = WALK for t\n",
        "let S = Upper-Body\n (TALK or X)\n",
    ),
    *(
        "X\n",
        "Y for 2 sec\n",
        "Z; X\n",
        "W\n",
        "G(WALK)\n",
        "G(X or IDLE, t = 1 sec)\n",
        "G(Y, 30 frames)\n",
        "H(WALK)\n",
    ),
    *("let K = WALK with Sub (TALK or Y)\n", "K with Left-Hand not IDLE\n", "K with Sub WAVE with IDLE\n"),
    *("N\n", "R(IDLE)\n", "O\n", "Q(1 cycles)\n", "S\n", "Upper-Body X\n", "Upper-Body (Y)\n", "X with Upper-Body Y\n"),
    *("let V = IDLE; V\n", "IDLE; let U = Walk_01; U for 1 sec; let T = U\n", "T\n", "Upper-Body (TALK or not IDLE)\n"),
    *("WALK\n", "Walk_01\n", "walk01 # c\n", "WALK with Sub TALK for 2 sec\n", "WALK and TALK\n", "TALK and IDLE\n"),
    *("SWING_HAND\n", "not (WALK or TALK)\n", "(IDLE\nor WALK)\n  with TALK # c\n", "repeat 2 { IDLE; X or WALK }\n"),
    *("choose { WALK with\n Upper-Body (TALK) | 2: Z }\n", "wait 2 sec\n", "end Upper-Body\n", "# c\n", "\n", "WLAK\n"),
)
SCRIPTS = st.lists(st.sampled_from(LINES), max_size=8).map("".join)
BROKEN = st.text(alphabet='let X(x)=x\nfor with{}|;"#1 sec', max_size=60)


def plain(value: Any) -> Any:
    """Return a value without the places in it."""
    if isinstance(value, tuple):
        return tuple(map(plain, value))
    if not is_dataclass(value):
        return value
    kept = [field.name for field in fields(value) if field.name not in ("span", "source", "because")]
    return (type(value).__name__, *(plain(getattr(value, name)) for name in kept))


def changed(text: str, action: Action) -> str:
    for edit in reversed(action.edits):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    return text


def at(text: str, marks: str = "¦") -> tuple[str, Span]:
    """Return a text without its marks, and the stretch between them, or the place of the only one."""
    first, _, rest = text.partition(marks)
    inside, found, _ = rest.partition(marks)
    return first + rest.replace(marks, ""), Span(len(first), len(first) + (len(inside) if found else 0))


def results(text: str, library: Catalog, kind: Kind) -> list[str]:
    text, within = at(text)
    return [changed(text, one) for one in actions(analyse(Source(text), library), within) if one.kind is kind]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WA¦LK for 2 sec", "Full-Body WALK for 2 sec"),
        ("SWING_¦HAND", "Upper-Body SWING_HAND"),
        ("WALK with TALK or ID¦LE", "WALK with TALK or Upper-Body IDLE"),
        ("not WA¦LK", "not Full-Body WALK"),
        ("repeat 2 { WALK¦ }", "repeat 2 { Full-Body WALK }"),
        ("Walk_¦01", None),
        ("Upper-Body TA¦LK", None),
        ("WALK and TA¦LK", None),
        ("let X = WA¦LK\nX", None),
        ("let X = WALK\nX¦", None),
    ],
)
def test_a_name_is_qualified_with_the_graph_that_it_is_found_on(
    text: str, expected: str | None, reference: Catalog
) -> None:
    assert results(text, reference, Kind.QUALIFY) == ([] if expected is None else [expected])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("IDLE\n¦WALK or TALK¦ for 2 sec\n", "IDLE\nlet PART = WALK or TALK\nPART for 2 sec\n"),
        ("# c\nWALK with ¦ (TALK or IDLE)¦\n", "# c\nlet PART = (TALK or IDLE)\nWALK with  PART\n"),
        (
            "# head\n\n# about\n# it\n¦WALK or TALK¦ for 2 sec",
            "# head\n\nlet PART = WALK or TALK\n# about\n# it\nPART for 2 sec",
        ),
        ("# head\n\n\n  ¦WALK or TALK¦", "# head\n\n\n  let PART = WALK or TALK\n  PART"),
        ("IDLE # so\n# c\n¦not WALK¦", "IDLE # so\nlet PART = not WALK\n# c\nPART"),
        (
            "\ufeff# head\r\n# mlmg: ignore[MS020]\r\nwalk01 or ¦not WALK¦",
            "\ufeff# head\r\nlet PART = not WALK\r\n# mlmg: ignore[MS020]\r\nwalk01 or PART",
        ),
        ("\ufeff¦not WALK¦", "\ufefflet PART = not WALK\nPART"),
        ("repeat 2 {\n  IDLE\n}; ¦not WALK¦", "let PART = not WALK\nrepeat 2 {\n  IDLE\n}; PART"),
        ("WALK with Upper-Body ¦(TALK or IDLE)¦", "let PART = (TALK or IDLE)\nWALK with Upper-Body PART"),
        ("WALK with Sub(¦TALK or IDLE¦)", "let PART = TALK or IDLE\nWALK with Sub(PART)"),
        ("Upper-Body¦(TALK or IDLE)¦with IDLE", "let PART = (TALK or IDLE)\nUpper-Body PART with IDLE"),
        ("not¦(WALK)¦or not(TALK)", "let PART = (WALK)\nnot PART or not(TALK)"),
        ("Upper-Body (TALK or ¦not IDLE¦)", "let PART = not IDLE\nUpper-Body (TALK or PART)"),
        ("# c\n¦WALK for 3 sec\n¦", "# c\nlet PART = WALK for 3 sec\nPART\n"),
        (
            "repeat 2 { ¦WALK with Sub TALK once¦; IDLE }",
            "let PART = WALK with Sub TALK once\nrepeat 2 { PART; IDLE }",
        ),
        ("repeat 2 {\r\n  IDLE; ¦not WALK¦\r\n}", "let PART = not WALK\r\nrepeat 2 {\r\n  IDLE; PART\r\n}"),
        ("let part = WALK\npart\n¦Upper-Body TALK¦", "let part = WALK\npart\nlet PART_2 = Upper-Body TALK\nPART_2"),
        ("¦WALK¦", None),
        ("WALK with ¦Sub TALK¦", "let PART = Sub TALK\nWALK with PART"),
        ("WALK with Upper-Body ¦(Sub TALK)¦", "let PART = (Sub TALK)\nWALK with Upper-Body PART"),
        ("WLAK with ¦Sub TALK¦", None),
        (
            "let G(x) = x with Upper-Body ¦(TALK or IDLE)¦\nG(WALK)",
            "let PART = (TALK or IDLE)\nlet G(x) = x with Upper-Body PART\nG(WALK)",
        ),
        ("IDLE; let G = ¦not WALK¦ for 2 sec; G", "let PART = not WALK\nIDLE; let G = PART for 2 sec; G"),
        ("# c\nlet G = WALK with ¦Sub TALK¦\nG", "# c\nlet PART = Sub TALK\nlet G = WALK with PART\nG"),
        ("let G = ¦WALK for 2 sec¦\nG", None),
        ("let G(x) = x with ¦Sub TALK¦\nG(WALK)", None),
        ("let G(x) = WALK and ¦(not x)¦\nG(IDLE)", None),
        (
            "let G(walk) = IDLE or ¦(WALK or TALK)¦\nG(IDLE)",
            "let PART = (WALK or TALK)\nlet G(walk) = IDLE or PART\nG(IDLE)",
        ),
        ("¦WALK or¦ TALK", None),
        ("let G(x) = ¦x or WALK¦\nG(IDLE)", None),
        ("let O = WALK once\n¦(O)¦", None),
        ("let X = WALK for 2 sec\n¦X for 3 sec¦", None),
        ("let G(x) = x\nG¦(WALK or TALK)¦", None),
        ("¦wait 2 sec¦", None),
        ("¦¦WALK or TALK", None),
    ],
)
def test_what_is_selected_of_a_command_becomes_a_definition(
    text: str, expected: str | None, reference: Catalog
) -> None:
    assert results(text, reference, Kind.EXTRACT) == ([] if expected is None else [expected])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("let X = WALK or TALK\nX¦ for 2 sec\nX", ["let X = WALK or TALK\nWALK or TALK for 2 sec\nX"]),
        ("let X¦ = WALK or TALK\nX for 2 sec\nUpper-Body X", ["WALK or TALK for 2 sec\nUpper-Body (WALK or TALK)"]),
        ("let X¦ = WALK; X", ["(WALK)"]),
        ("IDLE; let X¦ = WALK; X", ["IDLE; (WALK)"]),
        ("X; let X¦ = WALK ;  # c\nIDLE", ["(WALK)  # c\nIDLE"]),
        ("X ; let X¦ = WALK", ["(WALK)"]),
        ("X\n  let X¦ = WALK ; \r\nIDLE", ["(WALK)\nIDLE"]),
        ("\ufefflet X¦ = WALK  # c\nX", ["\ufeff# c\n(WALK)"]),
        (
            "let G(x, t = 2 sec) = Upper-Body x for t\nG¦(TALK or IDLE)",
            ["let G(x, t = 2 sec) = Upper-Body x for t\nUpper-Body (TALK or IDLE) for 2 sec"],
        ),
        ("let G¦(x, y) = x with y\nG(y = TALK, x = not IDLE)", ["(not IDLE) with TALK"]),
        ("let X = WALK\nlet F(WALK) = WALK or X¦\nF(IDLE)", []),
        ("let O = WALK once\nO¦", ["let O = WALK once\nWALK once"]),
        ("let X¦ = WALK\nX\nlet = )", []),
        ("let X¦ = WALK\nIDLE", []),
        ("let X¦ = WALK\nX\nlet X = IDLE", []),
        ("let G¦(x) = x\nG(G(WALK))", []),
        ("let X = X¦ or WALK\nX", []),
        ("WA¦LK", []),
    ],
)
def test_what_a_definition_says_is_put_in(text: str, expected: list[str], reference: Catalog) -> None:
    assert results(text, reference, Kind.INLINE) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("let ¦A = WALK\nlet B = A or TALK\n", ["let A = WALK\nlet B = (WALK) or TALK\n"]),
        ("# c\nlet B = A; let A¦ = WALK", ["# c\nlet B = (WALK); let A = WALK"]),
        ("let A = WALK\nlet ¦B = A\n", []),
    ],
)
def test_a_definition_stays_in_a_script_of_nothing_else(text: str, expected: list[str], reference: Catalog) -> None:
    assert results(text, reference, Kind.INLINE) == expected


def test_a_definition_stays_in_a_script_that_another_uses(reference: Catalog) -> None:
    text, within = at("let ¦A = WALK\nA for 2 sec\n")
    own = analyse(Source(text, "g.ms"), reference)
    titles = [[one.title for one in actions(own, within, used)] for used in (("f.ms", "g.ms"), ("f.ms",))]
    assert titles == [["put in what `A` says everywhere"], ["put in what `A` says everywhere, and take it out"]]
    assert changed(text, actions(own, within, ("g.ms",))[0]) == "let A = WALK\n(WALK) for 2 sec\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("¦walk01", "walk01  # mlmg: ignore[MS020]"),
        ("¦walk01\r\nIDLE", "walk01  # mlmg: ignore[MS020]\r\nIDLE"),
        ("¦walk01 # so", "walk01 # mlmg: ignore[MS020] so"),
        ("¦walk01 # mlmg: ignore[MS047] so", "walk01 # mlmg: ignore[MS047, MS020] so"),
        ("IDLE with\n  ¦talk01\n  for 2 sec", "IDLE with\n  talk01  # mlmg: ignore[MS020]\n  for 2 sec"),
        ("¦WLAK", None),
        ("¦WALK # mlmg: ignore[MS020]", None),
    ],
)
def test_a_comment_asks_for_silence_about_a_diagnostic(text: str, expected: str | None, reference: Catalog) -> None:
    text, within = at(text)
    wanted = [one for one in actions(analyse(Source(text), reference), within) if one.title == "ignore `MS020` here"]
    assert [changed(text, one) for one in wanted] == ([] if expected is None else [expected])


def offered(text: str, library: Catalog) -> Iterator[tuple[Analysis, Action]]:
    """Yield every action at every name, and for every selection of a part."""
    analysis = analyse(Source(text), library)
    ends = sorted({place for token in analysis.tokens for place in (token.span.start, token.span.end)})
    spans = {Span(start, end) for start in ends for end in ends if start <= end <= start + 40}
    once = {(one.title, one.edits): one for span in sorted(spans) for one in actions(analysis, span)}
    yield from ((analysis, one) for one in once.values())


@given(SCRIPTS)
def test_whatever_is_chosen_plays_the_same(left_hand_always: Catalog, text: str) -> None:
    for analysis, action in offered(text, left_hand_always):
        after = analyse(Source(changed(text, action)), left_hand_always)
        assert analysis.resolved is None or plain(after.resolved) == plain(analysis.resolved), changed(text, action)


@given(SCRIPTS)
def test_what_is_to_be_silenced_is_told_no_longer(left_hand_always: Catalog, text: str) -> None:
    for analysis, action in offered(text, left_hand_always):
        if action.about is not None:
            after = analyse(Source(changed(text, action)), left_hand_always)
            assert len(after.diagnostics) == len(analysis.diagnostics) - 1, changed(text, action)


@given(st.one_of(SCRIPTS, BROKEN), st.integers(0, 90), st.integers(0, 90))
def test_in_any_text_edits_come_in_order_and_stay_inside(
    left_hand_always: Catalog, text: str, one: int, other: int
) -> None:
    for action in actions(analyse(Source(text), left_hand_always), Span(min(one, other), max(one, other))):
        ends = [0, *(edit.span.end for edit in action.edits)]
        assert all(end <= edit.span.start for end, edit in zip(ends, action.edits, strict=False))
        assert ends[-1] <= len(text)


@given(SCRIPTS, st.sampled_from(LINES), SCRIPTS, st.integers(0, 200))
def test_after_an_edit_the_same_is_offered_as_in_a_text_afresh(
    left_hand_always: Catalog, before: str, new: str, after: str, offset: int
) -> None:
    edited = analyse_again(analyse(Source(before + after), left_hand_always), Source(before + new + after))
    afresh, within = analyse(edited.source, left_hand_always), Span(offset, offset)
    assert actions(edited, within) == actions(afresh, within)
