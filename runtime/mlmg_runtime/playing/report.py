"""A timeline as plain data, for the report of a run."""

from __future__ import annotations

from typing import Any

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline


def tracks_from_timeline(
    library: Library, timeline: Timeline, frame_rate: float
) -> dict[str, list[dict[str, Any]]]:
    """Return graph -> segments as JSON data; intervals [begin, end) are output frames at `frame_rate` a second.

    `speed` is source frames for each output frame; frames of motions are those of the library's clips.
    """
    ratio = frame_rate / library.frame_rate

    def scaled(segment: Segment) -> dict[str, int]:
        return {
            "begin": round(segment.begin * ratio),
            "end": round(min(segment.end, timeline.n_frames) * ratio),
        }

    tracks = {}
    for name, segments in timeline.tracks.items():
        graph = library.by_name[name]
        tracks[name] = [
            _clip(graph, segment, scaled(segment), ratio)
            if isinstance(segment, Clip)
            else _blend(graph, segment, scaled(segment))
            for segment in segments
        ]
    return tracks


def joints_from_timeline(library: Library, timeline: Timeline) -> dict[str, list[str]]:
    """Return the joints' names of each graph below the root that runs in the timeline."""
    parts = [library.by_name[name] for name in timeline.tracks if library.parent(name) is not None]
    return {graph.name: [library.skeleton.names[joint] for joint in graph.joints] for graph in parts}


def _clip(graph: MotionGraph, clip: Clip, interval: dict[str, int], ratio: float) -> dict[str, Any]:
    motion = {"motion": graph.motions[clip.first.motion], "clip_begin": clip.first.frame}
    return {"kind": "clip", **interval, **motion, "speed": round(clip.speed / ratio, 6)}


def _blend(graph: MotionGraph, blend: Blend, interval: dict[str, int]) -> dict[str, Any]:
    ends = {
        "from": _place(graph, blend.source),
        "to": None if blend.target is None else _place(graph, blend.target),
    }
    if blend.transition is None:
        return {"kind": "blend", **interval, **ends}
    costs = {"distance": blend.transition.distance, "cost": blend.transition.cost}
    return {"kind": "transition", **interval, **ends, **costs}


def _place(graph: MotionGraph, place: Position) -> list[str | int]:
    return [graph.motions[place.motion], place.frame]
