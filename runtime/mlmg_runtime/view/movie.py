"""A small movie of a motion, as an animated GIF."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.files import atomic_output
from mlmg_runtime.view.drawing import draw
from mlmg_runtime.view.lettering import Pen
from mlmg_runtime.view.palette import ACCENTS, FAINT_TEXT, TEXT, accent
from mlmg_runtime.view.pillow import need_pillow
from mlmg_runtime.view.scene import Scene
from mlmg_runtime.view.studio import Studio, camera_path, studio_for
from mlmg_runtime.view.tints import tints_at

if TYPE_CHECKING:
    from PIL.Image import Image

Progress: TypeAlias = Callable[[str, int, int], None]

SIZE = (640, 480)
RATE = 15.0
LONGEST_S = 20.0
_MARGIN, _LETTERS, _LINE = 16, 18, 26
_SAMPLED_FRAMES = 9
_COLOURS = 256
_SWATCH = 64


def write_gif(
    scene: Scene,
    path: str | Path,
    frames: range | None = None,
    progress: Progress | None = None,
    fps: float = RATE,
) -> range:
    """Write a movie at real speed that repeats without end.

    Parameters
    ----------
    frames : the frames to show, all by default; what is longer than 20 s is cut off.
    progress : called with what is being done, how many pictures of it are done, and of how many.
    fps : pictures a second, at most as many as there are frames.

    Returns
    -------
    range
        The frames of the motion that are shown.

    Raises
    ------
    PillowMissingError
        If Pillow is not installed.
    """
    need_pillow()
    from PIL.Image import Dither

    shown = shown_of(frames if frames is not None else range(scene.n_frames), scene.frame_time_s)
    picture_time_s = max(1.0 / fps, scene.frame_time_s)
    moments = _moments(shown, picture_time_s / scene.frame_time_s)
    studio = studio_for(scene, SIZE, np.arange(scene.n_frames))
    picture = partial(_picture, scene, studio, camera_path(scene))
    palette = _palette(picture, moments, progress or _untold)
    durations_ms = _durations_ms(len(moments), picture_time_s)
    pool = ThreadPoolExecutor()
    try:
        pictures = pool.map(lambda frame: picture(frame).quantize(palette=palette, dither=Dither.NONE), moments)
        _save(path, _told(pictures, len(moments), progress or _untold), durations_ms)
    finally:
        pool.shutdown(cancel_futures=True)
    return shown


def shown_of(frames: range, frame_time_s: float) -> range:
    """Return those of some frames that a movie shows: the first 20 s."""
    return frames[: max(round(LONGEST_S / frame_time_s), 1)]


def _told(pictures: Iterable[Image], n_pictures: int, progress: Progress) -> Iterator[Image]:
    progress("drawing", 0, n_pictures)
    for done, picture in enumerate(pictures, start=1):
        progress("drawing", done, n_pictures)
        yield picture


def _untold(_stage: str, _done: int, _total: int) -> None:
    """Tell nobody how far the work is."""


def _save(path: str | Path, pictures: Iterator[Image], durations_ms: list[int]) -> None:
    first = next(pictures)
    with atomic_output(path) as beside:
        first.save(beside, format="GIF", save_all=True, append_images=pictures, loop=0, duration=durations_ms)


def _moments(shown: range, step: float) -> list[int]:
    """Return the frames that are pictured: one in `step`."""
    return [shown[int(at)] for at in np.arange(0, len(shown) - 1e-6, step)]


def _durations_ms(n_pictures: int, picture_time_s: float) -> list[int]:
    """Return how long each picture stays: whole hundredths of a second, as GIF wants, that add up right."""
    ends = np.round(100.0 * picture_time_s * np.arange(n_pictures + 1)).astype(int)
    return [int(step) for step in 10 * np.diff(ends)]


def _palette(picture: Callable[[int], Image], moments: list[int], progress: Progress) -> Image:
    """Return a picture with the colours that moments from all over the movie need, the figure's first."""
    from PIL.Image import new

    width, height = SIZE
    sampled = [moments[int(at)] for at in np.linspace(0, len(moments) - 1, _SAMPLED_FRAMES)]
    sheet = new("RGB", (width, height * len(sampled) + _SWATCH))
    for column, colour in enumerate((TEXT, FAINT_TEXT, *ACCENTS)):
        sheet.paste(colour, (column * _SWATCH, height * len(sampled), (column + 1) * _SWATCH, sheet.height))
    for row, frame in enumerate(sampled):
        progress("choosing colours", row, len(sampled))
        whole = picture(frame)
        figure = whole.crop((width // 3, 0, 2 * width // 3, height))
        sheet.paste(whole.resize((width // 3, height)), (0, row * height))
        for column in (1, 2):
            sheet.paste(figure, (column * width // 3, row * height))
    return sheet.quantize(_COLOURS)


def _picture(scene: Scene, studio: Studio, targets: FloatArray, frame: int) -> Image:
    from PIL.ImageDraw import Draw

    picture = draw(scene, frame, studio, targets[frame], tints_at(scene, frame))
    pen = Pen(Draw(picture), _LETTERS)
    time = f"{scene.time_s(frame):.1f} s"
    pen.write(SIZE[0] - _MARGIN - pen.width(time), _MARGIN, time, FAINT_TEXT)
    playing = scene.story.playing_at(frame)
    top = SIZE[1] - _MARGIN - _LINE * len(playing)
    graphs = [track.graph for track in scene.story.tracks]
    for row, (graph, stretch) in enumerate(playing):
        end = pen.write(_MARGIN, top + row * _LINE, graph, accent(graphs.index(graph)))
        pen.write(end + 10, top + row * _LINE, stretch.text, TEXT)
    command = scene.story.command_at(frame)
    if command:
        pen.write(_MARGIN, _MARGIN, pen.cut(command.text, SIZE[0] - 8 * _MARGIN), TEXT)
    return picture
