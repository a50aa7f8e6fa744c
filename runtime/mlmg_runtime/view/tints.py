"""Which parts of a figure are coloured, and how: those that a graph below the root moves on its own."""

from __future__ import annotations

from mlmg_runtime.view.palette import accent
from mlmg_runtime.view.scene import Scene


def tints_at(scene: Scene, frame: int) -> dict[int, tuple[int, int, int]]:
    """Return the colours of the joints that graphs below the root move in a frame, if the report has it."""
    playing = {graph for graph, _ in scene.story.playing_at(frame)}
    joints = scene.joints_of_graphs
    return {
        joint: accent(index)
        for index, track in enumerate(scene.story.tracks)
        if index > 0 and track.graph in playing
        for joint in joints.get(track.graph, ())
    }
