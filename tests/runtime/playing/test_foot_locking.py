"""Feet in transitions of the demo library, with and without locking."""

from collections.abc import Callable

import numpy as np
import pytest

from mlmg_runtime.feet import find_plants
from mlmg_runtime.legs import find_legs
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import Position, Transition
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Timeline, play_transition
from mlmg_runtime.skeleton import Poses, world_positions

SEEDS = range(6)


@pytest.fixture(scope="module")
def timeline(moves, ask, demo_library: Library) -> Callable[[int], Timeline]:
    """Return a function that makes, from a seed, the timeline of a character that was asked random things."""

    def make(seed: int) -> Timeline:
        performer = Performer(demo_library, demo_library.root.motions[seed])
        performer.hold(60)
        for move in moves(seed):
            ask(performer, move)
        return performer.timeline()

    return make


def both(library: Library, timeline: Timeline) -> tuple[Poses, Poses]:
    """Return poses without and with locked feet."""
    return synthesize(library, timeline, feet=False), synthesize(library, timeline)


def blended(library: Library, timeline: Timeline) -> np.ndarray:
    """Return whether the whole body is blended in each frame."""
    found = np.zeros(timeline.n_frames, dtype=bool)
    for segment in timeline.tracks[library.root.name]:
        found[segment.begin : segment.end] |= isinstance(segment, Blend)
    return found


def joints_of_legs(library: Library) -> list[int]:
    legs = find_legs(library.skeleton, library.poses("Idle_01"))
    below = [library.skeleton.subtree(leg.ankle) for leg in legs]
    return sorted({joint for leg in legs for joint in (leg.hip, leg.knee)}.union(*below))


@pytest.mark.parametrize("seed", SEEDS)
def test_frames_of_clips_and_all_but_the_legs_are_bit_for_bit_what_they_were(
    seed: int, timeline, demo_library: Library
) -> None:
    asked = timeline(seed)
    free, locked = both(demo_library, asked)
    np.testing.assert_array_equal(locked.positions, free.positions)
    is_blended = blended(demo_library, asked)
    np.testing.assert_array_equal(locked.rotations[~is_blended], free.rotations[~is_blended])
    others = np.setdiff1d(np.arange(len(demo_library.skeleton.joints)), joints_of_legs(demo_library))
    np.testing.assert_array_equal(locked.rotations[:, others], free.rotations[:, others])
    assert np.array_equal(locked.rotations, free.rotations) != is_blended.any()


def test_what_a_part_plays_changes_nothing_else(demo_library: Library) -> None:
    edge = walking(demo_library)[0]
    whole = alone(demo_library, edge)
    arm = {"Left-Hand": (Clip(2, 20, Position(0, 0), 18),)}
    with_part = Timeline(whole.n_frames, {**whole.tracks, **arm})
    _, locked = both(demo_library, whole)
    _, found = both(demo_library, with_part)
    own = list(demo_library.by_name["Left-Hand"].joints)
    others = np.setdiff1d(np.arange(len(demo_library.skeleton.joints)), own)
    np.testing.assert_array_equal(found.rotations[:, others], locked.rotations[:, others])


@pytest.mark.parametrize("seed", SEEDS)
def test_bones_keep_their_lengths_and_rotations_are_rotations(seed: int, timeline, demo_library: Library) -> None:
    free, locked = both(demo_library, timeline(seed))
    np.testing.assert_allclose(np.linalg.norm(locked.rotations, axis=-1), 1.0)
    skeleton = demo_library.skeleton
    lengths = [
        np.linalg.norm(points[:, 1:] - points[:, list(skeleton.parents[1:])], axis=-1)
        for points in (world_positions(skeleton, poses) for poses in (free, locked))
    ]
    np.testing.assert_allclose(lengths[1], lengths[0], atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_last_blended_frame_is_the_one_that_is_led_to(seed: int, timeline, demo_library: Library) -> None:
    asked = timeline(seed)
    points = [world_positions(demo_library.skeleton, poses) for poses in both(demo_library, asked)]
    ends = [segment.end - 1 for segment in asked.tracks["Full-Body"] if isinstance(segment, Blend)]
    ends = [end for end in ends if end < asked.n_frames]
    np.testing.assert_allclose(points[1][ends], points[0][ends], atol=1e-3)


def test_a_transition_that_the_end_cuts_short_is_the_same_up_to_there(demo_library: Library) -> None:
    whole = alone(demo_library, walking(demo_library)[0])
    long = synthesize(demo_library, whole)
    for n_frames in (1, 2, 12, 21):
        segments = tuple(each for each in whole.tracks["Full-Body"] if each.begin < n_frames)
        short = synthesize(demo_library, Timeline(n_frames, {"Full-Body": segments}))
        np.testing.assert_allclose(short.rotations, long.rotations[:n_frames], atol=1e-9)


def test_locked_feet_are_the_same_bytes_each_time(timeline, demo_library: Library) -> None:
    asked = timeline(0)
    first, second = synthesize(demo_library, asked), synthesize(demo_library, asked)
    assert first.rotations.tobytes() == second.rotations.tobytes()


# Slides


def walking(library: Library) -> list[Transition]:
    """Return the transitions between two motions that walk."""
    names = library.root.motions
    return [
        edge
        for edge in library.root.edges
        if "Walk" in names[edge.src_motion] and "Walk" in names[edge.dst_motion] and edge.src_frame > 0
    ]


def alone(library: Library, edge: Transition) -> Timeline:
    """Return the timeline of one transition, with a frame before and a frame after it."""
    k = library.root.window
    before = Clip(0, 1, Position(edge.src_motion, edge.src_frame - 1), 1)
    return Timeline(k + 2, {"Full-Body": (before, play_transition(1, edge, k), Clip(k + 1, k + 2, edge.arrival, 1))})


def planted(library: Library, motion: int, first: int) -> np.ndarray:
    """Return which feet are planted in k steps of a motion from the one that ends at `first` on, shape (k, 2)."""
    poses = library.poses(library.root.motions[motion])
    points = world_positions(library.skeleton, poses)
    stands = find_plants(points, find_legs(library.skeleton, poses), library.frame_rate)
    stands = stands[first - 1 : first + library.root.window]
    return stands[1:] & stands[:-1]


def slides(library: Library, edge: Transition, poses: Poses) -> list[float]:
    """Return how far planted toes go in a frame, the mean of each foot that swings in both motions at a time.

    Before its swing it is planted in the motion that is left, after it in the motion that is entered.
    """
    k = library.root.window
    toes = [leg.toes for leg in find_legs(library.skeleton, library.poses("Walk_01"))]
    steps = np.diff(world_positions(library.skeleton, poses)[: k + 1, toes], axis=0)
    left = planted(library, edge.src_motion, edge.src_frame)
    entered = planted(library, edge.dst_motion, edge.dst_frame - k + 1)
    found = []
    for foot in range(2):
        air = np.flatnonzero(~left[:, foot] & ~entered[:, foot])
        if len(air) < 6 or np.any(np.diff(air) > 1):
            continue
        stands = np.concatenate((left[: air[0], foot], np.zeros(len(air), bool), entered[air[-1] + 1 :, foot]))
        if stands.any():
            found.append(float(np.hypot(steps[stands, foot, 0], steps[stands, foot, 2]).mean()))
    return found


def test_feet_that_stand_before_and_after_a_step_do_not_slide(demo_library: Library) -> None:
    free, locked = [], []
    for edge in walking(demo_library)[::2]:
        for poses, found in zip(both(demo_library, alone(demo_library, edge)), (free, locked), strict=True):
            found.extend(slides(demo_library, edge, poses))
    assert len(free) > 50
    assert np.median(free) > 0.03
    assert np.median(locked) < 0.001
    assert max(locked) < 0.1


def test_feet_that_stand_all_the_time_step_rather_than_slide_far(demo_library: Library) -> None:
    skeleton = demo_library.skeleton
    names = demo_library.root.motions
    leg = find_legs(skeleton, demo_library.poses("Idle_01"))[0]
    one, other = names.index("Idle_01"), names.index("Music_01")
    heights = []
    for dst_frame in range(25, 400, 50):
        edge = Transition(one, 20, other, dst_frame, 1.0, 0.5)
        stands = planted(demo_library, one, 20)[:, 0].all() and planted(demo_library, other, dst_frame - 19)[:, 0].all()
        ankle = [world_positions(skeleton, p)[:, leg.ankle] for p in both(demo_library, alone(demo_library, edge))]
        way = float(np.linalg.norm(ankle[1][-1] - ankle[1][0]))
        if stands and way > 6.0:
            heights.append((ankle[1][:, 1].max() - ankle[1][[0, -1], 1].max()) / way)
    assert heights
    assert min(heights) > 0.1


def test_on_real_clips_feet_that_stand_before_and_after_a_step_slide_less(
    reference_library: Library,
) -> None:
    free, locked = [], []
    for edge in walking(reference_library):
        if edge.cost < 0.9:
            for poses, found in zip(
                both(reference_library, alone(reference_library, edge)), (free, locked), strict=True
            ):
                found.extend(slides(reference_library, edge, poses))
    assert len(free) > 20
    assert np.median(locked) < 0.7 * np.median(free)
