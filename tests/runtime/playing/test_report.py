import json
from fractions import Fraction
from math import ceil, floor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.clips import resample
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import Position
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.report import joints_from_timeline, output_frame, tracks_from_timeline
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Timeline


def test_segments_are_told_by_their_names_and_frames(small_library: Library) -> None:
    root, upper = small_library.root, small_library.by_name["Upper-Body"]
    edge = next(edge for edge in root.edges if edge.dst_motion != edge.src_motion)
    begin = edge.src_frame
    timeline = Timeline(
        begin + 40,
        {
            "Full-Body": (
                Clip(0, begin, Position(edge.src_motion, 0), begin),
                Blend(begin, begin + 8, Position(*edge[:2]), Position(*edge[2:4]), edge),
                Clip(begin + 8, begin + 50, edge.arrival, 42),
            ),
            "Upper-Body": (
                Clip(5, 15, Position(1, 20), 12),
                Blend(15, 23, Position(1, 32), Position(1, 7)),
                Blend(23, 31, Position(1, 8), None),
            ),
        },
    )
    source, target = root.motions[edge.src_motion], root.motions[edge.dst_motion]
    found = tracks_from_timeline(small_library, timeline, 1.0, timeline.n_frames)
    assert found == {
        "Full-Body": [
            {"kind": "clip", "begin": 0, "end": begin, "motion": source, "clip_begin": 0, "speed": 1.0},
            {
                "kind": "transition",
                "begin": begin,
                "end": begin + 8,
                "from": [source, edge.src_frame],
                "to": [target, edge.dst_frame],
                "distance": edge.distance,
                "cost": edge.cost,
            },
            {
                "kind": "clip",
                "begin": begin + 8,
                "end": begin + 40,
                "motion": target,
                "clip_begin": edge.dst_frame + 1,
                "speed": 1.0,
            },
        ],
        "Upper-Body": [
            {"kind": "clip", "begin": 5, "end": 15, "motion": "Stroll", "clip_begin": 20, "speed": 1.2},
            {"kind": "blend", "begin": 15, "end": 23, "from": ["Stroll", 32], "to": ["Stroll", 7]},
            {"kind": "blend", "begin": 23, "end": 31, "from": ["Stroll", 8], "to": None},
        ],
    }
    assert json.loads(json.dumps(found)) == found
    assert upper.motions[1] == "Stroll"


@given(st.integers(1, 400), st.fractions(Fraction(1, 6), 5, max_denominator=10_000), st.data())
def test_each_output_frame_lies_in_the_segment_that_its_time_lies_in(n: int, ratio: Fraction, data) -> None:
    frame = data.draw(st.integers(0, n))
    n_frames = floor((n - 1) * ratio) + 1
    assert output_frame(frame, float(ratio), n_frames) == min(ceil(frame * ratio), n_frames)


@given(seed=st.integers(0, 2**32 - 1), rate=st.sampled_from([5.0, 12.5, 24.0, 25.0, 30.0, 60.0, 59.94, 120.0]))
def test_at_any_rate_the_tracks_tell_of_every_frame_of_the_output_once(
    seed: int, rate: float, moves, ask, small_library: Library
) -> None:
    performer = Performer(small_library, small_library.root.motions[seed % 4])
    performer.hold(1)
    for move in moves(seed):
        ask(performer, move)
    timeline = performer.timeline()
    ratio = rate / 30.0
    n_frames = resample(synthesize(small_library, timeline), 30.0, rate).n_frames
    tracks = tracks_from_timeline(small_library, timeline, ratio, n_frames)
    assert list(tracks) == list(timeline.tracks)
    root = tracks["Full-Body"]
    assert [entry["begin"] for entry in root] == [0, *(entry["end"] for entry in root[:-1])]
    assert root[-1]["end"] == n_frames
    for graph, entries in tracks.items():
        segments = timeline.tracks[graph]
        for entry in entries:
            assert 0 <= entry["begin"] < entry["end"] <= n_frames
            for t in (entry["begin"], entry["end"] - 1):
                at = t / ratio + 1e-9
                (segment,) = [s for s in segments if s.begin <= at < s.end]
                assert isinstance(segment, Clip) == (entry["kind"] == "clip")
                if isinstance(segment, Clip):
                    shown = segment.first.frame + segment.speed * (at - segment.begin)
                    assert entry["clip_begin"] + entry["speed"] * (t - entry["begin"]) == pytest.approx(shown, abs=1e-3)


def test_the_joints_of_the_parts_that_run_are_named(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"])])
    assert joints_from_timeline(small_library, performer.timeline()) == {"Left-Arm": ["LeftArm", "LeftHand"]}
