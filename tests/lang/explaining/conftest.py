"""A library whose graphs are made by a formula, so that what is told of it stays; and explanations of any kind."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np
import pytest
from hypothesis import strategies as st

from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.explaining.travel import MotionTravel
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.planning.ahead import Ahead, plan_ahead
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import TRANSITION, MotionGraph

WINDOW = 10
FRAMES = {"Idle_01": 120, "Idle_02": 110, "Walk_01": 160, "Walk_02": 150, "Walk_03": 130, "Music_01": 200}
FRAMES |= {"Talk_01": 140, "Talk_02": 125, "Wave_01": 90}
FULL_BODY = {
    "Idle_01": ("IDLE",),
    "Idle_02": ("IDLE",),
    "Walk_01": ("WALK",),
    "Walk_02": ("WALK",),
    "Walk_03": ("WALK", "WAVE_HAND"),
    "Music_01": ("Music", "IDLE"),
    "Talk_01": ("TALK", "IDLE"),
    "Talk_02": ("TALK",),
}
UPPER_BODY = {
    "Idle_01": ("IDLE",),
    "Walk_01": ("SWING_HAND",),
    "Walk_02": ("SWING_HAND",),
    "Walk_03": ("WAVE_HAND",),
    "Music_01": ("Music", "IDLE"),
    "Talk_01": ("TALK", "IDLE"),
    "Talk_02": ("TALK",),
}
LEFT_HAND = {**UPPER_BODY, "Idle_02": ("IDLE",), "Wave_01": ("WAVE",)}


def made_graph(name: str, parent: str | None, tags: dict[str, tuple[str, ...]], number: int) -> MotionGraph:
    """Return a graph with a way back in every motion, and two ways from each motion into the next two."""
    motions = tuple(tags)
    n_frames = np.array([FRAMES[motion] for motion in motions])
    n = len(motions)
    rows = []
    for a in range(n):
        home = 30 if parent is None else min(60, n_frames[a] - 45)  # before other ways out, so that there is a way on
        rows.append((a, n_frames[a] - WINDOW - 15, a, home, 0.1))
        if a % 3 == 0:
            rows.append((a, n_frames[a] - WINDOW - 40, (a + 1) % n, WINDOW - 1, 0.3))
        for step in (1, 2, n - 1):
            b = (a + step) % n
            for turn in (1, 2):
                leave = 20 + (37 * a + 53 * step * turn + 11 * number) % (n_frames[a] - WINDOW - 36)
                enter = WINDOW + (29 * b + 31 * turn + 7 * number) % (n_frames[b] - WINDOW - 30)
                rows.append((a, leave, b, enter, (71 * a + 37 * b + 53 * turn + 17 * number) % 97 / 100))
    marks = sorted({row[:4]: row for row in rows}.values())
    edges = [(*row[:4], -np.log1p(-row[4]), row[4]) for row in marks]
    at = np.arange(n)
    steps = (at[None, :] - at[:, None]) % n
    return MotionGraph(
        name=name,
        parent=parent,
        joints=(0,),
        weights=np.ones(1),
        window=WINDOW,
        sigma=1.0,
        blend="c1",
        motions=motions,
        tags=tags,
        n_frames=n_frames,
        transitions=np.array(edges, dtype=TRANSITION),
        forbidden=np.zeros((n, n), dtype=bool),
        oms=100.0 * np.abs(at[:, None] - at[None, :]) + (at[:, None] * at[None, :]) % 7,
        hops=np.where(steps == 0, 0, np.minimum((steps + 1) // 2, n - steps)),
    )


@pytest.fixture(scope="session")
def made_library() -> Library:
    """Return a library of three graphs without clips, that can be explained but not shown."""
    graphs = (
        made_graph("Full-Body", None, FULL_BODY, 0),
        made_graph("Upper-Body", "Full-Body", UPPER_BODY, 1),
        made_graph("Left-Hand", "Upper-Body", LEFT_HAND, 2),
    )
    by_name = {graph.name: graph for graph in graphs}
    skeleton: Any = None
    return Library(Path("made.mlmg"), skeleton, 30.0, "y", "Idle_01", by_name, {}, ())


@pytest.fixture(scope="session")
def explained(made_library: Library) -> Callable[..., Explanation]:
    """Return a function: script, and what the explanation takes besides -> its explanation on the made library."""

    def explain(
        text: str,
        library: Library = made_library,
        start: str | None = None,
        look_ahead: bool = False,
        seed: int | None = None,
    ) -> Explanation:
        analysis = analysed(text, library, start)
        ahead = looked_ahead(analysis, library) if look_ahead else None
        return explanation_from_analysis(analysis, library, start, ahead, seed)

    return explain


def analysed(text: str, library: Library, start: str | None = None) -> Analysis:
    analysis = analyse(Source(text, "script.ms"), library, start)
    assert analysis.resolved is not None, [one.message for one in analysis.diagnostics]
    return analysis


def looked_ahead(analysis: Analysis, library: Library) -> Ahead:
    assert analysis.resolved is not None
    return plan_ahead(analysis.resolved, Names(library), MotionTravel(library))


# --- explanations of any kind ---


@pytest.fixture(scope="session")
def explanations() -> st.SearchStrategy[Explanation]:
    """Return a strategy of explanations, whether they make sense or not."""
    return st.composite(lambda draw: _value(draw, Explanation, 0))()


def _value(draw: Callable[[st.SearchStrategy[Any]], Any], hint: Any, depth: int) -> Any:
    if isinstance(hint, type) and is_dataclass(hint):
        hints = get_type_hints(hint)
        return hint(**{one.name: _value(draw, hints[one.name], depth + 1) for one in fields(hint) if one.init})
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return _value(draw, draw(st.sampled_from(inner)), depth)
    if origin is tuple and inner[-1] is Ellipsis:
        return tuple(_value(draw, inner[0], depth) for _ in range(draw(st.integers(0, 2 if depth < 7 else 0))))
    if origin is tuple:
        return tuple(_value(draw, one, depth) for one in inner)
    assert origin is not Literal, "kinds are not given"
    return draw(_SIMPLE[hint])


_SIMPLE: dict[Any, st.SearchStrategy[Any]] = {
    str: st.text(max_size=8) | st.sampled_from(["walk", "Upper-Body", "走路 😀", 'a "b"', "end"]),
    int: st.integers(0, 10**6),
    float: st.floats(0, 1e6).map(lambda number: round(number, 3)) | st.sampled_from([0.0, 1.0]),
    bool: st.booleans(),
    types.NoneType: st.none(),
}


@pytest.fixture(scope="session")
def flat() -> Callable[[Explanation], Iterator[Any]]:
    """Return a function that yields the statements of an explanation, those in others too."""

    def yield_all(explanation: Explanation) -> Iterator[Any]:
        pending = list(explanation.statements)
        while pending:
            one = pending.pop(0)
            yield one
            bodies = [one.body] if hasattr(one, "body") else [branch.body for branch in getattr(one, "branches", ())]
            pending = [inner for body in bodies for inner in body] + pending

    return yield_all
