"""How much of the time a motion is shown that a statement has led to."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mlmg_lang.explaining.explanation import Execution, Taken
from mlmg_lang.explaining.happened import Teller
from mlmg_lang.explaining.text import render_text
from mlmg_lang.planning.resolved import Seconds, Wait
from mlmg_lang.source import Span
from mlmg_lang.staging import Executed
from mlmg_runtime.motion_graph import Position
from mlmg_runtime.playing.timeline import Blend, Clip


@pytest.fixture
def tracks(demo_library):
    """Return the whole body that walks, loops and goes round by Idle_01, while a part runs for a while."""
    full, upper = demo_library.root.index, demo_library.by_name["Upper-Body"].index
    walk, idle = full["Walk_01"], full["Idle_01"]
    return {
        "Full-Body": (
            Clip(0, 100, Position(walk, 0), 100),
            Blend(100, 120, Position(walk, 100), Position(walk, 30)),
            Clip(120, 150, Position(walk, 31), 30),
            Blend(150, 170, Position(walk, 61), Position(idle, 30)),
            Clip(170, 180, Position(idle, 31), 10),
            Blend(180, 200, Position(idle, 41), Position(walk, 10)),
            Clip(200, 300, Position(walk, 11), 100),
        ),
        "Upper-Body": (Clip(100, 140, Position(upper["Talk_01"], 30), 40),),
    }


@pytest.mark.parametrize(
    ("graph", "motion", "arrive", "end", "shown"),
    [
        ("Full-Body", "Walk_01", 0, 100, 1.0),
        ("Full-Body", "Walk_01", 50, 140, 1.0),
        ("Full-Body", "Walk_01", 100, 200, 0.5),
        ("Full-Body", "Walk_01", 160, 250, 0.556),
        ("Full-Body", "Walk_01", 130, 130, None),
        ("Upper-Body", "Talk_01", 110, 140, 1.0),
        ("Upper-Body", "Walk_01", 140, 200, 0.167),
    ],
)
def test_a_motion_is_shown_in_its_clips_and_loops_and_not_on_a_way_round(
    demo_library, tracks, graph, motion, arrive, end, shown
) -> None:
    step = Executed(Wait(Seconds(1.0), Span(0, 1)), arrive, arrive, end, {graph: motion})
    execution = Teller(demo_library, tracks, {}).execution(step)
    assert execution.taken == (Taken(graph, motion, shown),)


@pytest.mark.parametrize(("shown", "told"), [(0.654, " (shown 65% of the time)"), (0.996, ""), (1.0, ""), (None, "")])
def test_what_is_not_shown_all_the_time_is_told(explained, demo_library, shown, told) -> None:
    explanation = explained("Idle_01 for 2 sec", demo_library, seed=0)
    (statement,) = explanation.statements
    went = Execution(0.0, 0.0, 2.0, 0.0, (Taken("Full-Body", "Idle_01", shown),), ())
    text = render_text(replace(explanation, statements=(replace(statement, executions=(went,)),)))
    assert f"Full-Body Idle_01{told}\n" in text
