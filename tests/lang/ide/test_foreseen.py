"""How commands will probably go, as it is shown beside them: `ide.foreseen`."""

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.foreseen import Remembered, foreseen
from mlmg_lang.planning.estimate import Estimate, Playing, Trip, exactly
from mlmg_lang.planning.forecast import forecast
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source, Span


class OneSecond:
    """Every way takes a second; of several motions that are as soon, each is as likely."""

    def soonest(
        self, graph: str, playing: Playing, candidates: tuple[str, ...], driver: str, to_begin: bool = False
    ) -> tuple[Trip, ...]:
        return tuple(Trip(motion, 1.0 / len(candidates), exactly(1.0), 0.0) for motion in candidates)

    def on_the_spot(self, graph: str, motion: str) -> Trip:
        return Trip(motion, 1.0, exactly(0.75), 0.0, 1.0)

    def back(self, graph: str, playing: Playing, driver: str, above: Playing) -> Trip:
        return Trip(above.motion, 1.0, exactly(0.5), 0.25, 1.0)

    def similarity(self, graph: str, above: str, motion: str) -> float:
        return 1.0 if above == motion else 2.0

    def unlikeness(self, graph: str, above: str, motion: str) -> float:
        return 1.0

    def to_last_frame(self, driver: str, playing: Playing) -> Estimate:
        return exactly(7.0)

    def one_pass(self, driver: str, motion: str) -> Estimate:
        return exactly(5.0)

    def cycle(self, motion: str) -> Estimate:
        return exactly(10.0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Idle_01\nWalk_01 for 3 sec\nwait 2 sec\nTalk_01", [("Idle_01", 0), ("Walk_01", 1), ("Talk_01", 7)]),
        (
            "Idle_01\nrepeat 3 { Walk_01 for 2 sec; Talk_01 }\nIdle_01",
            [*zip(("Idle_01", "Walk_01", "Talk_01", "Idle_01"), (0, 1, 4, 13), strict=True)],
        ),
        ("Idle_01\nWalk_01 with Upper-Body Talk_01", [("Idle_01", 0), ("Walk_01 Talk_01", 2)]),
    ],
)
def test_commands_arrive_one_after_the_other(text: str, expected: list[tuple[str, float]], reference: Catalog) -> None:
    plan = analyse(Source(text), reference).resolved
    assert plan is not None
    names = Names(reference)
    told = foreseen(plan, forecast(plan, names, OneSecond()), names)
    goings = [told.goings[span] for span in sorted(told.goings)]
    assert [(" ".join(motion for _, motion in one.motions), one.arrives) for one in goings] == [
        (motions, exactly(seconds)) for motions, seconds in expected
    ]
    assert all(one.sure for one in goings)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Idle_01\nchoose { wait 20 sec | wait 1 sec }\nWalk_01", {"Walk_01": (11.5, 2, 21)}),
        ("Idle_01\nchoose { Walk_01 for 2 sec | }\nTalk_01", {"Walk_01 for 2 sec": (1, 1, 1), "Talk_01": (2.5, 1, 4)}),
        ("Idle_01\nchoose { wait 2 sec | wait 2000 ms }\nWalk_01", {"Walk_01": (3, 3, 3)}),
        (
            "Idle_01\nrepeat 2 { choose { wait 1 sec | wait 2 sec }; Walk_01; Talk_01 }\nIdle_02",
            {"Walk_01": (2.5, 2, 3), "Talk_01": (3.5, 3, 4), "Idle_02": (8, 7, 9)},
        ),
    ],
)
def test_what_comes_after_chance_arrives_between_two_times(
    text: str, expected: dict[str, tuple[float, float, float]], reference: Catalog
) -> None:
    plan = analyse(Source(text), reference).resolved
    assert plan is not None
    names = Names(reference)
    told = foreseen(plan, forecast(plan, names, OneSecond()), names)
    arrivals = {one: told.goings[place(text, one)].arrives for one in expected}
    assert arrivals == {one: Estimate(*seconds) for one, seconds in expected.items()}
    assert all(one.sure for one in told.goings.values())


def test_what_depends_on_chance_is_not_sure(reference: Catalog) -> None:
    plan = analyse(Source("Idle_01\nWALK"), reference).resolved
    assert plan is not None
    names = Names(reference)
    told = foreseen(plan, forecast(plan, names, OneSecond()), names)
    assert [one.sure for _, one in sorted(told.goings.items())] == [True, False]


def test_after_an_edit_it_is_still_known_how_the_commands_went_that_it_has_left_alone(reference: Catalog) -> None:
    before = analyse(Source("Idle_01\nWalk_01 for 3 sec\nTalk_01\n"), reference)
    assert before.resolved is not None
    names = Names(reference)
    told = foreseen(before.resolved, forecast(before.resolved, names, OneSecond()), names)
    now = analyse_again(before, Source("Idle_01\n\nWalk_02 for 30 sec\nTalk_01\n"))
    left = Remembered(told, before.made).of(now.made)
    goings = {one: left.going(place(now.source.text, one)) for one in ("Idle_01", "Walk_02 for 30 sec", "Talk_01")}
    arrivals = {one: None if going is None else going.arrives for one, going in goings.items()}
    assert arrivals == {"Idle_01": exactly(0), "Walk_02 for 30 sec": None, "Talk_01": exactly(5)}
    assert left.going(Span(0, 3)) is None
    afresh = Remembered(told, before.made).of(analyse(now.source, reference).made)
    assert {one: afresh.going(place(now.source.text, one)) for one in goings} == goings


def test_between_two_edits_it_is_still_known_of_what_has_not_been_read_again(reference: Catalog) -> None:
    before = analyse(Source("Idle_01\nWalk_01\n\nIdle_02\n\nTalk_01\n"), reference)
    assert before.resolved is not None
    names = Names(reference)
    told = foreseen(before.resolved, forecast(before.resolved, names, OneSecond()), names)
    once = analyse_again(before, Source("Idle_01\nWlak_01\n\nIdle_02\n\nTalk_01\n"))
    now = analyse_again(once, Source("Idle_01\nWlak_01\n\nIdle_02\n\nTlak_01\n"))
    assert now.found.wrong
    left = Remembered(told, before.made).of(now.made)
    known = {one: left.going(place(now.source.text, one)) for one in ("Idle_01", "Wlak_01", "Idle_02", "Tlak_01")}
    assert [one for one, going in known.items() if going is not None] == ["Idle_01", "Idle_02"]


def place(text: str, part: str) -> Span:
    """Return where a part of a text is."""
    return Span(text.index(part), text.index(part) + len(part))
