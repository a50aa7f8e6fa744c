"""How a part is let go, held against looking at each moment, frame by frame, joint by joint."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import takewhile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import rotations
from mlmg_runtime.blending import c1_weight
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.longest_steps import LongestSteps
from mlmg_runtime.playing.releasing import release
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline
from mlmg_runtime.skeleton import Poses, world_positions, world_transforms

LIMIT = 1.3
WITHIN = 60


Rest = tuple[list[Segment], MotionGraph, list[Segment]]


def future(library: Library, graph: MotionGraph, seed: int) -> tuple[int, Rest]:
    """Return from when on a part runs, what it will play, and what the graph above will, both to stay in a motion."""
    draw = np.random.default_rng(seed)
    begin = int(draw.integers(0, 50))

    def held(held_graph: MotionGraph, since: int) -> list[Segment]:
        motion = int(draw.integers(0, len(held_graph.motions)))
        frame = int(draw.integers(0, held_graph.n_frames[motion] - held_graph.window))
        position = Position(motion, frame)
        all_motions = range(len(held_graph.motions))
        segments = stay(Likeness(library), held_graph, motion, position, since, all_motions)
        return list(takewhile(lambda segment: segment.begin < begin + 200, segments))

    return begin, (held(graph, begin), library.root, held(library.root, begin - int(draw.integers(0, 30))))


def place(segments: list[Segment], time: int) -> Position | None:
    """Return the frame of a clip that is shown at a time, or from which a transition then begins."""
    for segment in segments:
        if isinstance(segment, Clip) and segment.begin <= time < segment.end:
            return Position(segment.first.motion, segment.first.frame + time - segment.begin)
        if isinstance(segment, Blend) and segment.begin == time:
            return segment.source
    return None


def shown(library: Library, graph: MotionGraph, segments: list[Segment], until: int) -> tuple[int, Poses]:
    """Return what a graph plays, from which output frame on."""
    start = segments[0].begin
    track = [replace(s, begin=s.begin - start, end=s.end - start) for s in segments if s.begin < until]
    return start, synthesize(library, Timeline(until - start, {graph.name: tuple(track)}), feet=False)


def seen(library: Library, graph: MotionGraph, poses: Poses) -> np.ndarray:
    """Return where a part's joints are, in the world and from what carries it, shape (2, n_frames, n_joints, 3)."""
    carrier = library.skeleton.parents[min(graph.joints)]
    turned, places = world_transforms(library.skeleton, poses)
    back = rotations.inverse(turned[:, carrier])
    carried = [rotations.rotate(back, places[:, joint] - places[:, carrier]) for joint in graph.joints]
    return np.stack((places[:, graph.joints], np.stack(carried, axis=1)))


def motions_at(graph: MotionGraph, segments: list[Segment], time: int) -> set[str]:
    segment = next((s for s in segments if s.begin <= time < s.end), segments[0])
    places = [segment.first] if isinstance(segment, Clip) else [segment.source, segment.target]
    return {graph.motions[at.motion] for at in places if at is not None}


def slow_hurries(
    library: Library, graph: MotionGraph, rest: Rest, times: list[int], deadline: int, length: int
) -> Iterator[float]:
    """Yield by how much blends that begin at some times exceed the longest steps in the clips that play."""
    own, driver, above = rest
    until = deadline + 2 * graph.window + 1
    theirs_from, theirs = shown(library, driver, above, until)
    heights = world_positions(library.skeleton, theirs)[max(times[0] - 1 - theirs_from, 0) :: 10, :, 1]
    hardly_seen = 0.045 * np.median(np.ptp(heights[:, library.skeleton.travel :], axis=1)) / library.frame_rate
    every = {motion for g in library.graphs for motion in library.motions(g)}
    clips = {motion: seen(library, graph, library.poses(motion)) for motion in every}
    longest = {motion: np.linalg.norm(np.diff(clip, axis=1), axis=-1).max(axis=1) for motion, clip in clips.items()}
    for time in times:
        leave = place(own, time)
        assert leave is not None
        mine = library.poses(graph.motions[leave.motion])
        turned, places, playing = [], [], []
        for p in range(-1, length + 1):
            mine_at = min(max(leave.frame + p, 0), mine.n_frames - 1)
            theirs_at = max(time + p - theirs_from, 0)
            weight = 1.0 if p < 0 else float(c1_weight(np.array(min((p + 1) / length, 1.0))))
            pose = theirs.rotations[theirs_at].copy()
            for joint in graph.joints:
                pose[joint] = rotations.slerp(mine.rotations[mine_at, joint], pose[joint], np.array(1.0 - weight))
            turned.append(pose)
            places.append(theirs.positions[theirs_at])
            playing.append({graph.motions[leave.motion]} | motions_at(driver, above, time + p))
        largest = 0.0
        points = seen(library, graph, Poses(np.array(turned), np.array(places)))
        for step, taken in enumerate(np.diff(points, axis=1).swapaxes(0, 1)):
            usual = np.max([longest[motion] for motion in playing[step] | playing[step + 1]], axis=0)
            for far, limit in zip(np.linalg.norm(taken, axis=-1).flat, usual.flat, strict=True):
                if far > hardly_seen:
                    largest = max(largest, far / limit)
        yield largest


@given(
    seed=st.integers(0, 2**32 - 1),
    name=st.sampled_from(["Upper-Body", "Left-Arm"]),
    within=st.sampled_from([3, 12, 60]),
)
def test_a_part_is_let_go_as_soon_as_no_joint_need_hurry_by_as_short_a_blend_as_can_be(
    seed: int, name: str, within: int, small_library: Library
) -> None:
    graph = small_library.by_name[name]
    begin, rest = future(small_library, graph, seed)
    *_, blend = release(LongestSteps(small_library), graph, *rest, begin + within)
    places = [time for time in range(begin, begin + within + 1) if place(rest[0], time) is not None]
    assert (blend.begin, blend.end - blend.begin) == slow_choice(small_library, graph, rest, places, begin + within)


def slow_choice(library: Library, graph: MotionGraph, rest: Rest, places: list[int], deadline: int) -> tuple[int, int]:
    for length in (graph.window, graph.window * 3 // 2, graph.window * 2):
        hurries = dict(zip(places, slow_hurries(library, graph, rest, places, deadline, length), strict=True))
        calm = [time for time, hurry in hurries.items() if hurry <= LIMIT]
        if calm:
            return calm[0], length
    return min(hurries, key=hurries.get), length


@given(seed=st.integers(0, 2**32 - 1), name=st.sampled_from(["Upper-Body", "Left-Arm", "Right-Arm"]))
def test_until_it_is_let_go_a_part_goes_on_with_what_it_does(seed: int, name: str, small_library: Library) -> None:
    graph = small_library.by_name[name]
    begin, rest = future(small_library, graph, seed)
    own = rest[0]
    *before, blend = release(LongestSteps(small_library), graph, *rest, begin + WITHIN)
    assert blend.target is None
    assert begin <= blend.begin <= begin + WITHIN
    assert blend.source == place(own, blend.begin)
    time = begin
    for segment in before:
        assert segment.begin == time
        assert place([segment], segment.begin) == place(own, segment.begin)
        time = segment.end
    assert time == blend.begin


def test_a_part_whose_transition_ends_after_the_deadline_is_let_go_when_it_can(small_library: Library) -> None:
    graph = small_library.by_name["Upper-Body"]
    own, above = (Clip(50, 250, Position(motion, 3), 200) for motion in (0, 1))
    played = release(LongestSteps(small_library), graph, [own], graph, [above], 40)
    assert played == (Blend(50, 50 + graph.window, Position(0, 3), None),)


@pytest.mark.parametrize("motion", [0, 1])
def test_a_part_that_does_what_the_graph_above_does_is_let_go_at_once(motion: int, small_library: Library) -> None:
    graph = small_library.by_name["Upper-Body"]
    own = [Clip(0, 60, Position(motion, 3), 60)]
    assert release(LongestSteps(small_library), graph, own, graph, own, 30)[-1].begin == 0
