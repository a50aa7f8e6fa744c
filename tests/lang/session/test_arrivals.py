"""How soon each motion is reached, against the search that playing uses."""

import random
from math import inf

import pytest

from mlmg_lang.session.arrivals import arrivals
from mlmg_lang.session.fitness import StageFits
from mlmg_lang.session.session import Session
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import Position
from mlmg_runtime.playing.search import find_path


@pytest.mark.parametrize("name", ["demo_library", "reference_library"])
def test_arrivals_are_those_of_the_search_from_frames_everywhere(name: str, request: pytest.FixtureRequest) -> None:
    library: Library = request.getfixturevalue(name)
    draw = random.Random(2)
    for own in library.by_name.values():
        for _ in range(40):
            motion = draw.randrange(len(own.motions))
            position = Position(motion, draw.randrange(int(own.n_frames[motion])))
            paths = [find_path(own, position, [target]) for target in range(len(own.motions))]
            wanted = [inf if path is None else path.n_frames for path in paths]
            assert arrivals(own, position).tolist() == wanted


def test_what_plays_is_there_already_and_what_is_soon_reached_fits_best(demo_library: Library) -> None:
    session = Session(demo_library)
    session.enter("WALK for 2 sec")
    stage = session.stage
    fits = StageFits(demo_library, stage).fits("Full-Body", ())
    assert fits[stage.performer.motion("Full-Body")] == 0.0
    stage.performer.bring([("Full-Body", ("Idle_01",))])
    assert fits["Idle_01"] == pytest.approx(stage.performer.now / 30 - session.n_seconds)


def test_below_the_root_what_is_most_like_the_motion_above_fits_best(demo_library: Library) -> None:
    fits = StageFits(demo_library, Session(demo_library).stage).fits("Upper-Body", ("Walk_01",))
    assert min(fits, key=lambda motion: fits[motion]) == "Walk_01"
    assert fits["Talk_01"] == pytest.approx(demo_library.unlikeness("Upper-Body", "Walk_01", "Talk_01"))


def test_nothing_fits_where_rule_1_lets_no_part_go(demo_library: Library) -> None:
    assert StageFits(demo_library, Session(demo_library).stage).fits("Upper-Body", ("Idle_02",)) == {}
