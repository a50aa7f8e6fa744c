"""A script that checks clean is played to its end, whatever stands in it and on whatever library.

Random scripts of all that the language has: most are wrong for their library and left aside, the others must play.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import mlmg_lang
from mlmg_lang.perform import rehearse
from mlmg_runtime.building.build import build_library
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.database import write_database
from mlmg_runtime.library import Library, open_library

# Two arms beside each other below the upper body, each on motions of its own, and windows of different lengths.
ARMS = """
[[graph]]
name = "Left-Arm"
joints = ["Shoulder_L"]
window = 12

[[graph]]
name = "Right-Arm"
joints = ["Shoulder_R"]
window = 26

[tags.Left-Arm]
Idle_01 = ["IDLE"]
Walk_01 = ["SWING"]
Walk_03 = ["WAVE"]
Talk_01 = ["TALK"]
Talk_02 = ["TALK", "WAVE"]
Music_01 = []

[tags.Right-Arm]
Idle_01 = []
Idle_02 = ["UP"]
Walk_01 = []
Walk_02 = ["SWING"]
Walk_03 = ["WAVE"]
Talk_02 = ["TALK"]
Music_01 = ["Music"]
"""
# A clip so short that nothing leads to it or from it; it can be begun alone.
SHORT = """
[clips.Blip]
file = "FOLDER/Walk_02.bvh"
frames = [50, 80]
"""
DURATIONS = ("", "", "", " for 1 sec", " for 4 sec", " for 10 frames", " for 0.3 cycles", " for 2 cycles", " once")
WAITS = ("wait 1 sec", "wait 0.4 cycles", "wait 33 frames", "wait 7 sec")


@pytest.fixture(scope="session")
def opened(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Callable[[str], Library]:
    """Return a function that opens a library by what it is of; without its clips, it skips."""

    @cache
    def open_by_name(name: str) -> Library:
        if name in ("demo", "reference"):
            library: Library = request.getfixturevalue(f"{name}_library")
            return library
        folder = tmp_path_factory.mktemp(name)
        if name == "stepping stones":
            built = request.getfixturevalue("build_reference")("reference", "reference-plus")
        else:
            configuration = (Path(__file__).parent / "reference.toml").read_text(encoding="utf-8")
            clips = request.getfixturevalue("mocap") / "reference" / "*.bvh"
            short = SHORT.replace("FOLDER", clips.parent.as_posix())
            text = configuration.replace("CLIPS", f'"{clips.as_posix()}"').replace(
                "\n[[graph]]", short + "\n[[graph]]", 1
            )
            text = text.replace("# STONES", 'Blip = ["BLIP"]') + ARMS
            (folder / "library.toml").write_text(text, encoding="utf-8")
            built = build_library(read_configuration(folder / "library.toml"), None, lambda *_: None)
        write_database(built, folder / "built.mlmg")
        return open_library(folder / "built.mlmg")

    return open_by_name


@pytest.mark.parametrize("name", ["demo", "reference", "stepping stones", "arms"])
def test_whatever_checks_clean_is_played_to_its_end(name: str, opened: Callable[[str], Library]) -> None:
    library = opened(name)
    played = 0
    for seed in range(50):
        script = random_body(random.Random(seed), library, 2)
        plan, _ = mlmg_lang.compile(script, library)
        if plan is not None:
            rehearse(plan, library, seed)
            played += 1
    assert played > 12


def random_body(draw: random.Random, library: Library, depth: int) -> str:
    statements = []
    for _ in range(draw.choice((1, 4, 8, 12)) if depth == 2 else draw.randint(0, 3)):
        kind = draw.random()
        if kind < 0.1 and depth:
            statements.append(f"repeat {draw.randint(1, 3)} {{ {random_body(draw, library, depth - 1)} }}")
        elif kind < 0.17 and depth:
            branches = [random_body(draw, library, depth - 1) for _ in range(draw.randint(1, 3))]
            statements.append(f"choose {{ {' | '.join(branches)} }}")
        elif kind < 0.24:
            statements.append(draw.choice(WAITS))
        elif kind < 0.31:
            statements.append(f"end {draw.choice(library.graphs[1:])}")
        else:
            statements.append(random_command(draw, library))
    return "; ".join(statements)


def random_command(draw: random.Random, library: Library) -> str:
    graphs = sorted(draw.sample(range(len(library.graphs)), min(draw.choice((1, 1, 2, 3)), len(library.graphs))))
    layers = []
    for graph in (library.graphs[at] for at in graphs):
        names = [
            *library.motions(graph),
            *(tag for motion in library.motions(graph) for tag in library.tags(graph, motion)),
        ]
        one, other = draw.choices(names, k=2)
        expression = draw.choice((one, one, one, f"({one} or {other})", f"(not {one})", f"({one} and {other})"))
        layers.append(expression if draw.random() < 0.1 else f"{graph} {expression}")
    return " with ".join(layers) + draw.choice(DURATIONS)


@pytest.mark.parametrize(
    "script",
    [
        # The body is in the late loop of the dance, after the last frame from which the upper body can leave that.
        """\
Idle_01 for 1 sec
WALK with Upper-Body TALK
IDLE for 4 sec
Music
IDLE with Upper-Body TALK for 2 sec
IDLE
IDLE with Upper-Body TALK for 2 sec
(TALK or IDLE) for 2 sec
""",
        "Music_01 for 2 cycles\nUpper-Body Talk_02 for 1 sec",
    ],
)
def test_a_part_sets_out_though_the_body_dances_past_where_it_could(script: str, reference_library: Library) -> None:
    plan, diagnostics = mlmg_lang.compile(script, reference_library)
    assert plan is not None, diagnostics
    report = mlmg_lang.play(plan, reference_library).report
    # A way leads there: nothing has to be blended on the spot to set out.
    first, *_ = [entry for entry in report["tracks"]["Upper-Body"] if entry["kind"] != "clip"]
    assert first["kind"] == "transition"


@pytest.mark.parametrize("script", ["Blip; wait 7 sec", "Blip once; wait 1 sec; Idle_01 once", "TALK; BLIP once"])
def test_a_clip_that_is_too_short_to_be_held_stands_still(script: str, opened: Callable[[str], Library]) -> None:
    library = opened("arms")
    plan, diagnostics = mlmg_lang.compile(script, library)
    assert plan is not None, diagnostics
    report = mlmg_lang.play(plan, library).report
    assert report["n_frames"] == report["tracks"]["Full-Body"][-1]["end"]
