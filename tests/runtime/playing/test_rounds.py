from fractions import Fraction
from itertools import count, islice, pairwise
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mlmg_runtime.database import write_database
from mlmg_runtime.library import open_library
from mlmg_runtime.motion_graph import MotionGraph, Position, Transition
from mlmg_runtime.playing.holding import latest_loop, stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.rounds import best_round, way_back
from mlmg_runtime.playing.timeline import Blend, Clip, Segment


def largest_share(graph: MotionGraph, home: int, allowed: set[int]) -> tuple[Fraction, float] | None:
    """Return the largest share of time that a motion is played on a way round, and the least cost of such a one.

    Every way out is followed by letting all transitions be reached from one another, until that makes nothing shorter.
    """
    best: tuple[Fraction, float] | None = None
    for out in graph.edges:
        if out.src_motion != home or out.dst_motion == home:
            continue
        begun: dict[Transition, tuple[int, float]] = {out: (0, 0.0)}
        for _ in count():
            before = dict(begun)
            for edge, (frames, cost) in before.items():
                if edge.dst_motion == home or edge.dst_motion not in allowed:
                    continue
                for onward in graph.edges:
                    waited = onward.src_frame - edge.arrival.frame
                    if onward.src_motion == edge.dst_motion and waited >= 0:
                        reached = (frames + graph.window + waited, cost + edge.cost)
                        begun[onward] = min(begun.get(onward, reached), reached)
            if begun == before:
                break
        for edge, (frames, cost) in begun.items():
            inside = out.src_frame - edge.arrival.frame
            if edge.dst_motion == home and inside >= 0:
                found = (Fraction(inside, inside + frames + graph.window), -cost - edge.cost)
                best = found if best is None else max(best, found)
    return best


@given(data=st.data())
def test_no_way_round_lets_a_larger_share_of_the_time_pass_in_the_motion(motion_graphs, data) -> None:
    graph = data.draw(motion_graphs(longest=20))
    home = data.draw(st.sampled_from(range(len(graph.motions))))
    allowed = data.draw(st.sets(st.sampled_from(range(len(graph.motions)))))
    found, expected = best_round(graph, home, allowed), largest_share(graph, home, allowed)
    assert (found is None) == (expected is None)
    if found is not None and expected is not None:
        share, cost = expected
        assert Fraction(found.inside, found.inside + found.outside) == share
        assert sum(edge.cost for edge in found.transitions) == pytest.approx(-cost)
        assert {edge.dst_motion for edge in found.transitions[:-1]} <= allowed
        first, last = found.transitions[0], found.transitions[-1]
        assert (first.src_motion, last.dst_motion) == (home, home)
        for one, then in pairwise(found.transitions):
            assert one.dst_motion == then.src_motion
            assert one.arrival.frame <= then.src_frame


def test_a_motion_is_left_late_and_entered_early_though_a_shorter_way_leads_round(motion_graph) -> None:
    # Soonest there and back: 24 to 20, by Motion_1, again and again. Motion_2 leads from 90 to 9.
    marks = [(0, 24, 1, 9), (1, 12, 0, 20), (0, 90, 2, 9), (2, 30, 0, 9)]
    graph = motion_graph([100, 20, 40], 3, marks)
    found = best_round(graph, 0, {0, 1, 2})
    assert found is not None
    assert [(edge.src_frame, edge.dst_frame) for edge in found.transitions] == [(90, 9), (30, 9)]
    assert (found.inside, found.outside, found.leave) == (80, 26, 90)
    assert found.share == pytest.approx(80 / 106)
    limited = best_round(graph, 0, {0, 1})
    assert limited is not None
    assert limited.leave == 24


def test_of_equally_good_ways_round_the_smoothest_is_taken(motion_graph) -> None:
    marks = [(0, 30, 1, 9, 0.5), (1, 12, 0, 5, 0.5), (0, 30, 2, 9, 0.2), (2, 12, 0, 5, 0.3)]
    found = best_round(motion_graph([40, 20, 20], 3, marks), 0, {0, 1, 2})
    assert found is not None
    assert [edge.cost for edge in found.transitions] == [0.2, 0.3]


def test_from_past_its_way_round_a_motion_comes_back_before_that(motion_graph) -> None:
    # From 35 the shortest way leads to 34, from where nothing else than that leads on.
    marks = [(0, 30, 1, 9), (1, 12, 0, 5), (0, 35, 1, 3), (1, 4, 0, 33)]
    graph = motion_graph([40, 20], 3, marks)
    usual = best_round(graph, 0, {0, 1})
    assert usual is not None
    assert usual.leave == 30
    way = way_back(graph, 0, {0, 1}, Position(0, 32), usual)
    assert way is not None
    assert [(edge.src_frame, edge.dst_frame) for edge in way] == [(35, 3), (12, 5)]


# Transitions between three motions of 20 frames: none leads from a motion into itself, and costs are often the same.
MARKS = st.tuples(
    st.sampled_from([(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]), st.integers(0, 17), st.integers(2, 18)
)


@given(marks=st.lists(MARKS, min_size=8, max_size=16, unique=True), costs=st.lists(st.integers(0, 3), min_size=16))
def test_staying_goes_on_from_wherever_it_is_as_it_would_have(motion_graph, marks, costs) -> None:
    rows = [(a, leave, b, enter, cost / 4) for ((a, b), leave, enter), cost in zip(marks, costs, strict=False)]
    graph, home, everything = motion_graph([20, 20, 20], 3, rows), 0, {0, 1, 2}
    assume(best_round(graph, home, everything) is not None)

    class NothingAlike:
        def most_alike(self, *asked: object, **also: object) -> None:
            return None

    def staying(position: Position, time: int) -> list[Segment]:
        return list(islice(stay(NothingAlike(), graph, home, position, time, everything), 12))

    segments = staying(Position(home, 0), 0)
    for number, segment in enumerate(segments[:6]):
        assert segment.after is not None
        rest = staying(segment.after, segment.end)
        assert rest[: 11 - number] == segments[number + 1 :]


def test_a_real_motion_that_never_leads_into_itself_is_shown_most_of_the_time(build_reference, tmp_path: Path) -> None:
    write_database(build_reference("reference", "reference-plus"), tmp_path / "plus.mlmg")
    library = open_library(tmp_path / "plus.mlmg")
    graph = library.by_name["Upper-Body"]
    home = graph.index["Walk_03"]
    assert latest_loop(graph, home) is None
    inside = 0
    for segment in stay(Likeness(library), graph, home, Position(home, 20), 0, range(len(graph.motions))):
        if segment.begin >= 900:
            break
        assert not isinstance(segment, Blend) or segment.transition is not None
        inside += segment.end - segment.begin if isinstance(segment, Clip) and segment.first.motion == home else 0
    assert inside > 600
