"""Where staying in a motion leads: held against what staying plays, frame by frame."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import pytest

from mlmg_lang.explaining.staying import after, places_of, staying
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import latest_loop, stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.timeline import Clip


def shown(library: Library, graph: MotionGraph, home: int, position: Position, n_frames: int) -> tuple[Position, int]:
    """Return where a graph is after some frames, and how many frames pass until it is there."""
    everything = range(len(graph.motions))
    for segment in stay(library, graph, home, position, 0, everything):
        if segment.begin <= n_frames < segment.end:
            into = n_frames - segment.begin
            if isinstance(segment, Clip):
                return Position(segment.first.motion, segment.first.frame + into), 0
            return (segment.after, segment.end - n_frames) if into else (segment.source, 0)
    raise AssertionError("staying has no end")


@pytest.mark.parametrize("n_frames", [0, 1, 34, 89, 90, 91, 95, 104, 105, 106, 500, 1234])
@pytest.mark.parametrize("frame", [0, 12, 90])
def test_after_some_frames_a_graph_is_where_staying_leads(made_library, frame, n_frames):
    graph, position = made_library.root, Position(made_library.root.index["Idle_01"], frame)
    stays = staying(Likeness(made_library), graph, position.motion, position, range(len(graph.motions)))
    expected = shown(made_library, graph, position.motion, position, n_frames)
    assert after(stays, position, n_frames) == [expected]


def test_so_it_is_where_a_motion_has_no_loop_and_is_held_by_ways_round(made_library):
    edges = made_library.root.transitions
    graph = replace(made_library.root, transitions=edges[edges["src_motion"] != edges["dst_motion"]])
    home = graph.index["Talk_01"]
    assert latest_loop(graph, home) is None
    position = Position(home, 10)
    stays = staying(Likeness(made_library), graph, home, position, range(len(graph.motions)))
    found = [after(stays, position, n_frames)[0] for n_frames in range(0, 900, 17)]
    assert found == [shown(made_library, graph, home, position, n_frames) for n_frames in range(0, 900, 17)]
    assert len({place.motion for place, _ in found}) > 1


def test_after_any_time_it_may_be_wherever_it_comes_again_and_again(made_library):
    graph = made_library.root
    home = graph.index["Walk_01"]
    stays = staying(Likeness(made_library), graph, home, Position(home, 5), range(len(graph.motions)))
    found = after(stays, Position(home, 5), inf)
    loop = latest_loop(graph, home)
    period = loop.src_frame - loop.dst_frame - 1 + graph.window
    late = [shown(made_library, graph, home, Position(home, 5), 1000 + n) for n in range(period)]
    assert sorted(found) == sorted(late)


def test_the_places_of_each_list_share_its_chance():
    places = places_of([(0.5, [(Position(1, 7), 0), (Position(1, 8), 0)]), (0.5, [(Position(1, 7), 0)])])
    assert (places.frames.tolist(), places.shares.tolist()) == ([7, 8], [0.75, 0.25])


def test_what_stands_still_is_in_its_last_frame_for_ever(demo_library):
    """Without transitions, and too near to the clip's end to be blended back into itself."""
    graph = replace(demo_library.root, transitions=demo_library.root.transitions[:0])
    last = int(graph.n_frames[0]) - 1
    position = Position(0, last - 2)
    stays = staying(Likeness(demo_library), graph, 0, position, ())
    assert after(stays, position, inf) == after(stays, position, 9) == [(Position(0, last), 0)]
    assert after(stays, position, 1) == [(Position(0, last - 1), 0)]


def test_what_cannot_go_on_is_told_as_far_as_it_goes(demo_library):
    """Without transitions, and in another motion."""
    graph = replace(demo_library.root, transitions=demo_library.root.transitions[:0])
    position = Position(1, 7)
    stays = staying(Likeness(demo_library), graph, 0, position, ())
    assert (stays.segments, after(stays, position, inf), after(stays, position, 9)) == (
        (),
        [(position, 0)],
        [(position, 0)],
    )
