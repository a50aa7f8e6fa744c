"""What a script becomes when it is played: how long each statement lasts, and how the last one ends."""

from __future__ import annotations

import random
from typing import Any

import pytest

import mlmg_lang
from mlmg_lang.perform import perform, rehearse
from mlmg_lang.staging import Executed
from mlmg_runtime.library import Library

ENDS = ("from", "to")


def report_of(script: str, library: Library) -> dict[str, Any]:
    plan, diagnostics = mlmg_lang.compile(script, library)
    assert plan is not None, diagnostics
    return mlmg_lang.play(plan, library).report


def last_shown(report: dict[str, Any], graph: str = "Full-Body") -> tuple[str, int]:
    """Return the motion and the frame of its clip that a graph shows in the last frame of all."""
    entry = report["tracks"][graph][-1]
    assert (entry["kind"], entry["end"]) == ("clip", report["n_frames"])
    return entry["motion"], entry["clip_begin"] + entry["end"] - 1 - entry["begin"]


def test_a_script_with_errors_has_no_plan_and_is_said_to_have_none(demo_library: Library) -> None:
    plan, diagnostics = mlmg_lang.compile("WLAK", demo_library)
    assert diagnostics
    with pytest.raises(ValueError, match="the diagnostics that `compile` returned"):
        mlmg_lang.play(plan, demo_library)


@pytest.mark.parametrize(
    ("before", "motion"), [("", "Walk_01"), ("Idle_01 for 1 sec", "Walk_01"), ("wait 10 sec", "Music_01")]
)
def test_the_last_command_plays_to_the_last_frame_of_its_clip(before: str, motion: str, demo_library: Library) -> None:
    report = report_of(f"{before}\n{motion}", demo_library)
    assert last_shown(report) == (motion, demo_library.n_frames(motion) - 1)


def test_it_is_the_topmost_named_motion_that_plays_to_its_end(demo_library: Library) -> None:
    both = report_of("Walk_01 with Upper-Body Talk_01", demo_library)
    assert last_shown(both) == ("Walk_01", demo_library.n_frames("Walk_01") - 1)
    part = report_of("Walk_01 for 1 sec\nUpper-Body Talk_01", demo_library)
    assert last_shown(part, "Upper-Body") == ("Talk_01", demo_library.n_frames("Talk_01") - 1)


def test_a_last_command_with_for_ends_when_its_time_is_over(demo_library: Library) -> None:
    report = report_of("Idle_01\nWalk_01 for 45 frames", demo_library)
    command = report["commands"][-1]
    assert report["n_frames"] == command["end"] == command["arrive"] + 45


def test_a_script_that_ends_in_a_wait_ends_with_it(demo_library: Library) -> None:
    report = report_of("Walk_01\nwait 45 frames", demo_library)
    assert (report["n_frames"], report["commands"][0]["end"]) == (45, 0)


def test_a_script_that_ends_in_an_end_ends_when_the_part_is_back(demo_library: Library) -> None:
    report = report_of("Walk_01 with Upper-Body Talk_01 for 1 sec\nend Upper-Body", demo_library)
    way_back = [entry for entry in report["tracks"]["Upper-Body"] if entry["end"] > report["commands"][0]["end"]]
    assert report["n_frames"] == way_back[-1]["end"]
    motion, frame = last_shown(report)
    assert frame < demo_library.n_frames(motion) - 1


def test_a_command_without_for_that_is_not_the_last_is_left_on_arrival(demo_library: Library) -> None:
    report = report_of("Idle_01\nWALK\nIdle_01 for 1 sec", demo_library)
    walk = report["commands"][1]
    assert walk["end"] == walk["arrive"] > walk["begin"]


@pytest.mark.parametrize("statement", ["Walk_01 for {}", "Walk_01\nwait {}"])
@pytest.mark.parametrize(
    ("amount", "n_frames"),
    # 30 frames a second; of two whole numbers equally near, the even one, as Python rounds.
    [("0.99 sec", 30), ("1.01 sec", 30), ("50 ms", 2), ("0.15 sec", 4), ("0.0833 sec", 2), ("2.6 frames", 3)],
)
def test_amounts_are_rounded_to_whole_frames(statement: str, amount: str, n_frames: int, demo_library: Library) -> None:
    assert report_of(statement.format(amount), demo_library)["n_frames"] == n_frames


# --- what is executed, without making poses of it ---


def steps_of(script: str, library: Library, seed: int = 0) -> list[tuple[str, Executed]]:
    """Return what is executed, each statement as it is written."""
    plan, diagnostics = mlmg_lang.compile(script, library)
    assert plan is not None, diagnostics
    return [(plan.source.slice(step.statement.span), step) for step in rehearse(plan, library, seed).steps]


def lengths(script: str, library: Library) -> list[int]:
    """Return for how many frames each statement goes on after all has arrived."""
    return [step.end - step.arrive for _, step in steps_of(script, library)]


@pytest.mark.parametrize(
    ("script", "motions"),
    [
        ("Walk_01 for 2 cycles", [("Walk_01", 2)]),
        ("Idle_01\nWALK for 1 cycles", [None, ("WALK", 1)]),
        ("Walk_01 for 0.5 cycles", [("Walk_01", 0.5)]),
        ("Walk_01 for 0.001 cycles", [("Walk_01", 0.001)]),
        ("Walk_01 with Upper-Body Talk_01 for 1 cycles", [("Walk_01", 1)]),
        ("Walk_01 for 1 sec\nUpper-Body Talk_01 for 1 cycles", [None, ("Talk_01", 1)]),
        ("Walk_01\nwait 1 cycles", [None, ("Walk_01", 1)]),
        ("wait 1 cycles", [("Idle_01", 1)]),
        ("wait 1 cycles\nIdle_01 for 2 cycles\nwait 3 cycles", [("Idle_01", 1), ("Idle_01", 2), ("Idle_01", 3)]),
        ("Walk_01\nUpper-Body Talk_01\nwait 2 cycles", [None, None, ("Talk_01", 2)]),
        ("Walk_01\nUpper-Body Talk_01\nend Upper-Body\nwait 2 cycles", [None, None, None, ("Walk_01", 2)]),
        ("Walk_01\nUpper-Body Talk_01\nwait 1 sec\nwait 2 cycles", [None, None, None, ("Talk_01", 2)]),
        ("Walk_01 with Upper-Body Talk_01\nwait 2 cycles", [None, ("Walk_01", 2)]),
        ("Walk_01\nSWING_HAND for 1 cycles", [None, ("Walk_01", 1)]),  # it follows the walk
        ("repeat 2 { Walk_01; Talk_01 }\nwait 1 cycles", [None, None, None, None, ("Talk_01", 1)]),
    ],
)
def test_a_cycle_is_as_long_as_the_clip_of_the_motion_that_was_taken(
    script: str, motions: list[tuple[str, float] | None], demo_library: Library
) -> None:
    steps = steps_of(script, demo_library)
    for (_, step), expected in zip(steps, motions, strict=True):
        if expected is not None:
            motion, cycles = expected
            taken = next(iter(step.motions.values()), motion)
            assert taken in (motion, *(name for name in demo_library.motions("Full-Body") if motion == "WALK"))
            assert step.end - step.arrive == round(cycles * demo_library.n_frames(taken))


def test_cycles_do_not_depend_on_the_rate_of_the_output(demo_library: Library) -> None:
    plan, _ = mlmg_lang.compile("Walk_01 for 2 cycles", demo_library)
    assert plan is not None
    report = perform(plan, demo_library, frame_rate=60.0).report
    assert report["n_frames"] == 2 * (2 * demo_library.n_frames("Walk_01")) - 1


@pytest.mark.parametrize(
    ("script", "last"),
    [
        ("repeat 2 { Idle_01; Walk_01 }", "Walk_01"),
        ("choose { Idle_01; Walk_01 }", "Walk_01"),
        ("choose { 0: Idle_01 | Walk_01 }", "Walk_01"),
        ("Walk_01; choose { | }", "Walk_01"),
        ("Walk_01; repeat 0 { Idle_01 }", "Walk_01"),
        ("Walk_01; repeat 5 { choose { | } }", "Walk_01"),
        ("repeat 2 { choose { Idle_01 }; Walk_01; choose { | } }", "Walk_01"),
        ("let A(x) = x with Upper-Body Talk_01\nA(Walk_01)", "Walk_01"),
    ],
)
def test_the_last_command_that_is_executed_plays_to_its_end(script: str, last: str, demo_library: Library) -> None:
    report = report_of(script, demo_library)
    assert last_shown(report) == (last, demo_library.n_frames(last) - 1)
    assert all(one["end"] == one["arrive"] for one in report["commands"][:-1])


@pytest.mark.parametrize(
    "script",
    [
        "Walk_01; choose { wait 1 sec }",
        "repeat 2 { Idle_01; Walk_01; wait 1 sec }",
        "repeat 2 { Walk_01 with Upper-Body Talk_01; end Upper-Body }",
        "let A(x) = x for 1 sec\nIdle_01; choose { A(Walk_01) }",
    ],
)
def test_a_command_that_is_not_the_last_to_be_executed_does_not(script: str, demo_library: Library) -> None:
    steps = [step for _, step in steps_of(script, demo_library)]
    commands = [step for step in steps if step.motions]
    lasts = [step.end - step.arrive for step in commands]
    assert all(frames in (0, 30) for frames in lasts)


def test_there_is_an_entry_for_each_command_that_was_executed(demo_library: Library) -> None:
    script = "repeat 3 { Walk_01 for 1 sec; wait 1 sec }\nchoose { 0: TALK | Idle_01 for 2 sec }"
    report = report_of(script, demo_library)
    assert [one["text"] for one in report["commands"]] == ["Walk_01 for 1 sec"] * 3 + ["Idle_01 for 2 sec"]
    assert [one["span"] for one in report["commands"]] == [[1, 12, 1, 29]] * 3 + [[2, 20, 2, 37]]


def test_a_definition_is_reported_where_it_is_used(demo_library: Library) -> None:
    (one,) = report_of("let A(x, t) = x for t\nA(Walk_01,\n  t = 1 sec)", demo_library)["commands"]
    assert (one["text"], one["span"], one["motions"]) == (
        "A(Walk_01, t = 1 sec)",
        [2, 1, 3, 13],
        {"Full-Body": "Walk_01"},
    )


# --- what is drawn ---


def test_the_same_seed_performs_the_same_and_another_something_else(demo_library: Library) -> None:
    script = "repeat 6 { choose { 2: Walk_01 for 1 sec | Idle_01 for 1 sec | Talk_01 for 1 sec } }"
    texts = [[text for text, _ in steps_of(script, demo_library, seed)] for seed in (0, 0, 1, 2, 3)]
    assert texts[0] == texts[1]
    assert len({tuple(one) for one in texts}) == 4


def test_the_same_seed_gives_the_same_frames(demo_library: Library) -> None:
    plan, _ = mlmg_lang.compile("choose { Walk_01 | TALK | IDLE }; repeat 2 { choose { WALK | IDLE } }", demo_library)
    assert plan is not None
    one, other = (perform(plan, demo_library, seed=4) for _ in range(2))
    assert one.report == other.report
    assert (one.bvh.frames == other.bvh.frames).all()


def test_what_is_drawn_does_not_depend_on_what_is_played(demo_library: Library) -> None:
    short = "repeat 12 { choose { Idle_01 for 1 frames | Walk_01 for 1 frames | 2: Talk_01 for 1 frames } }"
    branches = "IDLE; wait 1 sec | 1: end Upper-Body | 2: TALK with Upper-Body IDLE"
    other = f"TALK; repeat 12 {{ WALK for 2 sec; choose {{ {branches} }} }}"
    for seed in range(3):
        first = [["Idle", "Walk", "Talk"].index(text[:4]) for text, _ in steps_of(short, demo_library, seed)]
        drawn = {"IDLE": 0, "end Upper-Body": 1, "TALK with Upper-Body IDLE": 2}
        second = [drawn[text] for text, _ in steps_of(other, demo_library, seed)[1:] if text in drawn]
        assert first == second


# --- once ---


@pytest.mark.parametrize("motion", ["Walk_01", "Talk_02", "Idle_02"])
@pytest.mark.parametrize("before", ["Idle_01 for 3 sec", "{} for 3 sec"])
def test_once_shows_a_motion_from_where_it_can_be_entered_to_where_it_is_left(
    before: str, motion: str, demo_library: Library
) -> None:
    """After frame k - 1, the last that is blended, comes frame k; the last frame is that of the last way out."""
    script = before.format(motion) + f"\n{motion} once\nIdle_01 for 1 sec"
    report = report_of(script, demo_library)
    once = report["commands"][1]
    graph = demo_library.root
    shown = [
        one
        for one in report["tracks"]["Full-Body"]
        if one["kind"] == "clip" and once["arrive"] <= one["begin"] < once["end"]
    ]
    assert [(one["motion"], one["begin"], one["clip_begin"]) for one in shown[:1]] == [
        (motion, once["arrive"], graph.window)
    ]
    exits = graph.first_exit[graph.index[motion]]
    (leaves,) = (one for one in report["tracks"]["Full-Body"] if one["begin"] == once["end"])
    assert leaves["kind"] == "transition"
    assert leaves["from"] == [motion, exits[-1]]
    assert once["end"] - once["arrive"] == exits[-1] - graph.window


@pytest.mark.parametrize("motion", ["Walk_01", "Walk_02", "Walk_03", "Idle_02", "Music_01", "Talk_01", "Talk_02"])
@pytest.mark.parametrize("then", ["{} for 6 sec", "wait 6 sec"])
def test_after_once_the_same_motion_goes_on_without_another_between(
    then: str, motion: str, demo_library: Library
) -> None:
    report = report_of(f"{motion} once\n{then.format(motion)}", demo_library)
    (once, *_), track = report["commands"], report["tracks"]["Full-Body"]
    played = {
        name for entry in track for name in (entry.get("motion"), *(entry[end][0] for end in ENDS if end in entry))
    }
    assert played - {None} == {motion}
    (left,) = (entry for entry in track if entry["begin"] == once["end"])
    assert left["from"] == [motion, demo_library.root.first_exit[demo_library.root.index[motion]][-1]]


def test_once_twice_is_shown_twice(demo_library: Library) -> None:
    steps = [step for _, step in steps_of("Idle_01 for 1 sec\nrepeat 2 { Talk_02 once }", demo_library)]
    first, second = steps[1:]
    assert second.arrive > first.end
    assert first.end - first.arrive == second.end - second.arrive > 0


def test_a_last_command_with_once_ends_at_its_last_way_out(demo_library: Library) -> None:
    report = report_of("Idle_01 for 1 sec\nWalk_01 once", demo_library)
    graph = demo_library.root
    assert last_shown(report) == ("Walk_01", graph.first_exit[graph.index["Walk_01"]][-1] - 1)


def test_a_part_that_plays_something_once_runs_by_itself_even_if_the_body_plays_it(demo_library: Library) -> None:
    plan, diagnostics = mlmg_lang.compile("Walk_01\nUpper-Body Walk_01 once\nend Upper-Body", demo_library)
    assert diagnostics == ()
    assert plan is not None
    once, end = rehearse(plan, demo_library).steps[1:]
    assert once.motions == {"Upper-Body": "Walk_01"}
    assert end.end > end.begin


# --- any script ---


def test_whatever_resolves_is_performed(demo_library: Library) -> None:
    """Fifty scripts of all that there is, each with a few seeds: none gets stuck."""
    draws = random.Random(0)
    played = 0
    for _ in range(50):
        script = random_body(draws, demo_library, 2)
        plan, _ = mlmg_lang.compile(script, demo_library)
        if plan is not None:
            for seed in range(3):
                rehearse(plan, demo_library, seed)
            played += 1
    assert played > 30


def random_body(draws: random.Random, library: Library, depth: int) -> str:
    statements = []
    for _ in range(draws.randint(1, 4)):
        kind = draws.random()
        if kind < 0.15 and depth:
            statements.append(f"repeat {draws.randint(0, 3)} {{ {random_body(draws, library, depth - 1)} }}")
        elif kind < 0.3 and depth:
            bodies = [random_body(draws, library, depth - 1) for _ in range(draws.randint(1, 3))]
            statements.append(f"choose {{ {' | '.join(bodies)} | }}")
        elif kind < 0.4:
            statements.append(draws.choice(["end Upper-Body", "end Left-Hand", "wait 0.3 cycles", "wait 100 ms"]))
        else:
            graphs = sorted(draws.sample(range(3), draws.randint(1, 3)))
            layers = []
            for graph in (library.graphs[at] for at in graphs):
                motions = draws.sample(library.motions(graph), draws.randint(1, 3))
                layers.append(f"{graph} ({' or '.join(motions)})")
            statements.append(" with ".join(layers) + draws.choice(["", " for 10 frames", " for 0.2 cycles", " once"]))
    return "; ".join(statements)
