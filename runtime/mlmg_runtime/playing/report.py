"""A timeline as plain data, for the report of a run."""

from __future__ import annotations

import math
from typing import Any

from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline


def tracks_from_timeline(
    library: Library, timeline: Timeline, ratio: float, n_frames: int
) -> dict[str, list[dict[str, Any]]]:
    """Return graph -> segments as JSON data; their intervals [begin, end) are output frames.

    Frames of motions are those of the library's clips: output frame t of a clip shows `clip_begin` + `speed` times
    (t - `begin`). Segments that fall between two output frames are left out.

    Parameters
    ----------
    ratio : output frames for each frame of the timeline. n_frames : in the output.
    """
    tracks = {}
    for name, segments in timeline.tracks.items():
        graph = library.by_name[name]
        entries = [_entry(graph, segment, ratio, n_frames) for segment in segments]
        tracks[name] = [entry for entry in entries if entry["begin"] < entry["end"]]
    return tracks


def output_frame(frame: int, ratio: float, n_frames: int) -> int:
    """Return the first output frame at or after a frame of the timeline, at most `n_frames`."""
    return min(math.ceil(frame * ratio - 1e-6), n_frames)


def joints_from_timeline(library: Library, timeline: Timeline) -> dict[str, list[str]]:
    """Return the joints' names of each graph below the root that runs in the timeline."""
    parts = [library.by_name[name] for name in timeline.tracks if library.parent(name) is not None]
    return {graph.name: [library.skeleton.names[joint] for joint in graph.joints] for graph in parts}


def _entry(graph: MotionGraph, segment: Segment, ratio: float, n_frames: int) -> dict[str, Any]:
    begin, end = (output_frame(frame, ratio, n_frames) for frame in (segment.begin, segment.end))
    interval = {"begin": begin, "end": end}
    if isinstance(segment, Clip):
        return {"kind": "clip", **interval, **_clip(graph, segment, begin / ratio, ratio)}
    return _blend(graph, segment, interval)


def _clip(graph: MotionGraph, clip: Clip, shown_from: float, ratio: float) -> dict[str, Any]:
    first = round(clip.first.frame + clip.speed * (shown_from - clip.begin), 6)
    return {
        "motion": graph.motions[clip.first.motion],
        "clip_begin": int(first) if first.is_integer() else first,
        "speed": round(clip.speed / ratio, 6),
    }


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
