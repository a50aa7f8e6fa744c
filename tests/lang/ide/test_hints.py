"""Small words between those of a script: `ide.hints`."""

from dataclasses import dataclass, field, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import Analysis, analyse, analyse_again
from mlmg_lang.ide.hints import ALL, Going, Hint, Kind, Meanings, Outlook, goings, piece_hints
from mlmg_lang.ide.touching import pieces_touching
from mlmg_lang.planning.estimate import Estimate, exactly
from mlmg_lang.source import Source, Span

TEXTS = st.text(alphabet="let G(x)=for 2ms cycles\n;{}with", max_size=80)
GREET = "let GREET(who, t = 2 sec) = who with Upper-Body WAVE_HAND for t\n"


@dataclass
class Said:
    """What a test says of how commands go, by where they begin."""

    goings: dict[int, Going] = field(default_factory=dict)

    def going(self, command: Span) -> Going | None:
        return self.goings.get(command.start)


def hints(analysis: Analysis, within: Span, outlook: Outlook | None = None, kinds: frozenset[Kind] = ALL) -> list[Hint]:
    """Return the hints in a stretch of a script, put together of those of its pieces."""
    found: list[Hint] = []
    for piece, further in pieces_touching(analysis, within):
        start = piece.address + further
        text = analysis.source.text[start : start + piece.size]
        own = piece_hints(piece, text, Meanings.of(analysis), goings(piece, start, outlook), kinds)
        found += (replace(hint, offset=hint.offset + start) for hint in own)
    return [hint for hint in found if within.start <= hint.offset <= within.end]


def hinted(text: str, library: Catalog | None, outlook: Outlook | None = None, kinds: frozenset[Kind] = ALL) -> str:
    """Return a script with its hints in it."""
    for hint in reversed(hints(analyse(Source(text), library), Span(0, len(text)), outlook, kinds)):
        shown = f"<{hint.label}>" + " " * hint.before
        text = text[: hint.offset] + shown + text[hint.offset :]
    return text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WALK for 10 sec", "WALK for 10 sec"),
        ("WALK for 500 ms", "WALK for 500 ms<= 0.5 sec>"),
        ("WALK for 1.5min", "WALK for 1.5min<= 90 sec>"),
        ("WALK for 45 frames", "WALK for 45 frames<= 1.5 sec>"),
        ("WALK for 3 s", "WALK for 3 s<= 3 sec>"),
        ("wait 2 cycles", "wait 2 cycles<passes of the clip>"),
        ("repeat 2 { WALK for 1 min }", "repeat 2 { WALK for 1 min<= 60 sec> }"),
        (GREET + "GREET(WALK, 1 min)", GREET + "GREET(<who => WALK, <t => 1 min<= 60 sec>)"),
        (GREET + "GREET(WALK, t = 3 sec)", GREET + "GREET(<who => WALK, t = 3 sec)"),
        ("let F(x) = x\nlet H(x) = F(x)\n", "let F(x) = x\nlet H(x) = F(x)\n"),
        ("Upper-Body (TALK)", "Upper-Body (TALK)"),
        ("WALK for 10 sec for 3 min with", "WALK for 10 sec for 3 min with"),
    ],
)
def test_units_and_parameters_are_spelled_out(text: str, expected: str, reference: Catalog) -> None:
    assert hinted(text, reference) == expected


def test_frames_are_not_spelled_out_where_nobody_knows_how_long_they_are() -> None:
    assert hinted("WALK for 45 frames", None) == "WALK for 45 frames"


def test_what_is_taken_and_when_it_arrives_stands_behind_a_command(reference: Catalog) -> None:
    going = Going((("Full-Body", "Walk_01"), ("Upper-Body", "Talk_01")), True, exactly(3.04))
    guess = Going((("Full-Body", "Idle_02"),), False, None)
    outlook = Said({5: going, 31: guess})
    text = "IDLE\nWALK with Upper-Body TALK\nIDLE"
    expected = "IDLE\nWALK with Upper-Body TALK<Walk_01 with Talk_01><at 3 sec>\nIDLE<~ Idle_02>"
    assert hinted(text, reference, outlook) == expected
    told = hints(analyse(Source(text), reference), Span(0, len(text)), outlook)
    assert [one.explanation for one in told] == [
        "Walk_01 on Full-Body, Talk_01 on Upper-Body",
        "all parts have arrived at 3 sec from the beginning",
        "probably Idle_02 on Full-Body",
    ]


@pytest.mark.parametrize(
    ("arrives", "label", "explanation"),
    [
        (Estimate(3.0, 2.96, 3.04), "at 3 sec", "all parts have arrived at 3 sec"),
        (
            Estimate(12.1, 11.2, 12.3),
            "~ at 12.1 sec",
            "all parts have probably arrived at about 12.1 sec (11.2 to 12.3)",
        ),
        (Estimate(11.7, 1.7, 21.8), "~ at 1 to 22 sec", "all parts have probably arrived between 1.7 and 21.8 sec"),
        (Estimate(3.1, 3.0, 5.0), "~ at 3 to 5 sec", "all parts have probably arrived between 3 and 5 sec"),
    ],
)
def test_when_it_arrives_is_as_sure_as_it_is_said(
    arrives: Estimate, label: str, explanation: str, reference: Catalog
) -> None:
    outlook = Said({0: Going((("Full-Body", "Walk_01"),), True, arrives)})
    (hint,) = hints(analyse(Source("Walk_01"), reference), Span(0, 7), outlook)
    assert (hint.label, hint.explanation) == (label, f"{explanation} from the beginning")


def test_what_is_written_is_not_said_again(reference: Catalog) -> None:
    going = Going((("Full-Body", "Walk_01"),), True, exactly(2.0))
    assert hinted("Walk_01 for 1 min", reference, Said({0: going})) == "Walk_01 for 1 min<= 60 sec><at 2 sec>"


def test_each_kind_can_be_had_by_itself(reference: Catalog) -> None:
    text = GREET + "GREET(WALK, 1 min)"
    outlook = Said({len(GREET): Going((("Full-Body", "Walk_01"),), True, exactly(1.5))})
    by_kind = {
        Kind.MOTIONS: "GREET(WALK, 1 min)<Walk_01>",
        Kind.ARRIVALS: "GREET(WALK, 1 min)<at 1.5 sec>",
        Kind.UNITS: "GREET(WALK, 1 min<= 60 sec>)",
        Kind.PARAMETERS: "GREET(<who => WALK, <t => 1 min)",
    }
    for kind, expected in by_kind.items():
        assert hinted(text, reference, outlook, frozenset({kind})) == GREET + expected


@given(TEXTS, TEXTS, TEXTS, st.integers(0, 160), st.integers(0, 160))
def test_those_in_a_stretch_after_an_edit_are_those_of_the_text_afresh(
    before: str, new: str, after: str, one: int, other: int
) -> None:
    edited = analyse_again(analyse(Source(f"{before}\n{after}")), Source(f"{before}\n{new}\n{after}"))
    text, within = edited.source.text, Span(min(one, other), max(one, other))
    everywhere = hints(analyse(edited.source), Span(0, len(text)))
    assert hints(edited, within) == [hint for hint in everywhere if within.start <= hint.offset <= within.end]
