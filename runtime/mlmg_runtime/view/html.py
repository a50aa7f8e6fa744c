"""A player of motions as one HTML file that needs nothing else: no network, no library."""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Sequence
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from mlmg_runtime.bvh.document import Joint
from mlmg_runtime.files import atomic_output
from mlmg_runtime.view.captions import Track
from mlmg_runtime.view.palette import ACCENTS, BACKGROUND, BODY, FLOOR, GRID
from mlmg_runtime.view.scene import Scene

_SCRIPTS = ("linear.js", "motion.js", "camera.js", "renderer.js", "timeline.js", "labels.js", "main.js")
_HEELS_AND_JAW = 3
_QUANTUM_STEPS = 32767
MOST_BYTES = 48_000_000
"""The most that the motions of a page may take, before they are written as text: what browsers open in a second."""


def write_html(scenes: Sequence[Scene], path: str | Path) -> None:
    """Write a player of one motion or of several side by side.

    The root's path is kept as float32, all points as 16-bit steps from it: 12 bytes a frame, and 6 for each
    point; exact to less than 0.1 mm for a person.
    """
    page = page_of(scenes)
    with atomic_output(path) as beside:
        beside.write_text(page, encoding="utf-8")


def most_frames(joints: Sequence[Joint]) -> int:
    """Return how many frames of a body a page can hold."""
    n_tips = len(joints) - len({joint.parent for joint in joints if joint.parent >= 0})
    n_points = len(joints) + n_tips + _HEELS_AND_JAW
    return MOST_BYTES // (12 + 6 * n_points)


def page_of(scenes: Sequence[Scene]) -> str:
    """Return the page that `write_html` writes."""
    player = files(__package__).joinpath("player")
    # "<" is spelt out, so that no text of a script can end the element that holds the data.
    data = json.dumps(_data(scenes), ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")
    parts = {
        "@TITLE@": html.escape(", ".join(scene.name for scene in scenes)),
        "@STYLE@": player.joinpath("style.css").read_text(encoding="utf-8"),
        "@SCRIPT@": "\n".join(player.joinpath(name).read_text(encoding="utf-8") for name in _SCRIPTS),
        "@DATA@": data,
    }
    page = player.joinpath("page.html").read_text(encoding="utf-8")
    marks = sorted(parts, key=page.index)
    before, *rest = [page[begin:end] for begin, end in pairwise([0, *map(page.index, marks), len(page)])]
    return before + "".join(parts[mark] + text[len(mark) :] for mark, text in zip(marks, rest, strict=True))


def _data(scenes: Sequence[Scene]) -> dict[str, Any]:
    colours = {"background": BACKGROUND, "bare": FLOOR, "grid": GRID, "body": BODY}
    return {
        "colours": {
            **{name: [part / 255 for part in colour] for name, colour in colours.items()},
            "accents": [[part / 255 for part in colour] for colour in ACCENTS],
        },
        "scenes": [_scene(scene) for scene in scenes],
    }


def _scene(scene: Scene) -> dict[str, Any]:
    path = scene.positions[:, scene.root]
    offsets = scene.positions - path[:, None]
    quantum = max(float(np.abs(offsets).max(initial=0.0)) / _QUANTUM_STEPS, 1e-9)
    balls: dict[Any, int] = {}
    capsules = [
        [*(balls.setdefault(ball, len(balls)) for ball in (capsule.first, capsule.second)), capsule.joint]
        for capsule in scene.capsules
    ]
    return {
        "name": scene.name,
        "frameTime": scene.frame_time_s,
        "firstFrame": scene.frames.start,
        "frameStep": scene.frames.step,
        "nFrames": scene.n_frames,
        "nPoints": scene.positions.shape[1],
        "root": scene.root,
        "height": float(np.median(scene.positions[..., 1].max(axis=1))),
        "heading": scene.heading_rad,
        "quantum": quantum,
        "path": _base64(path.astype("<f4")),
        "offsets": _base64(np.round(offsets / quantum).astype("<i2")),
        "balls": [[ball.a, ball.b, round(ball.share, 5), round(ball.radius, 5)] for ball in balls],
        "capsules": capsules,
        "bones": scene.bones,
        "commands": [
            {"text": command.text, "begin": command.begin, "arrive": command.arrive, "end": command.end}
            for command in scene.story.commands
        ],
        "tracks": [_track(track, scene.joints_of_graphs.get(track.graph, frozenset())) for track in scene.story.tracks],
    }


def _track(track: Track, joints: frozenset[int]) -> dict[str, Any]:
    return {
        "graph": track.graph,
        "joints": sorted(joints),
        "stretches": [
            {"begin": stretch.begin, "end": stretch.end, "text": stretch.text, "kind": stretch.kind}
            for stretch in track.stretches
        ],
        "runs": _runs(track),
    }


def _runs(track: Track) -> list[list[int]]:
    """Return the intervals [begin, end) in which a graph runs without a pause."""
    runs: list[list[int]] = []
    for stretch in track.stretches:
        if runs and stretch.begin <= runs[-1][1]:
            runs[-1][1] = max(runs[-1][1], stretch.end)
        else:
            runs.append([stretch.begin, stretch.end])
    return runs


def _base64(array: np.ndarray[Any, Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
