"""Ways between motions: held against the search that playing uses, and against looking at every frame."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.planning.estimate import Moment, Playing
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import latest_loop, stay
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.search import find_path


def searched(graph: MotionGraph, motion: str, frame: int, targets: list[str], dst_frame: int | None = None):
    start = Position(graph.index[motion], frame)
    return find_path(graph, start, [graph.index[target] for target in targets], dst_frame=dst_frame)


def test_from_the_first_frame_it_is_known_to_the_frame(made_library):
    trips = MotionTravel(made_library).soonest(
        "Full-Body", Playing("Idle_01", Moment.FIRST, held_s=0.0), ("Walk_01", "Walk_02"), "Full-Body"
    )
    path = searched(made_library.root, "Idle_01", 0, ["Walk_01", "Walk_02"])
    assert [trip.motion for trip in trips] == [made_library.root.motions[path.arrival.motion]]
    assert trips[0].takes.mean == trips[0].takes.least == trips[0].takes.most == path.n_frames / 30.0
    assert trips[0].cost == pytest.approx(path.cost)


def test_from_a_motion_that_is_held_it_is_the_average_over_its_loop(made_library):
    graph, targets = made_library.root, ("Music_01", "Walk_03", "Idle_02")
    trips = MotionTravel(made_library).soonest("Full-Body", Playing("Walk_01"), targets, "Full-Body")
    loop = latest_loop(graph, graph.index["Walk_01"])
    moments = [(frame, 0) for frame in range(loop.dst_frame + 1, loop.src_frame + 1)]
    moments += [(loop.dst_frame + 1, rest) for rest in range(1, graph.window)]
    took: dict[str, list[int]] = {}
    for frame, rest in moments:
        path = searched(graph, "Walk_01", frame, list(targets))
        took.setdefault(graph.motions[path.arrival.motion], []).append(path.n_frames + rest)
    assert {trip.motion for trip in trips} == set(took)
    for trip in trips:
        assert trip.chance == pytest.approx(len(took[trip.motion]) / len(moments))
        assert trip.takes.mean == pytest.approx(np.mean(took[trip.motion]) / 30.0)
        assert trip.takes.least == pytest.approx(min(took[trip.motion]) / 30.0)
        assert trip.takes.most == pytest.approx(max(took[trip.motion]) / 30.0)


def test_what_is_held_for_a_known_time_is_known_to_the_frame(made_library):
    travel = MotionTravel(made_library)
    places = travel._places("Full-Body", Playing("Idle_01", Moment.FIRST, held_s=2.0))
    assert (places.frames.tolist(), places.leads.tolist(), places.shares.tolist()) == ([60], [0.0], [1.0])
    places = travel._places("Full-Body", Playing("Idle_01", Moment.BEGUN, held_s=2.0))
    assert places.frames.tolist() == [made_library.root.window + 60]


def test_a_motion_is_arrived_in_where_the_ways_into_it_end(made_library):
    graph = made_library.root
    travel = MotionTravel(made_library)
    places = travel._places("Full-Body", Playing("Walk_01", Moment.ARRIVED, "Idle_01", 0.0))
    before = travel._places("Full-Body", Playing("Idle_01"))
    arrivals = [searched(graph, "Idle_01", frame, ["Walk_01"]).arrival.frame for frame in before.frames.tolist()]
    shares = {frame: arrivals.count(frame) / len(arrivals) for frame in sorted(set(arrivals))}
    assert dict(zip(places.frames.tolist(), places.shares.tolist(), strict=True)) == pytest.approx(shares)


def test_a_part_may_wait_until_the_graph_above_has_looped(made_library):
    """From every frame of the graph above, it sets out there, or where that comes back to; whichever is sooner."""
    root, part = made_library.root, made_library.by_name["Upper-Body"]
    playing = Playing("Walk_01")
    (trip,) = MotionTravel(made_library).soonest("Upper-Body", playing, ("Talk_02",), "Full-Body")
    loop = latest_loop(root, root.index["Walk_01"])
    again = searched(part, "Walk_01", loop.dst_frame + 1, ["Talk_02"])
    places = MotionTravel(made_library)._places("Full-Body", playing)
    took, waited = [], 0
    for frame, lead in zip(places.frames.tolist(), places.leads.tolist(), strict=True):
        path = searched(part, "Walk_01", frame, ["Talk_02"])
        later = loop.src_frame - frame + root.window + again.n_frames
        waited += path is None or later < path.n_frames
        took.append(lead + (later if path is None else min(path.n_frames, later)))
    assert waited, "the example has lost its point"
    assert trip.takes.mean == pytest.approx(np.mean(took) / 30.0)


def test_where_no_way_leads_there_is_none(made_library):
    cut = made_library.root.transitions
    travel = MotionTravel(_with_transitions(made_library, cut[cut["dst_motion"] != 3]))
    assert travel.soonest("Full-Body", Playing("Idle_01"), ("Walk_02",), "Full-Body") == ()
    (trip,) = travel.soonest("Full-Body", Playing("Idle_01"), ("Walk_02", "Idle_02"), "Full-Body")
    assert (trip.motion, trip.chance) == ("Idle_02", 1.0)


def test_where_no_way_leads_to_where_a_motion_begins_it_is_blended_into(made_library):
    travel = MotionTravel(made_library)
    root = made_library.root
    begins = {root.motions[edge.dst_motion] for edge in root.edges if edge.dst_frame == root.window - 1}
    assert begins == {"Idle_02", "Walk_03", "Talk_02"}
    assert travel.soonest("Full-Body", Playing("Idle_01"), ("Walk_02",), "Full-Body", to_begin=True) == ()
    (trip,) = travel.soonest("Full-Body", Playing("Idle_01"), ("Walk_03",), "Full-Body", to_begin=True)
    assert trip.on_the_spot == 0.0
    trip = travel.on_the_spot("Full-Body", "Walk_02")
    assert (trip.on_the_spot, trip.takes.mean) == (1.0, made_library.root.window / 30.0)


def test_a_graph_without_transitions_leads_nowhere(demo_library):
    travel = MotionTravel(_with_transitions(demo_library, demo_library.root.transitions[:0]))
    assert travel.soonest("Full-Body", Playing("Idle_01"), ("Walk_02",), "Full-Body") == ()


def _with_transitions(library: Library, transitions: np.ndarray) -> Library:
    root = replace(library.root, transitions=transitions)
    return replace(library, by_name={**library.by_name, root.name: root})


def test_the_way_back_is_as_long_as_some_that_are_found(demo_library):
    """The estimate lies between those of pairs of frames, each led back as playing does it."""
    travel = MotionTravel(demo_library)
    trip = travel.back("Upper-Body", Playing("Talk_01"), "Full-Body", Playing("Walk_01"))
    deadline = round(2.0 * demo_library.frame_rate)
    own, root = demo_library.by_name["Upper-Body"], demo_library.root
    ends = []
    for frame in range(30, 300, 30):
        clips = travel._clips(root, root.index["Walk_01"], Position(root.index["Walk_01"], frame), own, deadline)
        way = find_return(own, Position(own.index["Talk_01"], frame), 0, clips, deadline)
        ends.append((own.window if way is None else way[-1].end) / 30.0)
    assert min(ends) <= trip.takes.mean <= max(ends)
    assert 0.0 <= trip.on_the_spot <= 1.0


def test_the_time_to_the_last_frame_is_the_rest_of_the_clip(made_library):
    travel = MotionTravel(made_library)
    assert travel.to_last_frame("Full-Body", Playing("Walk_01", Moment.FIRST, held_s=0.0)).mean == 160 / 30.0
    assert travel.to_last_frame("Full-Body", Playing("Walk_01", Moment.BEGUN, held_s=0.0)).mean == 150 / 30.0


def test_a_pass_goes_from_where_a_motion_begins_to_its_last_exit(made_library):
    root = made_library.root
    last = max(edge.src_frame for edge in root.edges if edge.src_motion == root.index["Walk_01"])
    assert MotionTravel(made_library).one_pass("Full-Body", "Walk_01").mean == (last - root.window) / 30.0


def test_what_a_graph_above_plays_is_told_in_the_indices_of_the_graph_below(demo_library):
    root, part = demo_library.root, demo_library.by_name["Left-Hand"]
    position = Position(root.index["Talk_02"], 40)
    clips = MotionTravel(demo_library)._clips(root, position.motion, position, part, 60)
    assert part.motions[clips[0].first.motion] == "Talk_02"
    assert (clips[0].first.frame, clips[0].begin) == (40, 0)
    shown = islice(stay(demo_library, root, position.motion, position, 0, range(len(root.motions))), len(clips))
    assert [clip.begin for clip in clips] == [segment.begin for segment in shown]
