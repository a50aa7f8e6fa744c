"""No joint steps farther between two frames than the clips let expect.

The longest step of a joint in the world is at most 1.5 times its longest in the clips that play at the time. Three
things on real clips exceed that, and docs/measurements.md tells of them: toes that stand still in a whole clip creep by
less than 3 mm a frame in transitions that blend unseen; an upper body is carried about by hips not its own, so that it
is held to 1.5 times as seen from these; and two people who hardly move, but hold their heads elsewhere, are too far
apart for the frames of a transition, wherever that leads from one to the other.
"""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mlmg_lang
from mlmg_runtime import rotations
from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.clips import poses_from_bvh
from mlmg_runtime.database import write_database
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.skeleton import Poses, world_positions, world_transforms

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.ms"))


def random_script(seed: int) -> str:
    draw = random.Random(seed)
    lines = []
    for _ in range(8):
        line = draw.choice(["WALK", "IDLE", "TALK", "Music", "Idle_02", "Talk_02", "Walk_02"])
        if line != "Idle_02" and draw.random() < 0.6:
            line += " with Upper-Body " + draw.choice(["TALK", "SWING_HAND", "WAVE_HAND", "Music", "IDLE"])
        if not line.startswith("Idle_02") and draw.random() < 0.4:
            line += " with Left-Hand WAVE"
        lines.append(f"{line} for {draw.randint(1, 5)} sec")
    return "\n".join(lines)


def steps(library: Library, poses: Poses) -> np.ndarray:
    """Return how far each joint goes from each frame to the next, shape (n_frames - 1, n_joints)."""
    return np.linalg.norm(np.diff(world_positions(library.skeleton, poses), axis=0), axis=-1)


def longest_expected(library: Library, report: dict[str, Any]) -> np.ndarray:
    """Return the longest step of each joint in the clips that play at each step, shape (n_frames - 1, n_joints)."""
    longest = {m: steps(library, library.poses(m)).max(axis=0) for g in library.graphs for m in library.motions(g)}
    expected = np.zeros((report["n_frames"] - 1, len(library.skeleton.joints)))
    for entries in report["tracks"].values():
        for entry in entries:
            ends = [entry["from"], entry["to"]] if "from" in entry else [[entry["motion"]]]
            during = slice(max(entry["begin"] - 1, 0), entry["end"])
            for end in filter(None, ends):
                expected[during] = np.maximum(expected[during], longest[end[0]])
    return expected


def longest_by_motion(library: Library, joints: tuple[int, ...]) -> dict[str, np.ndarray]:
    motions = {motion for graph in library.graphs for motion in library.motions(graph)}
    return {motion: steps_from_carrier(library, library.poses(motion), joints).max(axis=0) for motion in motions}


def steps_from_carrier(library: Library, poses: Poses, joints: tuple[int, ...]) -> np.ndarray:
    """Return the steps of a part's joints as seen from what carries it, shape (n_frames - 1, n_joints)."""
    carrier = library.skeleton.parents[min(joints)]
    turned, places = world_transforms(library.skeleton, poses)
    back = rotations.inverse(turned[:, carrier])
    away = [rotations.rotate(back, places[:, joint] - places[:, carrier]) for joint in joints]
    return np.linalg.norm(np.diff(away, axis=1), axis=-1).T


def by_frame(report: dict[str, Any], graph: str) -> list[dict[str, Any] | None]:
    """Return the entry of a graph's track that each frame lies in, None where it follows the graph above."""
    entries: list[dict[str, Any] | None] = [None] * report["n_frames"]
    for entry in report["tracks"].get(graph, ()):
        entries[entry["begin"] : entry["end"]] = [entry] * (entry["end"] - entry["begin"])
    return entries


def shown(own: dict[str, Any] | None, above: dict[str, Any]) -> set[str]:
    """Return the motions that a part shows in a frame, by the entries of its graph and of the one above."""
    if own is None or own["kind"] == "clip":
        return {(own or above)["motion"]} if (own or above)["kind"] == "clip" else {above["from"][0], above["to"][0]}
    return {own["from"][0]} | (shown(None, above) if own["to"] is None else {own["to"][0]})


def check(script: str, library: Library, creep: float = 1e-3) -> None:
    plan, diagnostics = mlmg_lang.compile(script, library)
    assert plan is not None, diagnostics
    performance = mlmg_lang.play(plan, library)
    taken = steps(library, poses_from_bvh(performance.bvh))
    assert (taken <= np.maximum(1.5 * longest_expected(library, performance.report), creep)).all()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_no_joint_jumps_in_the_examples(path, demo_library):
    check(path.read_text(encoding="utf-8"), demo_library)


@pytest.mark.parametrize("seed", range(40))
def test_no_joint_jumps_in_a_random_script(seed, demo_library):
    check(random_script(seed), demo_library)


@pytest.mark.parametrize("seed", range(6))
def test_no_joint_of_the_whole_body_jumps_on_real_clips(seed, reference_library):
    draw = random.Random(seed)
    motions = draw.choices(reference_library.root.motions, k=12)
    check("\n".join(f"{motion} for {draw.randint(1, 5)} sec" for motion in motions), reference_library, creep=0.3)


def test_no_joint_jumps_between_a_real_clip_and_itself_in_a_mirror(mocap, tmp_path):
    clip = (mocap / "reference" / "Walk_01.bvh").as_posix()
    configuration = tmp_path / "library.toml"
    text = f'[library]\nclips = ["{clip}"]\n[clips.Mirrored]\nfile = "{clip}"\nmirror = true\n'
    configuration.write_text(text, encoding="utf-8")
    write_database(build_library(read_configuration(configuration), None, lambda *_: None), tmp_path / "two.mlmg")
    lines = ["Mirrored for 4 sec", "Walk_01 for 3 sec", "Mirrored for 3 sec", "Walk_01 for 3 sec"]
    check("\n".join(lines), open_library(tmp_path / "two.mlmg"))


def too_far_apart(*entries: dict[str, Any] | None) -> bool:
    """Return whether a transition leads between those two who hold their heads elsewhere."""
    ends = [{entry["from"][0], entry["to"][0]} for entry in entries if entry and entry["kind"] == "transition"]
    return {"Idle_01", "Talk_01"} in ends


@pytest.mark.parametrize("seed", range(8))
def test_no_joint_of_an_upper_body_jumps_on_real_clips_as_seen_from_the_hips(seed, reference_library):
    draw = random.Random(seed)
    upper = reference_library.by_name["Upper-Body"]
    lines = [
        f"{draw.choice(upper.motions)} with Upper-Body {draw.choice(upper.motions)} for {draw.randint(1, 3)} sec"
        for _ in range(10)
    ]
    plan, diagnostics = mlmg_lang.compile("\n".join(lines), reference_library)
    assert plan is not None, diagnostics
    performance = mlmg_lang.play(plan, reference_library)
    taken = steps_from_carrier(reference_library, poses_from_bvh(performance.bvh), upper.joints)
    longest = longest_by_motion(reference_library, upper.joints)
    own, above = (by_frame(performance.report, graph) for graph in ("Upper-Body", "Full-Body"))
    motions = [shown(*entries) for entries in zip(own, above, strict=True)]
    for step, far in enumerate(taken):
        expected = np.max([longest[motion] for motion in motions[step] | motions[step + 1]], axis=0)
        limit = 2.2 if too_far_apart(*own[step : step + 2]) else 1.5
        assert (far <= np.maximum(limit * expected, 0.2)).all()
