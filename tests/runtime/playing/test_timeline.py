import pytest

from mlmg_runtime.motion_graph import Position, Transition
from mlmg_runtime.playing.timeline import Blend, Clip, appended, play_along, play_clip, play_transition

EDGE = Transition(0, 31, 4, 118, 0.9, 0.2)


def test_a_clip_goes_on_by_its_source_frames() -> None:
    clip = Clip(10, 20, Position(2, 5), 12)
    assert clip.speed == pytest.approx(1.2)
    assert clip.after == Position(2, 17)


def test_a_blend_ends_after_its_target_or_in_the_graph_above() -> None:
    assert Blend(0, 20, Position(0, 31), Position(4, 118)).after == Position(4, 119)
    assert Blend(0, 20, Position(0, 31), None).after is None


def test_a_transition_is_played_for_a_window() -> None:
    assert play_transition(7, EDGE, 20) == Blend(7, 27, Position(0, 31), Position(4, 118), EDGE)


def test_no_frames_of_a_clip_are_no_segment() -> None:
    assert play_clip(3, Position(0, 9), 0) == ()
    assert play_clip(3, Position(0, 9), 2) == (Clip(3, 5, Position(0, 9), 2),)


def test_a_way_is_played_with_the_clips_that_lead_to_each_transition() -> None:
    way = [EDGE, Transition(4, 119, 0, 60, 0.1, 0.1), Transition(0, 70, 1, 30, 0.1, 0.1)]
    assert play_along(way, 20, Position(0, 30), 100) == [
        Clip(100, 101, Position(0, 30), 1),
        play_transition(101, way[0], 20),
        play_transition(121, way[1], 20),
        Clip(141, 150, Position(0, 61), 9),
        play_transition(150, way[2], 20),
    ]


def test_clips_that_go_on_where_the_last_one_stopped_become_one() -> None:
    track = appended((), Clip(0, 5, Position(0, 3), 5))
    assert appended(track, Clip(5, 9, Position(0, 8), 4)) == (Clip(0, 9, Position(0, 3), 9),)


@pytest.mark.parametrize(
    "after",
    [
        Clip(6, 9, Position(0, 8), 3),
        Clip(5, 9, Position(0, 9), 4),
        Clip(5, 9, Position(1, 8), 4),
        Clip(5, 9, Position(0, 8), 5),
        Blend(5, 9, Position(0, 8), None),
    ],
)
def test_segments_that_do_not_go_on_in_the_same_way_stay_apart(after: Clip | Blend) -> None:
    first = Clip(0, 5, Position(0, 3), 5)
    assert appended((first,), after) == (first, after)


@pytest.mark.parametrize("after", [Clip(5, 10, Position(0, 9), 5), Clip(5, 10, Position(0, 9), 6)])
def test_a_clip_that_is_bent_stays_apart(after: Clip) -> None:
    bent = Clip(0, 5, Position(0, 3), 6)
    assert appended((bent,), after) == (bent, after)
