"""Frames made of random timelines, held against the source clips frame by frame."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.blending import c1_weight, linear_weight
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline
from mlmg_runtime.point_cloud import best_fit
from mlmg_runtime.skeleton import Poses, world_positions

SEEDS = st.integers(0, 2**32 - 1)
VERTICAL = np.array([0.0, 1.0, 0.0])


@pytest.fixture(scope="session")
def play(moves, ask, small_library: Library) -> Callable[[int], Timeline]:
    """Return a function that makes, from a seed, the timeline of a character that was asked random things."""

    def timeline(seed: int) -> Timeline:
        performer = Performer(small_library, small_library.root.motions[seed % 4])
        performer.hold(1)
        for move in moves(seed):
            ask(performer, move)
        return performer.timeline()

    return timeline


def parts_below(library: Library, timeline: Timeline, n_frames: int) -> np.ndarray:
    """Return which joints a part of its own plays in each frame, shape (n_frames, n_joints)."""
    overlaid = np.zeros((n_frames, len(library.skeleton.joints)), dtype=bool)
    for graph in list(timeline.tracks)[1:]:
        for segment in timeline.tracks[graph]:
            overlaid[segment.begin : segment.end, list(library.by_name[graph].joints)] = True
    return overlaid


def apart_deg(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.degrees(rotations.angle_between(a, b))


def about_the_vertical(turn: FloatArray) -> FloatArray:
    """Return the angles, in degrees, by which rotations tilt the vertical."""
    return np.degrees(np.arccos(np.clip(rotations.rotate(turn, VERTICAL)[..., 1], -1.0, 1.0)))


@given(seed=SEEDS)
def test_inside_clips_played_at_their_own_speed_frames_are_the_sources(seed: int, play, small_library: Library) -> None:
    timeline = play(seed)
    poses = synthesize(small_library, timeline)
    overlaid = parts_below(small_library, timeline, poses.n_frames)
    for segment in timeline.tracks["Full-Body"]:
        if not isinstance(segment, Clip):
            continue
        frames = slice(segment.begin, min(segment.end, poses.n_frames))
        n = frames.stop - frames.start
        source = small_library.poses(small_library.root.motions[segment.first.motion])
        source = source[segment.first.frame : segment.first.frame + n]
        apart = apart_deg(poses.rotations[frames, 1:], source.rotations[:, 1:])
        assert np.where(overlaid[frames, 1:], 0.0, apart).max(initial=0.0) < 1e-4
        # The hips are those of the clip, turned about the vertical and moved over the ground once and for all.
        turn = rotations.multiply(poses.rotations[frames, 0], rotations.inverse(source.rotations[:, 0]))
        assert about_the_vertical(turn).max() < 1e-4
        assert apart_deg(turn, turn[0]).max() < 1e-4
        moved = poses.positions[frames, 0] - rotations.rotate(turn[0], source.positions[:, 0])
        np.testing.assert_allclose(moved, moved[[0]] * (1.0, 0.0, 1.0) + np.zeros_like(moved), atol=1e-6)


@given(seed=SEEDS)
def test_inside_clips_of_a_part_its_joints_are_the_sources(seed: int, play, small_library: Library) -> None:
    timeline = play(seed)
    poses = synthesize(small_library, timeline)
    for name in list(timeline.tracks)[1:]:
        graph = small_library.by_name[name]
        lower = {g: s for g, s in timeline.tracks.items() if name in small_library.ancestors(g)}
        overlaid = parts_below(small_library, Timeline(timeline.n_frames, {"": (), **lower}), poses.n_frames)
        for segment in timeline.tracks[name]:
            if isinstance(segment, Clip) and segment.n_source == segment.end - segment.begin:
                frames = slice(segment.begin, min(segment.end, poses.n_frames))
                source = small_library.poses(graph.motions[segment.first.motion])
                source = source[segment.first.frame : segment.first.frame + frames.stop - frames.start]
                joints = list(graph.joints)
                apart = apart_deg(poses.rotations[frames, joints], source.rotations[:, joints])
                assert np.where(overlaid[frames][:, joints], 0.0, apart).max(initial=0.0) < 1e-4


@given(seed=SEEDS)
def test_all_that_a_part_does_not_play_is_bit_for_bit_its_parents(seed: int, play, small_library: Library) -> None:
    timeline = play(seed)
    names = list(timeline.tracks)
    for n_graphs in range(1, len(names)):
        with_part, without = (
            synthesize(small_library, Timeline(timeline.n_frames, {g: timeline.tracks[g] for g in names[:n]}))
            for n in (n_graphs + 1, n_graphs)
        )
        part = {"": (), names[n_graphs]: timeline.tracks[names[n_graphs]]}
        overlaid = parts_below(small_library, Timeline(timeline.n_frames, part), timeline.n_frames)
        np.testing.assert_array_equal(with_part.positions, without.positions)
        np.testing.assert_array_equal(with_part.rotations[~overlaid], without.rotations[~overlaid])


@given(seed=SEEDS)
def test_the_same_timeline_gives_the_same_bytes(seed: int, play, small_library: Library) -> None:
    timeline = play(seed)
    first, second = synthesize(small_library, timeline), synthesize(small_library, timeline)
    assert first.rotations.tobytes() == second.rotations.tobytes()
    assert first.positions.tobytes() == second.positions.tobytes()


@given(seed=SEEDS)
def test_no_joint_goes_farther_than_its_clips_and_the_gap_of_its_transition(
    seed: int, play, small_library: Library
) -> None:
    timeline = play(seed)
    points = world_positions(small_library.skeleton, synthesize(small_library, timeline))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    assert np.all(steps <= longest_steps(small_library, timeline))


def longest_steps(library: Library, timeline: Timeline) -> FloatArray:
    """Return how far each joint may go at most from each frame to the next.

    That is 1.5 times its longest step in the clips that play there, those of a part and of the graphs above it
    added up, and, in a transition, a k-th of 1.5 times how far apart its two windows are. A blend made on the spot
    may go as far as it must.
    """
    longest = np.zeros((timeline.n_frames - 1, len(library.skeleton.joints)))
    for name, segments in timeline.tracks.items():
        graph = library.by_name[name]
        joints = list(graph.joints)
        own = np.zeros_like(longest)
        gaps = np.zeros_like(longest)
        for segment in segments:
            frames = slice(max(segment.begin - 1, 0), segment.end)
            for motion in motions_of(segment):
                own[frames] = np.maximum(own[frames], steps_of_clip(library, graph.motions[motion]))
            if isinstance(segment, Blend):
                edge = segment.transition
                gaps[frames] += np.inf if edge is None else 1.5 / graph.window * np.sqrt(edge.distance)
        longest[:, joints] += 1.5 * own[:, joints] + gaps[:, joints]
    return longest


@pytest.mark.parametrize("seed", range(8))
def test_on_the_demo_library_no_joint_steps_farther_than_half_as_far_again_as_its_clips(
    seed: int, moves, ask, demo_library: Library
) -> None:
    performer = Performer(demo_library, demo_library.root.motions[seed])
    performer.hold(60)
    for move in moves(seed):
        ask(performer, move)
    timeline = performer.timeline()
    points = world_positions(demo_library.skeleton, synthesize(demo_library, timeline))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    longest = np.zeros_like(steps)
    for name, segments in timeline.tracks.items():
        graph = demo_library.by_name[name]
        joints = list(graph.joints)
        for segment in segments:
            frames = slice(max(segment.begin - 1, 0), segment.end)
            for motion in motions_of(segment):
                own = steps_of_clip(demo_library, graph.motions[motion])
                longest[frames, joints] = np.maximum(longest[frames, joints], own[joints])
    assert np.all(steps <= 1.5 * longest)


def steps_of_clip(library: Library, motion: str) -> FloatArray:
    points = world_positions(library.skeleton, library.poses(motion))
    return np.linalg.norm(np.diff(points, axis=0), axis=-1).max(axis=0)


def motions_of(segment: Segment) -> set[int]:
    places = (segment.first,) if isinstance(segment, Clip) else (segment.source, segment.target)
    return {at.motion for at in places if at is not None}


# A transition, slowly


@pytest.fixture
def transition(small_library: Library) -> tuple[Timeline, Blend]:
    """Return a timeline of one transition between two motions, with a clip before and after."""
    edge = next(edge for edge in small_library.root.edges if edge.dst_motion != edge.src_motion and edge.src_frame > 5)
    blend = Blend(5, 13, Position(*edge[:2]), Position(*edge[2:4]), edge)
    before = Clip(0, 5, Position(edge.src_motion, edge.src_frame - 5), 5)
    rest = int(small_library.root.n_frames[edge.dst_motion]) - edge.arrival.frame
    return Timeline(13 + rest, {"Full-Body": (before, blend, Clip(13, 13 + rest, edge.arrival, rest))}), blend


def slow_blend(library: Library, graph: MotionGraph, blend: Blend, curve) -> list[tuple[FloatArray, FloatArray]]:
    """Return the rotations and the place of the hips of each blended frame, one after the other."""
    k = graph.window
    a = library.poses(graph.motions[blend.source.motion])[blend.source.frame : blend.source.frame + k]
    b = library.poses(graph.motions[blend.target.motion])[blend.target.frame - k + 1 : blend.target.frame + 1]
    joints = list(graph.joints)
    clouds = [world_positions(library.skeleton, poses)[None][:, :, joints] for poses in (a, b)]
    fit = best_fit(*clouds, graph.weights)
    turn = rotations.about_axis("Y", fit.yaw_rad[0])
    frames = []
    for p in range(k):
        weight = curve((p + 1) / k)
        hips = rotations.multiply(turn, b.rotations[p, 0])
        goal = np.concatenate((hips[None], b.rotations[p, 1:]))
        place = rotations.rotate(turn, b.positions[p, 0]) + np.insert(fit.shift[0], 1, 0.0)
        mixed = [rotations.slerp(x, y, np.array(1.0 - weight)) for x, y in zip(a.rotations[p], goal, strict=True)]
        frames.append((np.array(mixed), weight * a.positions[p, 0] + (1.0 - weight) * place))
    return frames


@pytest.mark.parametrize(
    ("name", "curve"),
    [("c1", lambda s: 2.0 * s**3 - 3.0 * s**2 + 1.0), ("linear", lambda s: 1.0 - s)],
)
def test_each_frame_of_a_transition_is_blended_with_its_weight(
    small_library: Library, transition: tuple[Timeline, Blend], name: str, curve
) -> None:
    timeline, blend = transition
    poses = synthesize(small_library, timeline, name)
    for p, (turned, place) in enumerate(slow_blend(small_library, small_library.root, blend, curve)):
        assert apart_deg(poses.rotations[blend.begin + p], turned).max() < 1e-5
        np.testing.assert_allclose(poses.positions[blend.begin + p, 0], place, atol=1e-9)


def test_without_a_choice_a_graph_is_blended_as_it_was_configured(
    small_library: Library, transition: tuple[Timeline, Blend]
) -> None:
    from dataclasses import replace

    root = replace(small_library.root, blend="linear")
    library = replace(small_library, by_name={**small_library.by_name, root.name: root})
    timeline, _ = transition
    for chosen, expected in ((library, "linear"), (small_library, "c1")):
        found = synthesize(chosen, timeline).rotations
        np.testing.assert_array_equal(found, synthesize(small_library, timeline, expected).rotations)


def test_after_a_transition_the_character_goes_on_from_where_it_is(
    small_library: Library, transition: tuple[Timeline, Blend]
) -> None:
    timeline, blend = transition
    hips = synthesize(small_library, timeline).positions[:, 0]
    source = small_library.poses(small_library.root.motions[blend.target.motion]).positions[blend.target.frame :, 0]
    lengths = [np.linalg.norm(np.diff(path, axis=0), axis=-1) for path in (hips[blend.end - 1 :], source)]
    np.testing.assert_allclose(lengths[0], lengths[1], atol=1e-9)


@pytest.mark.parametrize("weight", [c1_weight, linear_weight])
def test_weights_fall_from_one_to_none(weight) -> None:
    share = np.linspace(0.0, 1.0, 101)
    assert weight(share)[[0, 50, 100]].tolist() == pytest.approx([1.0, 0.5, 0.0])
    assert np.all(np.diff(weight(share)) < 0.0)


def test_the_smooth_weight_starts_and_ends_flat() -> None:
    slope = np.gradient(c1_weight(np.linspace(0.0, 1.0, 1001)), 0.001)
    assert abs(slope[0]) < 0.01
    assert abs(slope[-1]) < 0.01


# Parts, bent clips and odd ends


def test_a_bent_clip_shows_frames_between_the_sources(small_library: Library) -> None:
    whole = Clip(0, 30, Position(0, 0), 30)
    timeline = Timeline(30, {"Full-Body": (whole,), "Left-Arm": (Clip(4, 14, Position(1, 20), 12),)})
    arm = small_library.skeleton.names.index("LeftArm")
    found = synthesize(small_library, timeline).rotations[4:14, arm]
    source = small_library.poses("Reach").rotations[:, arm]
    for p in range(10):
        at = 20 + 1.2 * p
        before, share = int(at), at - int(at)
        expected = rotations.slerp(source[before], source[before + 1], np.array(share))
        assert apart_deg(found[p], expected) < 1e-5


def test_a_part_blended_onto_its_parent_ends_in_its_parents_pose(small_library: Library) -> None:
    whole = Clip(0, 30, Position(0, 0), 30)
    tracks = {"Full-Body": (whole,), "Left-Arm": (Blend(10, 16, Position(0, 30), None),)}
    alone = synthesize(small_library, Timeline(30, {"Full-Body": (whole,)}))
    found = synthesize(small_library, Timeline(30, tracks))
    joints = list(small_library.by_name["Left-Arm"].joints)
    for p in range(6):
        weight = float(c1_weight(np.array((p + 1) / 6)))
        for joint in joints:
            source = small_library.poses("Wave").rotations[30 + p, joint]
            expected = rotations.slerp(source, alone.rotations[10 + p, joint], np.array(1.0 - weight))
            assert apart_deg(found.rotations[10 + p, joint], expected) < 1e-5
    assert apart_deg(found.rotations[15], alone.rotations[15]).max() < 1e-5


def test_past_its_end_a_clip_stands_still(small_library: Library) -> None:
    last = small_library.n_frames("Wave") - 1
    whole = Clip(0, 30, Position(0, 0), 30)
    tracks = {"Full-Body": (whole,), "Left-Arm": (Blend(10, 16, Position(0, last), None),)}
    found = synthesize(small_library, Timeline(30, tracks), "linear").rotations[10]
    arm = small_library.skeleton.names.index("LeftArm")
    source = small_library.poses("Wave").rotations[last, arm]
    parent = small_library.poses("Stand").rotations[10, arm]
    assert apart_deg(found[arm], rotations.slerp(source, parent, np.array(1 / 6))) < 1e-5


def test_segments_that_reach_over_the_end_are_cut_there(small_library: Library) -> None:
    whole = Clip(0, 60, Position(0, 0), 60)
    tracks = {
        "Full-Body": (whole,),
        "Left-Arm": (Clip(5, 50, Position(0, 0), 45), Blend(50, 56, Position(0, 45), None)),
    }
    long = synthesize(small_library, Timeline(60, tracks))
    for n_frames in (1, 4, 7, 53):
        shown = {g: tuple(segment for segment in t if segment.begin < n_frames) for g, t in tracks.items()}
        short = synthesize(small_library, Timeline(n_frames, {g: t for g, t in shown.items() if t}))
        np.testing.assert_array_equal(short.rotations, long.rotations[:n_frames])


def test_the_clips_of_the_library_are_left_as_they_were(
    small_library: Library, transition: tuple[Timeline, Blend]
) -> None:
    timeline, _ = transition
    before = {m: small_library.poses(m).rotations.tobytes() for m in small_library.root.motions}
    poses: Poses = synthesize(small_library, timeline)
    poses.rotations[:] = 0.0
    assert {m: small_library.poses(m).rotations.tobytes() for m in small_library.root.motions} == before


def test_each_blend_of_a_joint_goes_the_shorter_way_round(small_library: Library) -> None:
    from dataclasses import replace

    turned = {"Stand": 0.0, "Wave": 165.0, "Reach": 195.0}
    poses = {}
    for motion, angle_deg in turned.items():
        clip = small_library.poses(motion)
        wobble = np.radians(angle_deg + 20.0 * np.sin(2.0 * np.arange(clip.n_frames)))
        still = np.zeros_like(clip.rotations)
        still[..., 0] = 1.0
        still[:, 2] = rotations.about_axis("Z", wobble if angle_deg else 0.0 * wobble)
        poses[motion] = Poses(still, clip.positions)
    library = replace(small_library, _poses=poses)
    arm = (
        Blend(0, 6, Position(0, 10), None),
        Clip(20, 25, Position(1, 5), 5),
        Blend(25, 31, Position(1, 10), None),
    )
    timeline = Timeline(40, {"Full-Body": (Clip(0, 40, Position(0, 0), 40),), "Left-Arm": arm})
    left = synthesize(library, timeline).rotations[:, 2]
    angle_deg = np.degrees(2.0 * np.arctan2(left[:, 3], left[:, 0])) % 360.0
    assert np.all(angle_deg[1:5] < 185.0)
    assert np.all(angle_deg[26:30] > 175.0)
