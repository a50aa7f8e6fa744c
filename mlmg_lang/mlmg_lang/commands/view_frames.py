"""Which frames of a motion a person asks to see: `90:240`, `3s:8s`, `10,25,40`, `--fps 10`."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_lang.commands.console import UsageError

SLOWEST_FPS = 10.0
"""A player of fewer frames a second is not made unasked: between them it would show what never was."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A frame by its number, or by its time in seconds."""

    number: float
    in_seconds: bool

    def frame(self, frame_time_s: float) -> int:
        """Return the frame that is nearest to this moment."""
        return round(self.number / frame_time_s) if self.in_seconds else int(self.number)


@dataclass(frozen=True, slots=True)
class Part:
    """The frames from one moment up to, without, another; None is where the motion begins or ends."""

    begin: Moment | None = None
    end: Moment | None = None

    def of(self, name: str, n_frames: int, frame_time_s: float) -> range:
        """Return these frames of a motion.

        Raises
        ------
        UsageError
            If there is none.
        """
        begin, end = (None if moment is None else moment.frame(frame_time_s) for moment in (self.begin, self.end))
        part = range(n_frames)[begin:end]
        if not part:
            raise UsageError(f"no frame is chosen: {name} has {_extent(n_frames, frame_time_s)}")
        return part


Frames: TypeAlias = Part | tuple[Moment, ...]


def parse_frames(text: str) -> Frames:
    """Return what `--frames` says.

    Raises
    ------
    argparse.ArgumentTypeError
        If it is not understood.
    """
    try:
        if ":" in text:
            begin, end = (_moment(part) if part else None for part in text.split(":"))
            return Part(begin, end)
        return tuple(map(_moment, text.split(",")))
    except ValueError:
        message = f"expected frames such as 10,25,40 or 90:240, or seconds such as 3s:8s, found {text!r}"
        raise argparse.ArgumentTypeError(message) from None


def _moment(text: str) -> Moment:
    in_seconds = text.endswith("s")
    number = float(text.removesuffix("s")) if in_seconds else int(text)
    if not 0 <= number < math.inf:
        raise argparse.ArgumentTypeError(f"frames and seconds count from 0, found {text!r}")
    return Moment(number, in_seconds)


def frames_at(moments: tuple[Moment, ...], name: str, n_frames: int, frame_time_s: float) -> list[int]:
    """Return the frames at some moments of a motion.

    Raises
    ------
    UsageError
        If the motion does not last so long.
    """
    frames = [moment.frame(frame_time_s) for moment in moments]
    beyond = next((frame for frame in frames if frame >= n_frames), None)
    if beyond is not None:
        raise UsageError(f"frame {beyond}: {name} has {_extent(n_frames, frame_time_s)}")
    return frames


def at_most_fps(part: range, fps: float | None, frame_time_s: float) -> range:
    """Return frames of a part that are at most `fps` a second."""
    step = 1 if fps is None else max(math.ceil(1.0 / (fps * frame_time_s) - 1e-6), 1)
    return part[::step]


def thinned(part: range, most: int, name: str, frame_time_s: float) -> range:
    """Return at most so many frames of a part.

    Raises
    ------
    UsageError
        If the frames that are left would be too far apart; it says what to ask for instead.
    """
    step = -(-len(part) // most)
    fps = 1.0 / (part.step * step * frame_time_s)
    if step > 1 and fps < SLOWEST_FPS:
        seconds = len(part) * part.step * frame_time_s
        raise UsageError(
            f"{name} is too long for one page: {len(part)} frames, {_hours(seconds)}, where {most} can be; "
            f"--frames {part.start}:{part.start + most * part.step} shows a part, "
            f"--fps {_rounded_down(fps):g} all of it in fewer frames"
        )
    return part[::step]


def _rounded_down(number: float) -> float:
    """Return a positive number with two digits, no greater than it is."""
    scale = 10.0 ** (1 - math.floor(math.log10(number)))
    return math.floor(number * scale + 1e-6) / scale


def _extent(n_frames: int, frame_time_s: float) -> str:
    return f"the frames 0 to {n_frames - 1}, {n_frames * frame_time_s:.2f} s"


def _hours(seconds: float) -> str:
    return f"{seconds / 3600.0:.1f} h" if seconds >= 3600.0 else f"{seconds / 60.0:.1f} min"
