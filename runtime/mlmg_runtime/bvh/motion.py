"""The MOTION of a BVH file: from its lines to the frame time and the channel values."""

from __future__ import annotations

import io
import re
from array import array

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh.lines import Lines, shown

_N_FRAMES = re.compile(r"frames\b\s*:?\s*(.*)", re.IGNORECASE)
_FRAME_TIME = re.compile(r"frame\s+time\b\s*:?\s*(.*)", re.IGNORECASE)
_SOLID = re.compile(rb"\S")


def motion_from_lines(lines: Lines, n_channels: int) -> tuple[float, FloatArray]:
    """Return the frame time in seconds and the frames, shape (n_frames, n_channels), from MOTION to the end.

    Frames beyond those announced are left out, with a warning. Nothing is allocated for frames that are not
    there.

    Raises
    ------
    BvhError
        If a line is not what it should be, or there are fewer frames than announced.
    """
    heading = lines.next_part()
    if heading is None or heading.upper() != "MOTION":
        raise lines.error("MOTION after the one skeleton of the file", shown(heading))
    if n_channels == 0:
        raise lines.error("a skeleton with at least one channel", "none")
    n_frames = _announced(lines)
    line = lines.line
    frame_time_s = _frame_time(lines)
    frames = _frames(lines, n_channels)
    if len(frames) < n_frames:
        raise lines.error(f"{n_frames} frames, as announced", str(len(frames)), line)
    if len(frames) > n_frames:
        lines.warnings.append(f"line {line} announces {n_frames} frames, {len(frames)} are there: the rest is left out")
    return frame_time_s, frames[:n_frames]


def _announced(lines: Lines) -> int:
    text = lines.next_line()
    found = _N_FRAMES.fullmatch(text or "")
    if not found:
        raise lines.error("Frames: and a number", shown(text))
    if not re.fullmatch(r"[0-9]{1,18}", found[1]) or int(found[1]) == 0:
        raise lines.error("a number of frames, 1 or more", shown(found[1]))
    return int(found[1])


def _frame_time(lines: Lines) -> float:
    text = lines.next_line()
    found = _FRAME_TIME.fullmatch(text or "")
    if not found:
        raise lines.error("Frame Time: and a number", shown(text))
    what = "a frame time above 0, in seconds"
    seconds = lines.number(found[1], what)
    if seconds <= 0.0:
        raise lines.error(what, shown(found[1]))
    return seconds


def _frames(lines: Lines, n_channels: int) -> FloatArray:
    """Return all frames that follow: fast, or, where anything is odd, line by line to find it."""
    if not _SOLID.search(lines.data, lines.position):
        return np.empty((0, n_channels))
    text = io.BytesIO(lines.data)
    text.seek(lines.position)
    try:
        # Refuses lines of unequal length, what is no number, and what is not ASCII; takes "nan" and "inf".
        frames = np.loadtxt(text, ndmin=2, comments=None, encoding="ascii")
    except ValueError:
        return _frames_one_by_one(lines, n_channels)
    if frames.shape[1] != n_channels or not np.isfinite(frames).all():
        return _frames_one_by_one(lines, n_channels)
    return frames


def _frames_one_by_one(lines: Lines, n_channels: int) -> FloatArray:
    """Return all frames that follow; this defines what a frame is, and names the line that is none."""
    values = array("d")
    while (text := lines.next_line()) is not None:
        words = text.split()
        values.extend(lines.number(word, "a finite number") for word in words)
        if len(words) != n_channels:
            raise lines.error(f"{n_channels} values, one for each channel", str(len(words)))
    return np.array(values).reshape(-1, n_channels)
