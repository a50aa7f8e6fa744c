from collections import defaultdict
from collections.abc import Iterator, Sequence
from math import ceil, floor, inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.timeline import Blend, Clip, Segment

# When it meets, the costs of its transitions, how many frames its clips are stretched or shortened by.
Return = tuple[int, float, int]


def place_above(above: Sequence[Clip], time: int) -> Iterator[Position]:
    for clip in above:
        if clip.begin <= time <= clip.end:
            yield Position(clip.first.motion, clip.first.frame + time - clip.begin)


def soonest_return(
    graph: MotionGraph, position: Position, time: int, above: Sequence[Clip], deadline: int
) -> Return | None:
    """Return the best way back, by going through all places and times at which a transition can end.

    From each of them every frame ahead in the clip is gone to in every number of output frames that is allowed.
    """
    landings = defaultdict(dict, {time: {position: (0.0, 0)}})
    returns: list[Return] = []
    for landed in range(time, deadline + 1):
        for at, (cost, bend) in landings[landed].items():
            for frame in range(at.frame, int(graph.n_frames[at.motion])):
                n_source = frame - at.frame
                for n_output in range(ceil(n_source / 1.2), floor(n_source / 0.8) + 1):
                    there, then, bent = Position(at.motion, frame), landed + n_output, bend + abs(n_output - n_source)
                    if then <= deadline and there in place_above(above, then):
                        returns.append((then, cost, bent))
                    for edge in graph.edges:
                        if (edge.src_motion, edge.src_frame) == there:
                            after = landings[then + graph.window]
                            known = after.get(edge.arrival, (inf, inf))
                            after[edge.arrival] = min(known, (cost + edge.cost, bent))
    return min(returns, default=None)


def meeting(graph: MotionGraph, way: Sequence[Segment], position: Position, time: int, above: Sequence[Clip]) -> Return:
    """Return what a way back amounts to, after checking that it is one."""
    cost, bend = 0.0, 0
    for segment in way:
        assert segment.begin == time
        assert (segment.first if isinstance(segment, Clip) else segment.source) == position
        if isinstance(segment, Clip):
            assert 0.8 <= segment.speed <= 1.2
            bend += abs(segment.end - segment.begin - segment.n_source)
        else:
            assert segment.transition in graph.edges
            assert segment.end - segment.begin == graph.window
            cost += segment.transition.cost
        position, time = segment.after, segment.end
    assert position in list(place_above(above, time))
    return time, cost, bend


@st.composite
def cases(draw: st.DrawFn, graphs: st.SearchStrategy[MotionGraph]):
    graph = draw(graphs)
    motions = st.integers(0, len(graph.motions) - 1)
    above, time = [], draw(st.integers(0, 3))
    for _ in range(draw(st.integers(1, 4))):
        motion = draw(motions)
        first = Position(motion, draw(st.integers(0, int(graph.n_frames[motion]) - 1)))
        rest = int(graph.n_frames[motion]) - first.frame
        length = draw(st.sampled_from([rest, rest - 1, rest // 2, 0]))
        above.append(Clip(time, time + length, first, length))
        time += length + draw(st.sampled_from([0, graph.window]))
    motion, now = draw(motions), draw(st.integers(0, 4))
    position = Position(motion, draw(st.integers(0, int(graph.n_frames[motion]))))
    return graph, position, now, above, now + draw(st.integers(0, 60))


@settings(max_examples=4 * settings().max_examples)
@given(data=st.data())
def test_of_all_ways_back_the_soonest_is_taken_then_the_smoothest_then_the_least_bent(data, motion_graphs) -> None:
    graph, position, time, above, deadline = data.draw(cases(motion_graphs(longest=40)))
    expected = soonest_return(graph, position, time, above, deadline)
    way = find_return(graph, position, time, above, deadline)
    assert (way is None) == (expected is None)
    if way is not None:
        assert meeting(graph, way, position, time, above) == pytest.approx(expected)


def test_a_part_that_is_where_the_graph_above_is_has_come_back(motion_graph) -> None:
    graph = motion_graph([40], 3, [])
    assert find_return(graph, Position(0, 12), 7, [Clip(0, 30, Position(0, 5), 30)], 67) == ()


@pytest.mark.parametrize(("behind", "n_output"), [(2, 10), (-2, 10), (3, 15), (1, 5)])
def test_a_part_that_is_some_frames_off_bends_its_clip_by_a_fifth(motion_graph, behind: int, n_output: int) -> None:
    graph = motion_graph([90], 3, [])
    way = find_return(graph, Position(0, 20 - behind), 0, [Clip(0, 60, Position(0, 20), 60)], 60)
    assert way == (Clip(0, n_output, Position(0, 20 - behind), n_output + behind),)
    assert way[0].speed == pytest.approx(1.2 if behind > 0 else 0.8)


def test_a_part_waits_until_the_graph_above_begins_its_clip(motion_graph) -> None:
    graph = motion_graph([90], 3, [])
    above = [Clip(6, 60, Position(0, 26), 54)]
    assert find_return(graph, Position(0, 20), 0, above, 60) == (Clip(0, 6, Position(0, 20), 6),)


def test_a_part_takes_a_transition_of_its_own_graph_back_to_the_motion_above(motion_graph) -> None:
    graph = motion_graph([60, 60], 3, [(0, 10, 1, 12)])
    above = [Clip(0, 50, Position(1, 3), 50)]
    clip, transition, *rest = find_return(graph, Position(0, 5), 0, above, 50)
    assert isinstance(clip, Clip)
    assert isinstance(transition, Blend)
    assert transition.transition == graph.edges[0]
    assert meeting(graph, [clip, transition, *rest], Position(0, 5), 0, above)[0] <= 50


def test_there_is_no_way_back_after_the_deadline(motion_graph) -> None:
    graph = motion_graph([90], 3, [])
    above = [Clip(0, 60, Position(0, 20), 60)]
    assert find_return(graph, Position(0, 17), 0, above, 15) is not None
    assert find_return(graph, Position(0, 17), 0, above, 14) is None


def test_the_bend_of_several_clips_is_shared_among_them(motion_graph) -> None:
    graph = motion_graph([90, 90], 3, [(0, 30, 1, 12)])
    above = [Clip(0, 80, Position(1, 0), 80)]
    way = find_return(graph, Position(0, 10), 0, above, 80)
    bent = [segment for segment in way if isinstance(segment, Clip)]
    assert len(bent) == 2
    assert all(ceil(c.n_source / 1.2) <= c.end - c.begin <= floor(c.n_source / 0.8) for c in bent)
    assert min(segment.speed for segment in bent) >= 0.8
    assert max(segment.speed for segment in bent) <= 1.2


def test_where_there_is_time_no_clip_is_bent(motion_graph) -> None:
    graph = motion_graph([60, 60], 3, [(0, 10, 1, 12)])
    above = [Clip(30, 60, Position(1, 30), 30)]
    way = find_return(graph, Position(0, 0), 0, above, 60)
    assert [segment.end for segment in way] == [10, 13, 30]
    assert [segment.speed for segment in way if isinstance(segment, Clip)] == [1.0, 1.0]
