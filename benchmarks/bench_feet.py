"""How far feet slide in transitions, with and without foot locking, and how far joints jump.

    python benchmarks/bench_feet.py

On the demo library and, where ../shared/mocap is present, on the reference clips, alone and with connecting clips. Of
random scripts, in transitions of the whole body:

- skate: how far the toes go over the ground in a frame, times 2 - 2^(h / H) where they are at a height h below H, a
  thirtieth of the leg; of both feet in all frames. "clips" is that of the frames that are blended, in their clips.
- planted: how far planted toes go over the ground in a frame where both motions have the foot in the air for a
  fifth of the transition at the same time; before that, planted in the motion that is left; after, in the other.
- jump: the longest step of a joint, over its longest in the clips that play; of steps over 0.25 % of the leg.
"""

from __future__ import annotations

import random
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import mlmg_lang
from mlmg_lang.perform import rehearse
from mlmg_runtime.arrays import BoolArray, FloatArray
from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.database import write_database
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.feet import find_plants
from mlmg_runtime.legs import find_legs
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.playing.synthesis import synthesize
from mlmg_runtime.playing.timeline import Blend, Segment, Timeline
from mlmg_runtime.skeleton import Poses, world_positions

ROOT = Path(__file__).parents[1]
MOCAP = ROOT.parent / "shared" / "mocap"
N_SCRIPTS = 20
GROUND = [0, 2]


def reference(folder: Path, *names: str) -> Library:
    """Return the library of some folders of real clips; those of all but the first are stepping stones."""
    clips = ", ".join(f'"{(MOCAP / name).as_posix()}/*.bvh"' for name in names)
    stones = "\n".join(f"{clip.stem} = []" for name in names[1:] for clip in sorted((MOCAP / name).glob("*.bvh")))
    configuration = (ROOT / "tests" / "reference.toml").read_text().replace("CLIPS", clips).replace("# STONES", stones)
    path = folder / f"{names[-1]}.toml"
    path.write_text(configuration)
    write_database(build_library(read_configuration(path), None, lambda *_: None), path.with_suffix(".mlmg"))
    return open_library(path.with_suffix(".mlmg"))


def script(library: Library, seed: int) -> str:
    draw = random.Random(seed)
    return "\n".join(f"{motion} for {draw.randint(1, 5)} sec" for motion in draw.choices(library.root.motions, k=12))


@dataclass
class Slides:
    skate: list[FloatArray] = field(default_factory=list)
    planted: list[FloatArray] = field(default_factory=list)
    jump: float = 0.0


class Feet:
    """The feet of a library's body, in its clips and in what is made of them."""

    def __init__(self, library: Library) -> None:
        self.library = library
        self.motions = library.root.motions
        self.legs = find_legs(library.skeleton, library.poses(self.motions[0]))
        self.toes = [leg.toes for leg in self.legs]
        self.points = {motion: self.world(library.poses(motion)) for motion in self.motions}
        self.planted = {m: find_plants(at, self.legs, library.frame_rate) for m, at in self.points.items()}
        self.longest = {m: step_lengths(at).max(axis=0) for m, at in self.points.items()}
        at, leg = self.points[self.motions[0]][0], self.legs[0]
        bones = ((leg.hip, leg.knee), (leg.knee, leg.ankle))
        self.leg = float(sum(np.linalg.norm(at[a] - at[b]) for a, b in bones))
        self.floor = min(float(np.quantile(at[:, self.toes, 1], 0.05)) for at in self.points.values())

    def world(self, poses: Poses) -> FloatArray:
        return world_positions(self.library.skeleton, poses)

    def skate(self, points: FloatArray) -> FloatArray:
        height = np.maximum(points[1:, self.toes, 1] - self.floor, 0.0)
        along = step_lengths(points[:, self.toes][..., GROUND])
        return along * np.maximum(2.0 - 2.0 ** (30.0 * height / self.leg), 0.0)

    def measure(self, timeline: Timeline, feet: bool, slides: Slides) -> None:
        points = self.world(synthesize(self.library, timeline, feet=feet))
        track = timeline.tracks[self.library.root.name]
        steps = step_lengths(points)
        expected = self.expected(track, len(points))
        slides.jump = max(slides.jump, float(np.where(steps > 0.0025 * self.leg, steps / expected, 0.0).max()))
        for blend in self.blends(track, len(points)):
            shown = points[blend.begin - 1 : blend.end]
            slides.skate.append(self.skate(shown))
            is_planted = self.planted_around_a_swing(blend)
            slides.planted.append(step_lengths(shown[:, self.toes][..., GROUND])[is_planted])

    def blends(self, track: Sequence[Segment], n_frames: int) -> list[Blend]:
        return [each for each in track if isinstance(each, Blend) and each.begin > 0 and each.end < n_frames]

    def windows(self, blend: Blend) -> tuple[tuple[str, np.ndarray], tuple[str, np.ndarray]]:
        """Return the motions that are blended, with the frames of each, from one before the blend on."""
        assert blend.target is not None
        k = blend.end - blend.begin
        ends = [(blend.source.motion, blend.source.frame - 1), (blend.target.motion, blend.target.frame - k)]
        left, entered = (
            (self.motions[motion], np.clip(first + np.arange(k + 1), 0, len(self.points[self.motions[motion]]) - 1))
            for motion, first in ends
        )
        return left, entered

    def planted_around_a_swing(self, blend: Blend) -> BoolArray:
        """Return in which steps a foot is planted, shape (k, n_feet): in none where it does not swing in both."""
        left, entered = (self.planted[motion][frames] for motion, frames in self.windows(blend))
        left, entered = left[1:] & left[:-1], entered[1:] & entered[:-1]
        found = np.zeros_like(left)
        for foot in range(left.shape[1]):
            air = np.flatnonzero(~left[:, foot] & ~entered[:, foot])
            if len(air):
                swing = max(np.split(air, np.flatnonzero(np.diff(air) > 1) + 1), key=len)
                if 5 * len(swing) >= len(left):
                    found[: swing[0], foot] = left[: swing[0], foot]
                    found[swing[-1] + 1 :, foot] = entered[swing[-1] + 1 :, foot]
        return found

    def expected(self, track: Sequence[Segment], n_frames: int) -> FloatArray:
        expected = np.full((n_frames - 1, len(self.library.skeleton.joints)), 1e-9)
        for each in track:
            ends = (each.source, each.target) if isinstance(each, Blend) else (each.first,)
            during = slice(max(each.begin - 1, 0), each.end)
            for end in ends:
                if end is not None:
                    expected[during] = np.maximum(expected[during], self.longest[self.motions[end.motion]])
        return expected


def step_lengths(points: FloatArray) -> FloatArray:
    return np.linalg.norm(np.diff(points, axis=0), axis=-1)


def report(name: str, library: Library) -> None:
    feet = Feet(library)
    found = {False: Slides(), True: Slides()}
    own = []
    for seed in range(N_SCRIPTS):
        plan, _ = mlmg_lang.compile(script(library, seed), library)
        assert plan is not None
        timeline = rehearse(plan, library).timeline
        for locked, slides in found.items():
            feet.measure(timeline, locked, slides)
        for blend in feet.blends(timeline.tracks[library.root.name], timeline.n_frames):
            own += [feet.skate(feet.points[motion][frames]) for motion, frames in feet.windows(blend)]
    print(f"{name:<32} {np.concatenate(own).mean():8.3f}", end="")
    for slides in found.values():
        skate, planted = np.concatenate(slides.skate), np.concatenate(slides.planted)
        print(f"   {skate.mean():6.3f} {planted.mean():8.3f} {np.median(planted):8.3f} {slides.jump:6.2f}", end="")
    print()


def main() -> int:
    print(f"{'cm a frame; jumps as multiples':<32} {'clips':>8}   {'without: ':<31}   {'with foot locking: ':<31}")
    columns = f"{'skate':>6} {'planted':>8} {'median':>8} {'jump':>6}"
    print(f"{'':<32} {'skate':>8}   {columns}   {columns}")
    report("demo", open_library(demo_library()))
    if not MOCAP.is_dir():
        print("../shared/mocap is absent: real clips are not measured")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        report("reference", reference(Path(folder), "reference"))
        report("reference and connecting clips", reference(Path(folder), "reference", "reference-plus"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
