from collections.abc import Iterator
from dataclasses import replace
from itertools import islice, pairwise, takewhile

import numpy as np
import pytest

from mlmg_runtime.errors import PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position, Transition
from mlmg_runtime.playing.holding import hardly_held, latest_loop, stay
from mlmg_runtime.playing.likeness import Alike, Likeness
from mlmg_runtime.playing.rounds import best_round, way_back
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, appended
from mlmg_runtime.point_cloud import point_cloud, window_distances
from mlmg_runtime.skeleton import Poses, world_positions


class NothingAlike:
    """What knows of no two windows of a motion that are alike."""

    def most_alike(self, *asked: object, **also: object) -> None:
        return None


NOTHING_ALIKE = NothingAlike()


def played(segments: Iterator[Segment], until: int) -> list[Segment]:
    """Return what is played up to a frame, after checking that it goes on without a gap."""
    found = list(takewhile(lambda segment: segment.begin < until, segments))
    for before, after in pairwise(found):
        assert before.end == after.begin
        assert before.after == (after.first if isinstance(after, Clip) else after.source)
        assert isinstance(before, Blend) or isinstance(after, Blend)
    return found


def departures(segments: list[Segment]) -> list[tuple[int, int]]:
    return [(segment.source.frame, segment.target.frame) for segment in segments if isinstance(segment, Blend)]


def test_the_latest_loop_is_the_backward_transition_that_leaves_latest_the_smoothest_of_several(motion_graph) -> None:
    marks = [(0, 20, 0, 9, 0.1), (0, 30, 0, 12, 0.7), (0, 30, 0, 8, 0.3), (0, 31, 0, 38), (0, 32, 0, 32), (0, 33, 1, 9)]
    graph = motion_graph([40, 20], 3, marks)
    loop = latest_loop(graph, 0)
    assert (loop.src_frame, loop.dst_frame) == (30, 8)
    assert latest_loop(graph, 1) is None


def test_a_motion_is_held_by_its_latest_loop(motion_graph) -> None:
    graph = motion_graph([40, 20], 3, [(0, 20, 0, 9), (0, 30, 0, 12), (0, 15, 1, 9), (1, 12, 0, 5)])
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(0, 2), 100, {0, 1}), 300)
    assert segments[:4] == [
        Clip(100, 128, Position(0, 2), 28),
        Blend(128, 131, Position(0, 30), Position(0, 12), latest_loop(graph, 0)),
        Clip(131, 148, Position(0, 13), 17),
        Blend(148, 151, Position(0, 30), Position(0, 12), latest_loop(graph, 0)),
    ]
    assert set(departures(segments)) == {(30, 12)}


@pytest.mark.parametrize(("start", "departs"), [((0, 29), (30, 12)), ((0, 30), (30, 12)), ((0, 31), (35, 9))])
def test_the_loop_is_taken_up_to_the_very_frame_from_which_it_leaves(motion_graph, start, departs) -> None:
    graph = motion_graph([40, 20], 3, [(0, 30, 0, 12), (0, 30, 0, 36, 0.1), (0, 35, 1, 9), (1, 12, 0, 5)])
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(*start), 0, {0, 1}), 20)
    assert departures(segments)[0] == departs


def test_a_way_round_that_has_begun_is_gone_to_its_end(motion_graph) -> None:
    graph = motion_graph([40, 20], 3, [(0, 30, 0, 12), (1, 12, 0, 5)])
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(1, 4), 0, {0, 1}), 60)
    assert departures(segments)[:2] == [(12, 5), (30, 12)]


def test_past_its_loops_a_motion_is_held_by_the_shortest_way_round(motion_graph) -> None:
    marks = [(0, 20, 0, 9), (0, 35, 1, 9), (1, 12, 0, 5), (0, 32, 2, 9), (2, 18, 0, 3)]
    graph = motion_graph([40, 20, 30], 3, marks)
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(0, 22), 0, {0, 1, 2}), 120)
    assert departures(segments)[:4] == [(35, 9), (12, 5), (20, 9), (20, 9)]


def test_past_its_loops_a_motion_is_led_to_before_them_though_a_shorter_way_leads_behind(motion_graph) -> None:
    marks = [(0, 20, 0, 9), (0, 35, 1, 9), (1, 12, 0, 25), (1, 16, 0, 5)]
    graph = motion_graph([40, 20], 3, marks)
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(0, 22), 0, {0, 1}), 120)
    assert departures(segments)[:3] == [(35, 9), (16, 5), (20, 9)]


def test_a_way_round_passes_only_what_the_layers_below_allow(motion_graph) -> None:
    marks = [(0, 35, 1, 9), (1, 12, 0, 5), (0, 32, 2, 9), (2, 18, 0, 3)]
    graph = motion_graph([40, 20, 30], 3, marks)
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(0, 22), 0, {0, 2}), 120)
    assert departures(segments)[:2] == [(32, 9), (18, 3)]
    assert {segment.first.motion for segment in segments if isinstance(segment, Clip)} == {0, 2}


@pytest.mark.parametrize("name", ["Full-Body", "Upper-Body", "Left-Arm", "Right-Arm"])
def test_every_motion_of_a_library_can_be_held_from_wherever_it_is_entered(
    small_library: Library, soonest, name: str
) -> None:
    graph = small_library.by_name[name]
    everything = range(len(graph.motions))
    for home in everything:
        starts = {edge.arrival for edge in graph.edges if edge.dst_motion == home} | {Position(home, 0)}
        for start in starts:
            position = start
            for segment in played(stay(Likeness(small_library), graph, home, start, 0, everything), 400):
                if isinstance(segment, Clip):
                    continue
                assert segment.transition == expected(small_library, graph, home, position, soonest, segment)
                position = segment.after


def expected(
    library: Library, graph: MotionGraph, home: int, position: Position, soonest, played: Blend
) -> Transition | None:
    """Return the transition by which a motion is held; None for a blend on the spot, after a look at its windows.

    Which ways round hold a motion that never leads into itself is tried by the tests of these.
    """
    loop = latest_loop(graph, home)
    if loop is not None and position.motion == home and position.frame <= loop.src_frame:
        return loop
    everything = range(len(graph.motions))
    if loop is None:
        usual = best_round(graph, home, everything)
        assert usual is not None
        there = position.motion == home and position.frame <= usual.leave
        return usual.transitions[0] if there else way_back(graph, home, everything, position, usual)[0]
    way = soonest(graph, position, [home], everything).transitions
    if way[-1].arrival.frame > loop.src_frame:
        return played.transition
    if position.motion != home:
        return way[0]
    points = world_positions(library.skeleton, library.poses(graph.motions[home]))[:, list(graph.joints)]
    cloud = point_cloud(points, graph.weights, graph.window)
    distances = window_distances(cloud, cloud)
    pairs = [
        (distances[late, early], late, early)
        for late in range(position.frame, way[0].src_frame + 1)
        for early in range(min(late, loop.src_frame) - graph.window + 1)
    ]
    distance, late, early = min(pairs, default=(np.inf, 0, 0))
    if distance > max(25.0 * graph.sigma, *(edge.distance for edge in way)):
        return way[0]
    assert (played.source, played.target) == (Position(home, late), Position(home, early + graph.window - 1))
    return None


@pytest.mark.parametrize(("distance", "blended"), [(6.9, True), (25.0, True), (25.1, False)])
def test_past_its_loops_a_motion_is_blended_back_if_that_is_hardly_seen(
    motion_graph, distance: float, blended: bool
) -> None:
    graph = motion_graph([40, 20], 3, [(0, 20, 0, 9), (0, 35, 1, 9), (1, 12, 0, 5)])
    asked = []

    class OneAlike:
        def most_alike(self, *args: object, **also: object) -> Alike:
            asked.append((args[1:], also))
            return Alike(distance, 30, 4)

    segments = played(stay(OneAlike(), graph, 0, Position(0, 22), 0, {0, 1}), 60)
    assert asked[0] == (("Motion_0", 22, 35), {"before": 20})
    assert departures(segments)[:2] == ([(30, 6), (20, 9)] if blended else [(35, 9), (12, 5)])


def test_a_motion_that_never_leads_into_itself_is_held_by_the_way_round_on_which_it_is_shown_most(motion_graph) -> None:
    marks = [(0, 24, 1, 9), (1, 12, 0, 20), (0, 90, 2, 9), (2, 30, 0, 9)]
    graph = motion_graph([100, 20, 40], 3, marks)
    segments = played(stay(NOTHING_ALIKE, graph, 0, Position(0, 21), 0, {0, 1, 2}), 300)
    assert departures(segments)[:4] == [(90, 9), (30, 9), (90, 9), (30, 9)]


@pytest.mark.parametrize(("leave", "hard"), [(24, True), (36, False)])
def test_a_motion_is_hardly_held_if_its_best_way_round_takes_longer_than_it_is_shown(motion_graph, leave, hard) -> None:
    graph = motion_graph([40, 40, 20], 3, [(0, leave, 1, 9), (1, 22, 0, 9), (1, 38, 1, 30), (2, 10, 2, 4)])
    shown, until = 0, 30_000
    for segment in played(stay(NOTHING_ALIKE, graph, 0, Position(0, 10), 0, {0, 1, 2}), until):
        shown += segment.end - segment.begin if isinstance(segment, Clip) and segment.first.motion == 0 else 0
    share = shown / until
    assert hardly_held(graph) == ({"Motion_0": pytest.approx(share, abs=1e-3)} if hard else {})
    assert (share < 0.5) == hard


def test_a_motion_that_never_leads_into_itself_is_not_blended_on_the_spot_if_a_way_leads_round(
    small_library: Library,
) -> None:
    graph = small_library.root
    home = graph.index["Reach"]
    assert latest_loop(graph, home) is None
    everything = range(len(graph.motions))
    segments = played(stay(Likeness(small_library), graph, home, Position(home, 20), 0, everything), 300)
    assert all(segment.transition is not None for segment in segments if isinstance(segment, Blend))


def cornered(library: Library) -> tuple[MotionGraph, int, set[int]]:
    """Return a graph, a motion without self-transitions, and allowed motions through which nothing leads back."""
    graph = library.by_name["Upper-Body"]
    graph = replace(graph, weights=0.01 ** np.arange(len(graph.joints)))
    return graph, graph.index["Reach"], {graph.index["Reach"], graph.index["Stand"]}


def test_where_nothing_leads_back_a_blend_is_made_between_the_two_most_alike_windows(small_library: Library) -> None:
    graph, home, allowed = cornered(small_library)
    segments = played(stay(Likeness(small_library), graph, home, Position(home, 10), 0, allowed), 300)
    points = world_positions(small_library.skeleton, small_library.poses("Reach"))[:, list(graph.joints)]
    cloud = point_cloud(points, graph.weights, graph.window)
    distances = window_distances(cloud, cloud)
    position = Position(home, 10)
    for segment in segments:
        if isinstance(segment, Blend):
            assert segment.transition is None
            pairs = [
                (distances[late, early], late, early)
                for late in range(position.frame, cloud.n_windows)
                for early in range(late - graph.window + 1)
            ]
            _, late, early = min(pairs)
            assert (segment.source, segment.target) == (Position(home, late), Position(home, early + graph.window - 1))
            position = segment.after


def shortened(library: Library, n_frames: int) -> Library:
    """Return the library with Reach cut to a few frames."""
    poses = library.poses("Reach")
    return replace(library, _poses={"Reach": Poses(poses.rotations[:n_frames], poses.positions[:n_frames])})


@pytest.mark.parametrize("frame", [0, 5, 8])
def test_a_clip_of_two_windows_is_led_back_from_the_second_to_the_first(small_library: Library, frame: int) -> None:
    graph, home, allowed = cornered(small_library)
    assert graph.window == 8
    *_, blend = played(
        stay(Likeness(shortened(small_library, 16)), graph, home, Position(home, frame), 0, allowed), 9 - frame
    )
    assert (blend.begin, blend.source, blend.target) == (8 - frame, Position(home, 8), Position(home, 7))


# Reach has 90 frames, so that its last window of 8 begins at 82.
@pytest.mark.parametrize(("n_frames", "frame"), [(90, 83), (90, 89), (90, 90), (16, 9), (15, 0), (8, 0)])
def test_a_motion_that_is_too_short_to_be_led_back_stands_still_in_its_last_frame(
    small_library: Library, n_frames: int, frame: int
) -> None:
    graph, home, allowed = cornered(small_library)
    graph = replace(graph, n_frames=np.where(np.arange(len(graph.n_frames)) == home, n_frames, graph.n_frames))
    likeness = Likeness(shortened(small_library, n_frames))
    track: tuple[Segment, ...] = ()
    for segment in islice(stay(likeness, graph, home, Position(home, frame), 7, allowed), 30):
        track = appended(track, segment)
    rest = max(n_frames - 1 - frame, 0)
    *moving, still = track
    assert moving == ([Clip(7, 7 + rest, Position(home, frame), rest)] if rest else [])
    assert (still.begin, still.first, still.speed) == (7 + rest, Position(home, n_frames - 1), 0.0)
    assert still.end - still.begin >= 29


def test_a_motion_goes_on_from_its_last_window(small_library: Library) -> None:
    graph, home, allowed = cornered(small_library)
    blend = next(stay(Likeness(small_library), graph, home, Position(home, 82), 0, allowed))
    assert isinstance(blend, Blend)
    assert blend.source == Position(home, 82)


def test_a_motion_from_which_nothing_leads_back_is_told_by_name(small_library: Library) -> None:
    graph, home, allowed = cornered(small_library)
    start = Position(graph.index["Stand"], 119)
    with pytest.raises(PlayError, match=r"^no way leads back to Reach on Upper-Body from Stand$"):
        next(stay(Likeness(small_library), graph, home, start, 0, allowed))


def test_most_alike_windows_do_not_overlap(small_library: Library) -> None:
    graph, home, allowed = cornered(small_library)
    for frame in range(0, int(graph.n_frames[home]) - graph.window, 5):
        blend = next(
            s
            for s in stay(Likeness(small_library), graph, home, Position(home, frame), 0, allowed)
            if isinstance(s, Blend)
        )
        assert np.all(blend.source.frame >= frame)
        assert blend.target.frame < blend.source.frame
