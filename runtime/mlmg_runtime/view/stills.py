"""A strip of moments of a motion, side by side, each with what is playing under it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mlmg_runtime.files import atomic_output
from mlmg_runtime.view.captions import Command, Story
from mlmg_runtime.view.drawing import draw
from mlmg_runtime.view.lettering import Pen
from mlmg_runtime.view.palette import BACKGROUND, FAINT_TEXT, TEXT, accent
from mlmg_runtime.view.pillow import need_pillow
from mlmg_runtime.view.scene import Scene
from mlmg_runtime.view.studio import camera_path, studio_for
from mlmg_runtime.view.tints import tints_at

if TYPE_CHECKING:
    from PIL.Image import Image

N_MOMENTS = 6
_A_ROW = 8
_PICTURE = (250, 360)
_GAP, _MARGIN, _LETTERS, _LINE = 4, 12, 16, 22
_COMMAND_LINES = 2


def write_png(
    scene: Scene,
    path: str | Path,
    frames: Sequence[int] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> None:
    """Write a strip of moments as a PNG.

    Parameters
    ----------
    frames : the moments, each from 0 to n_frames - 1; by default those of `moments`.
    progress : called with "drawing", how many pictures are done, and how many there are.

    Raises
    ------
    PillowMissingError
        If Pillow is not installed.
    """
    need_pillow()
    chosen = frames if frames is not None else moments(scene.story, range(scene.n_frames))
    strip = strip_of_moments(scene, chosen, progress)
    with atomic_output(path) as beside:
        strip.save(beside, format="PNG", optimize=True)


def evenly_spread(n_frames: int, n_moments: int = N_MOMENTS) -> list[int]:
    """Return up to `n_moments` different frames from the first to the last."""
    return sorted({int(frame) for frame in np.round(np.linspace(0, n_frames - 1, n_moments))})


def moments(story: Story, frames: range) -> list[int]:
    """Return the frames that show best what happens in a part of a motion.

    Each command is shown half-way between its arrival and its end, or when it ends if that is when it arrives. Of more
    than eight of them eight are taken, evenly spread; if they are fewer than six, what is farthest from them is shown
    too.
    """
    told = sorted({frame for command in story.commands for frame in _best_frame(command) if frame in frames})
    if not told:
        return [frames[at] for at in evenly_spread(len(frames))]
    chosen = [told[at] for at in evenly_spread(len(told), _A_ROW)]
    others = [frames[at] for at in evenly_spread(len(frames), 8 * N_MOMENTS)]
    while len(chosen) < N_MOMENTS:
        farthest = max(others, key=lambda frame: min(abs(frame - other) for other in chosen))
        if farthest in chosen:
            break
        chosen.append(farthest)
    return sorted(chosen)


def _best_frame(command: Command) -> Iterator[int]:
    """Yield the frame that shows a command best, if one does."""
    if command.end > command.arrive:
        yield (command.arrive + command.end) // 2
    elif command.end > command.begin:
        yield command.end - 1


def strip_of_moments(
    scene: Scene, frames: Sequence[int], progress: Callable[[str, int, int], None] | None = None
) -> Image:
    """Return the picture that `write_png` writes: rows of up to eight moments."""
    from PIL.Image import new

    columns = min(len(frames), _A_ROW)
    height = _PICTURE[1] + _caption_height(scene, frames)
    rows = -(-len(frames) // _A_ROW)
    strip = new("RGB", (columns * (_PICTURE[0] + _GAP) - _GAP, rows * height), BACKGROUND)
    studio = studio_for(scene, _PICTURE, np.array(frames), oversampling=3)
    targets = camera_path(scene)
    for index, frame in enumerate(frames):
        if progress:
            progress("drawing", index, len(frames))
        left, top = (index % _A_ROW) * (_PICTURE[0] + _GAP), (index // _A_ROW) * height
        strip.paste(draw(scene, frame, studio, targets[frame], tints_at(scene, frame)), (left, top))
        _write_caption(strip, scene, frame, left, top + _PICTURE[1])
    return strip


def _caption_height(scene: Scene, frames: Sequence[int]) -> int:
    most_graphs = max(len(scene.story.playing_at(frame)) for frame in frames)
    n_lines = 1 + (_COMMAND_LINES if scene.story.commands else 0) + most_graphs
    return n_lines * _LINE + 2 * _MARGIN


def _write_caption(strip: Image, scene: Scene, frame: int, left: int, top: int) -> None:
    from PIL.ImageDraw import Draw

    pen = Pen(Draw(strip), _LETTERS)
    width = _PICTURE[0] - 2 * _MARGIN
    left, top = left + _MARGIN, top + _MARGIN
    pen.write(left, top, f"{scene.time_s(frame):.2f} s", FAINT_TEXT)
    top += _LINE
    command = scene.story.command_at(frame)
    for line in pen.lines(command.text, width, _COMMAND_LINES) if command else ():
        pen.write(left, top, line, TEXT)
        top += _LINE
    graphs = [track.graph for track in scene.story.tracks]
    for graph, stretch in scene.story.playing_at(frame):
        end = pen.write(left, top, pen.cut(graph, width), accent(graphs.index(graph)))
        pen.write(end + _LETTERS // 2, top, pen.cut(stretch.text, left + width - end - _LETTERS // 2), TEXT)
        top += _LINE
