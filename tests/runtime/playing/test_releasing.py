"""How a part is let go, held against looking at each moment, frame by frame, joint by joint."""

from collections.abc import Iterator
from itertools import pairwise, takewhile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime import rotations
from mlmg_runtime.blending import c1_weight
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.releasing import release
from mlmg_runtime.playing.timeline import Blend, Clip, Segment
from mlmg_runtime.skeleton import Poses, world_positions

LIMIT = 1.3
WITHIN = 60


def future(library: Library, graph: MotionGraph, seed: int) -> tuple[int, list[Segment], list[Clip]]:
    """Return from when on a part runs, what it will play, and what the graph above will, both to stay in a motion."""
    draw = np.random.default_rng(seed)
    begin = int(draw.integers(0, 50))

    def held() -> Iterator[Segment]:
        motion = int(draw.integers(0, len(graph.motions)))
        frame = int(draw.integers(0, graph.n_frames[motion] - graph.window))
        return stay(Likeness(library), graph, motion, Position(motion, frame), begin, range(len(graph.motions)))

    own, above = (list(takewhile(lambda segment: segment.begin < begin + 200, held())) for _ in range(2))
    return begin, own, [segment for segment in above if isinstance(segment, Clip)]


def place(segments: list[Segment], time: int) -> Position | None:
    """Return the frame of a clip that is shown at a time, or from which a transition then begins."""
    for segment in segments:
        if isinstance(segment, Clip) and segment.begin <= time < segment.end:
            return Position(segment.first.motion, segment.first.frame + time - segment.begin)
        if isinstance(segment, Blend) and segment.begin == time:
            return segment.source
    return None


def longest_steps(points: np.ndarray) -> list[float]:
    n_joints = points.shape[1]
    return [max(float(np.linalg.norm(b[j] - a[j])) for a, b in pairwise(points)) for j in range(n_joints)]


def slow_hurry(library: Library, graph: MotionGraph, own: Position, above: Position) -> float:
    """Return by how much the blend from one place to the other exceeds the longest steps of the two clips."""
    mine, theirs = (library.poses(graph.motions[at.motion]) for at in (own, above))
    shown = []
    for p in range(-1, graph.window + 1):
        a = mine.rotations[min(max(own.frame + p, 0), mine.n_frames - 1)]
        at = min(max(above.frame + p, 0), theirs.n_frames - 1)
        weight = 1.0 if p < 0 else float(c1_weight(np.array(min((p + 1) / graph.window, 1.0))))
        turned = theirs.rotations[at].copy()
        for joint in graph.joints:
            turned[joint] = rotations.slerp(a[joint], turned[joint], np.array(1.0 - weight))
        shown.append(world_positions(library.skeleton, Poses(turned[None], theirs.positions[at][None]))[0])
    steps = longest_steps(np.array(shown))
    expected = [longest_steps(world_positions(library.skeleton, clip)) for clip in (mine, theirs)]
    return max(steps[joint] / max(e[joint] for e in expected) for joint in graph.joints)


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    name=st.sampled_from(["Upper-Body", "Left-Arm"]),
    within=st.sampled_from([3, 12, 60]),
)
def test_a_part_is_let_go_as_soon_as_no_joint_need_hurry_or_when_they_do_least(
    seed: int, name: str, within: int, small_library: Library
) -> None:
    graph = small_library.by_name[name]
    begin, own, above = future(small_library, graph, seed)
    played = release(small_library, graph, iter(own), above, begin + within)
    hurries = {}
    for time in range(begin, begin + within + 1):
        at, window = place(own, time), [place(above, time + p) for p in range(graph.window)]
        if at is not None and None not in window and len({there.motion for there in window}) == 1:
            goes_on = all(b.frame == a.frame + 1 for a, b in pairwise(window))
            if goes_on:
                hurries[time] = slow_hurry(small_library, graph, at, window[0])
    if hurries:
        calm = [time for time, hurry in hurries.items() if hurry <= LIMIT]
        assert played[-1].begin == (calm[0] if calm else min(hurries, key=hurries.get))


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), name=st.sampled_from(["Upper-Body", "Left-Arm", "Right-Arm"]))
def test_until_it_is_let_go_a_part_goes_on_with_what_it_does(seed: int, name: str, small_library: Library) -> None:
    graph = small_library.by_name[name]
    begin, own, above = future(small_library, graph, seed)
    *before, blend = release(small_library, graph, iter(own), above, begin + WITHIN)
    assert (blend.target, blend.end - blend.begin) == (None, graph.window)
    assert begin <= blend.begin <= begin + WITHIN
    assert blend.source == place(own, blend.begin)
    time = begin
    for segment in before:
        assert segment.begin == time
        assert place([segment], segment.begin) == place(own, segment.begin)
        time = segment.end
    assert time == blend.begin


def test_where_the_graph_above_plays_no_window_of_a_clip_a_part_is_let_go_at_once(small_library: Library) -> None:
    graph = small_library.by_name["Upper-Body"]
    own = [Clip(5, 45, Position(0, 3), 40)]
    played = release(small_library, graph, iter(own), [Clip(5, 10, Position(1, 0), 5)], 65)
    assert played == (Blend(5, 5 + graph.window, Position(0, 3), None),)


@pytest.mark.parametrize("motion", [0, 1])
def test_a_part_that_does_what_the_graph_above_does_is_let_go_at_once(motion: int, small_library: Library) -> None:
    graph = small_library.by_name["Upper-Body"]
    own = [Clip(0, 60, Position(motion, 3), 60)]
    assert release(small_library, graph, iter(own), own, 30)[-1].begin == 0
