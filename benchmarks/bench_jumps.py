"""How far joints go from one frame to the next, beside their clips: in the world, and from what carries a body part.

    python benchmarks/bench_jumps.py [SCRIPTS]

On the demo library and, where ../shared/mocap is present, on the reference clips: the longest step of a joint over its
longest in the clips that play at the time, in random scripts (40). By the smallest graph that a joint is of, by the
graph that moves it, and by what that plays: a clip, a transition, a blend made on the spot, or a blend that lets a part
go. Steps that are hardly seen do not count, but in the column that says so.

In the world, all clips that play count, and what carries a part adds to its steps. Seen from its carrier (of an upper
body, the hips), a part has nothing but its own movement, and only its own clips count.

Last, for all pairs of motions between which a transition of a part goes half as fast again: the least that a transition
between them could do, wherever they are left and entered.
"""

from __future__ import annotations

import random
import sys
import tempfile
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from bench_feet import MOCAP, reference

import mlmg_lang
from mlmg_lang.perform import rehearse
from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.blending import WEIGHTS
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.motion_graph import MotionGraph
from mlmg_runtime.pace import creep, stature, steps
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline
from mlmg_runtime.skeleton import Poses, carried_positions, world_positions, world_transforms

LIMIT = 1.5


def script(library: Library, seed: int) -> str:
    draw = random.Random(seed)
    lines = []
    for motion in draw.choices(library.root.motions, k=8):
        line = motion
        for name in library.graphs[1:]:
            graph = library.by_name[name]
            if motion in graph.index and draw.random() < 0.6:
                line += f" with {name} {draw.choice(graph.motions)}"
                break
        lines.append(f"{line} for {draw.randint(1, 5)} sec")
    return "\n".join(lines)


class Body:
    """A library's joints by the smallest graph that each is of, and their longest steps in its clips."""

    def __init__(self, library: Library) -> None:
        self.library = library
        self.graphs = [library.by_name[name] for name in library.graphs]
        smallest = sorted(self.graphs, key=lambda graph: len(graph.joints), reverse=True)
        group = {joint: graph.name for graph in smallest for joint in graph.joints}
        self.groups = {graph.name: [j for j in graph.joints if group[j] == graph.name] for graph in self.graphs}
        motions = {motion for graph in self.graphs for motion in graph.motions}
        self.longest = {motion: [v.max(axis=0) for v in self.steps(library.poses(motion))] for motion in motions}
        self._longest_steps: dict[tuple[int, frozenset[str]], FloatArray] = {}
        points = [world_positions(library.skeleton, library.poses(motion)) for motion in library.root.motions]
        self.hardly_seen = creep(stature(library.skeleton, points), library.frame_rate)

    def steps(self, poses: Poses) -> tuple[FloatArray, FloatArray]:
        """Return the steps of all joints in the world, and from what carries the smallest part that each is of."""
        turned, places = world_transforms(self.library.skeleton, poses)
        carried = places.copy()
        for graph in self.graphs:
            own = self.groups[graph.name]
            if graph.parent is not None:
                seen = carried_positions(self.library.skeleton, turned, places, graph.joints)
                carried[:, own] = seen[:, [graph.joints.index(joint) for joint in own]]
        return steps(places), steps(carried)

    def longest_step(self, view: int, motions: frozenset[str]) -> FloatArray:
        """Return the longest step of each joint in some motions: in the world (0), or from its carrier (1)."""
        if (view, motions) not in self._longest_steps:
            longest = np.max([self.longest[motion][view] for motion in sorted(motions)], axis=0)
            self._longest_steps[view, motions] = np.maximum(longest, 1e-9)
        return self._longest_steps[view, motions]


class Playing(NamedTuple):
    """What moves joints in a frame: the graph, its segment, and the motions whose frames that shows or blends."""

    graph: MotionGraph
    segment: Segment
    motions: frozenset[str]


def playing(library: Library, timeline: Timeline, name: str) -> list[Playing]:
    """Return what moves the joints of a graph in each frame: the graph itself, or what it follows."""
    graph, parent = library.by_name[name], library.parent(name)
    above = [] if parent is None else playing(library, timeline, parent)
    shown: list[Playing | None] = [*above] if above else [None] * timeline.n_frames
    for segment in timeline.tracks.get(name, ()):
        places = (segment.first,) if isinstance(segment, Clip) else (segment.source, segment.target)
        motions = frozenset(graph.motions[place.motion] for place in places if place is not None)
        for frame in range(segment.begin, min(segment.end, timeline.n_frames)):
            onto = above[frame].motions if kind(segment) == "let go" else frozenset()
            shown[frame] = Playing(graph, segment, motions | onto)
    return [each for each in shown if each is not None]


def kind(segment: Segment) -> str:
    if isinstance(segment, Clip):
        return "clip"
    if segment.target is None:
        return "let go"
    return "transition" if segment.transition else "on the spot"


class Largest(NamedTuple):
    """The largest ratios in a segment: in the world with what is hardly seen, in the world, and from the carrier."""

    all_steps: float
    world: float
    carried: float


def ratios(body: Body, timeline: Timeline) -> Iterator[tuple[str, Playing, Largest]]:
    """Yield, for each group of joints and each segment that moves it, its largest ratios."""
    world, carried = body.steps(synthesize(body.library, timeline))
    shown = {name: playing(body.library, timeline, name) for name in body.library.graphs}
    for name, joints in body.groups.items():
        found: dict[tuple[str, int], tuple[Playing, list[float]]] = {}
        for step, around in enumerate(pairwise(shown[name])):
            own = around[0].motions | around[1].motions
            every = own.union(*(each[frame].motions for each in shown.values() for frame in (step, step + 1)))
            in_world = world[step, joints] / body.longest_step(0, every)[joints]
            seen = world[step, joints] > body.hardly_seen, carried[step, joints] > body.hardly_seen
            beside = carried[step, joints] / body.longest_step(1, own)[joints]
            three = (in_world, np.where(seen[0], in_world, 0.0), np.where(seen[1], beside, 0.0))
            moved_by = max(around, key=lambda each: isinstance(each.segment, Blend))
            _, largest = found.setdefault((moved_by.graph.name, moved_by.segment.begin), (moved_by, [0.0] * 3))
            largest[:] = [max(old, float(new.max(initial=0.0))) for old, new in zip(largest, three, strict=True)]
        for moved_by, largest in found.values():
            yield name, moved_by, Largest(*largest)


def least(library: Library, graph: MotionGraph, pair: tuple[str, str], hardly_seen: float) -> float:
    """Return the least that k frames between two motions do, from whichever window to whichever, from the carrier."""
    joints, k = list(graph.joints), graph.window
    left, entered = (library.poses(motion).rotations[:, joints] for motion in pair)
    longest = np.max([steps(_carried(library, graph, clip)).max(axis=0) for clip in (left, entered)], axis=0)
    share = 1.0 - WEIGHTS[graph.blend](np.clip(np.arange(k + 2) / k, 0.0, 1.0))
    windows = np.clip(np.arange(len(entered) - k + 1)[:, None] + np.arange(-1, k + 1), 0, len(entered) - 1)
    target = entered[windows].reshape(-1, len(joints), 4)
    found = np.inf
    for first in range(len(left) - k + 1):
        source = np.tile(left[np.clip(np.arange(first - 1, first + k + 1), 0, len(left) - 1)], (len(windows), 1, 1))
        starts = np.arange(0, len(target), k + 2)
        blend = rotations.slerp_movements(source, target, np.tile(share, len(windows)), starts)
        taken = steps(_carried(library, graph, blend).reshape(len(windows), k + 2, -1, 3))
        ratio = np.where(taken > hardly_seen, taken / np.maximum(longest, 1e-9), 0.0)
        found = min(found, float(ratio.max(axis=(1, 2)).min()))
    return found


def _carried(library: Library, graph: MotionGraph, turned: FloatArray) -> FloatArray:
    """Return where a part's joints are from what carries it, by their local rotations alone."""
    skeleton = library.skeleton
    pose = library.poses(library.root.motions[0])[:1]
    poses = Poses(np.repeat(pose.rotations, len(turned), axis=0), np.repeat(pose.positions, len(turned), axis=0))
    poses.rotations[:, list(graph.joints)] = turned
    return carried_positions(skeleton, *world_transforms(skeleton, poses), graph.joints)


def report(title: str, library: Library, n_scripts: int) -> None:
    body = Body(library)
    table: dict[tuple[str, str, str], list[Largest]] = {}
    hurried: dict[tuple[str, tuple[str, str]], float] = {}
    for seed in range(n_scripts):
        plan, _ = mlmg_lang.compile(script(library, seed), library)
        if plan is None:
            continue
        for name, moved_by, largest in ratios(body, rehearse(plan, library).timeline):
            graph, segment = moved_by.graph, moved_by.segment
            table.setdefault((name, graph.name, kind(segment)), []).append(largest)
            if kind(segment) == "transition" and graph.name == name and largest.carried > LIMIT:
                pair = graph.motions[segment.source.motion], graph.motions[segment.target.motion]
                hurried[name, pair] = max(hurried.get((name, pair), 0.0), largest.carried)
    for (name, mover, what), found in sorted(table.items()):
        every, world, carried = np.max(found, axis=0)
        over = [sum(value > LIMIT for value in values) for values in list(zip(*found, strict=True))[1:]]
        row = f"{every:9.2f} {world:9.2f} {over[0]:6} {carried:9.2f} {over[1]:6} {len(found):6}"
        print(f"{title:<10} {name:<11} {mover:<11} {what:<12} {row}")
    for (name, pair), largest in sorted(hurried.items()):
        graph = library.by_name[name]
        if graph.parent is not None:
            bound = least(library, graph, pair, body.hardly_seen)
            print(f"{title:<10} {name}, {pair[0]} to {pair[1]}: {largest:.2f}; no transition could do with {bound:.2f}")


def main() -> int:
    n_scripts = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    print(f"{'':<10} {'':<11} {'':<11} {'':<12} {'in the world':^26} {'from carrier':^16}")
    columns = f"{'all steps':>9} {'seen':>9} {'> 1.5':>6} {'seen':>9} {'> 1.5':>6} {'of':>6}"
    print(f"{'library':<10} {'joints of':<11} {'moved by':<11} {'in a':<12} {columns}")
    report("demo", open_library(demo_library()), n_scripts)
    if not MOCAP.is_dir():
        print("../shared/mocap is absent: real clips are not measured")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        report("reference", reference(Path(folder), "reference"), n_scripts)
    return 0


if __name__ == "__main__":
    sys.exit(main())
