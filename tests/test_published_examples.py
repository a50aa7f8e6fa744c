"""The published examples give what was published, on the demo library and on real clips.

Each row is a script, where it starts, and what the report must say: for each command the motions that drive the
graphs it names. Where a script leaves the choice to the clips, any of the motions named will do; the graphs are fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mlmg_lang
from mlmg_runtime import clips
from mlmg_runtime.built_library import BuiltLibrary
from mlmg_runtime.database import write_database
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.skeleton import world_positions

WALK = "Walk_01 Walk_02 Walk_03"
IDLE = "Idle_01 Idle_02 Music_01 Talk_01"
TALK = "Talk_01 Talk_02"


@dataclass(frozen=True)
class Example:
    script: str
    start: str | None
    commands: tuple[dict[str, str], ...]
    graphs: tuple[str, ...]


EXAMPLES = (
    Example("IDLE", "Idle_01", ({"Full-Body": "Idle_01"},), ("Full-Body",)),
    Example("SWING_HAND", "Idle_01", ({"Upper-Body": "Walk_01 Walk_02"},), ("Full-Body", "Upper-Body")),
    Example(
        "WALK with Upper-Body TALK",
        "Idle_01",
        ({"Full-Body": WALK, "Upper-Body": TALK},),
        ("Full-Body", "Upper-Body"),
    ),
    Example("TALK and IDLE", "Idle_01", ({"Full-Body": "Talk_01"},), ("Full-Body",)),
    Example("WALK and TALK", "Idle_01", ({"Full-Body": WALK, "Upper-Body": TALK},), ("Full-Body", "Upper-Body")),
    Example(
        "Idle_01\nWALK for 10 sec\nWALK with Sub TALK for 10 sec\nIDLE",
        None,
        ({"Full-Body": "Idle_01"}, {"Full-Body": WALK}, {"Full-Body": WALK, "Upper-Body": TALK}, {"Full-Body": IDLE}),
        ("Full-Body", "Upper-Body"),
    ),
    Example(
        "Idle_02\nWALK for 10 sec\nWALK with Sub TALK for 10 sec\nIDLE",
        None,
        ({"Full-Body": "Idle_02"}, {"Full-Body": WALK}, {"Full-Body": WALK, "Upper-Body": TALK}, {"Full-Body": IDLE}),
        ("Full-Body", "Upper-Body"),
    ),
)
THREE_LAYERS = Example(
    "Walk01 with Upper-Body Talk01 with Left-Hand Wave01",
    None,
    ({"Full-Body": "Walk_01", "Upper-Body": "Talk_01", "Left-Hand": "Wave_01"},),
    ("Full-Body", "Upper-Body", "Left-Hand"),
)


def opened(built: BuiltLibrary, folder: Path) -> Library:
    write_database(built, folder / "reference.mlmg")
    return open_library(folder / "reference.mlmg")


@pytest.fixture(scope="session")
def reference_plus(build_reference, tmp_path_factory) -> Library:
    return opened(build_reference("reference", "reference-plus"), tmp_path_factory.mktemp("plus"))


@pytest.fixture(scope="session")
def reference_6channel(build_reference, tmp_path_factory) -> Library:
    return opened(build_reference("reference-6channel"), tmp_path_factory.mktemp("6channel"))


def report_of(example: Example, library: Library) -> dict[str, Any]:
    plan, diagnostics = mlmg_lang.compile(example.script, library, start=example.start)
    assert plan is not None, diagnostics
    return mlmg_lang.play(plan, library).report


def check(example: Example, library: Library) -> None:
    report = report_of(example, library)
    assert len(report["commands"]) == len(example.commands)
    for command, expected in zip(report["commands"], example.commands, strict=True):
        assert set(command["motions"]) == set(expected)
        for graph, motions in expected.items():
            assert command["motions"][graph] in motions.split(), (command, graph)
    assert tuple(report["tracks"]) == example.graphs


@pytest.mark.parametrize("example", [*EXAMPLES, THREE_LAYERS], ids=lambda example: example.script)
def test_a_published_example_plays_as_told_on_the_demo_library(example, demo_library):
    check(example, demo_library)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.script)
@pytest.mark.parametrize("name", ["reference_library", "reference_plus", "reference_6channel"])
def test_a_published_example_plays_as_told_on_real_clips(example, name, request):
    check(example, request.getfixturevalue(name))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.script)
def test_the_six_channel_form_of_the_clips_gives_the_same_motion(example, reference_library, reference_6channel):
    plans = [
        (library, mlmg_lang.compile(example.script, library, start=example.start)[0])
        for library in (reference_library, reference_6channel)
    ]
    plain, six = (mlmg_lang.play(plan, library) for library, plan in plans)
    assert plain.report["commands"] == six.report["commands"]
    assert list(plain.report["tracks"]) == list(six.report["tracks"])
    shown = []
    for performance in (plain, six):
        skeleton = clips.skeleton_from_bvh(performance.bvh)
        positions = world_positions(skeleton, clips.poses_from_bvh(performance.bvh))
        shown.append(positions[:, [skeleton.names.index(name) for name in reference_library.skeleton.names]])
    assert np.abs(shown[0] - shown[1]).max() < 0.05


def test_soonest_walk_then_best_fitting_talk(demo_library):
    report = report_of(EXAMPLES[2], demo_library)
    walk, upper = report["commands"][0]["motions"]["Full-Body"], demo_library.by_name["Upper-Body"]
    fits = {talk: upper.oms[upper.index[walk], upper.index[talk]] for talk in TALK.split()}
    assert report["commands"][0]["motions"]["Upper-Body"] == min(fits, key=fits.get)
