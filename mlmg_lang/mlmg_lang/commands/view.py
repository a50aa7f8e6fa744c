"""Shows a motion: a player that is one HTML file, a strip of moments (PNG), a small movie (GIF).

examples:
  mlmg view stroll.bvh                                  in the browser
  mlmg view stroll.bvh -o stroll.html                   a page to keep or to send
  mlmg view before.bvh after.bvh                        side by side
  mlmg view stroll.bvh --report stroll.json -o stroll.png
  mlmg view stroll.bvh -o step.png --frames 10,25,40    these moments
  mlmg view stroll.bvh -o step.gif --frames 90:240      the frames from 90 up to, without, 240
  mlmgc - -o - < stroll.ms | mlmg view -                standard input

The report of mlmgc --report says what plays when; stroll.json beside stroll.bvh is used unasked.
PNG and GIF need Pillow: pip install "mlmg[view]".
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from mlmg_lang.commands.console import DONE, WRONG_USAGE, ProgressLine, tell

if TYPE_CHECKING:
    from mlmg_runtime.bvh import Bvh
    from mlmg_runtime.view.captions import Story
    from mlmg_runtime.view.scene import Scene

Frames: TypeAlias = tuple[int, ...] | slice

_ENDINGS = (".html", ".png", ".gif")
_STANDARD_INPUT = "-"


class _UsageError(Exception):
    """Arguments that do not fit together, or not the files."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("motions", metavar="IN.bvh", nargs="+", help="the motion, or several; - reads standard input")
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        help=f"what to write, by its ending: {', '.join(_ENDINGS)}",
    )
    parser.add_argument(
        "--report", metavar="R.json", action="append", default=[], help="what plays when; one for each motion"
    )
    parser.add_argument("--up", choices=("y", "z"), help="the vertical axis of the files; what the report says, else y")
    parser.add_argument(
        "--frames",
        metavar="F",
        type=_frames,
        help="the moments of a PNG (10,25,40), the part of a GIF (90:240)",
    )
    parser.add_argument("--no-open", action="store_true", help="write the player, print where it is, open no browser")


def run(arguments: argparse.Namespace) -> int:
    """Show motions, or write pictures of them."""
    try:
        _check(arguments)
        scenes = _scenes(arguments.motions, arguments.report, arguments.up)
        _show(scenes, arguments)
    except _UsageError as error:
        tell(f"mlmg view: error: {error}")
        return WRONG_USAGE
    return DONE


def _frames(text: str) -> Frames:
    try:
        if ":" in text:
            begin, end = (int(part) if part else None for part in text.split(":"))
            chosen: Frames = slice(begin, end)
        else:
            chosen = tuple(int(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected frames such as 10,25,40 or 90:240, found {text!r}") from None
    numbers = (chosen.start, chosen.stop) if isinstance(chosen, slice) else chosen
    if any(number is not None and number < 0 for number in numbers):
        raise argparse.ArgumentTypeError(f"frames count from 0, found {text!r}")
    return chosen


def _check(arguments: argparse.Namespace) -> None:
    """Raise `_UsageError` for what can be known to be wrong before a file is opened."""
    ending = _ending(arguments.output)
    if ending not in _ENDINGS:
        raise _UsageError(
            f"{arguments.output}: expected a name that ends in {_listed(_ENDINGS)}, found {ending or 'none'}"
        )
    n_motions, n_reports = len(arguments.motions), len(arguments.report)
    if ending != ".html" and n_motions > 1:
        raise _UsageError(f"{arguments.output}: a {ending} shows one motion, found {n_motions}; .html shows several")
    if n_reports not in (0, n_motions):
        raise _UsageError(f"expected a --report for each of {n_motions} motions, found {n_reports}")
    if ending == ".html" and arguments.frames is not None:
        raise _UsageError("--frames is for .png and .gif; the player has all frames, and opens at one with #frame=90")
    if ending == ".gif" and isinstance(arguments.frames, tuple):
        raise _UsageError("a .gif shows the frames between two: --frames 90:240")
    if arguments.motions.count(_STANDARD_INPUT) > 1:
        raise _UsageError("standard input holds one motion; - stands there twice")


def _ending(output: Path | None) -> str:
    return ".html" if output is None else output.suffix.lower()


def _listed(words: Sequence[str]) -> str:
    return f"{', '.join(words[:-1])} or {words[-1]}"


def _scenes(motions: Sequence[str], reports: Sequence[str], up: str | None) -> list[Scene]:
    from mlmg_runtime.view.scene import scene_from_bvh

    stems = Counter(Path(motion).stem for motion in motions)
    scenes = []
    for index, motion in enumerate(motions):
        bvh = _read(motion)
        story = _story(motion, reports[index] if reports else None, bvh.frames.shape[0])
        stem = Path(motion).stem
        name = "standard input" if motion == _STANDARD_INPUT else stem if stems[stem] == 1 else motion
        told = story.up if story is not None else None
        scenes.append(scene_from_bvh(bvh, name, up=up or told or "y", story=story))
    return scenes


def _read(motion: str) -> Bvh:
    from mlmg_runtime.bvh import read, read_bytes
    from mlmg_runtime.errors import BvhError

    name = "standard input" if motion == _STANDARD_INPUT else motion
    bvh = read_bytes(sys.stdin.buffer.read(), name) if motion == _STANDARD_INPUT else read(motion)
    for warning in bvh.warnings:
        tell(f"mlmg view: warning: {name}: {warning}")
    if not len(bvh.frames):
        raise BvhError(name, None, "expected a motion of at least one frame, found none")
    return bvh


def _story(motion: str, report: str | None, n_frames: int) -> Story | None:
    """Return what a report tells: the one named, else the one beside the motion, if it is about it."""
    from mlmg_runtime.view.captions import ReportError, read_story

    if report is not None:
        return read_story(report, n_frames)
    beside = Path(motion).with_suffix(".json")
    if motion == _STANDARD_INPUT or not beside.is_file() or not _looks_like_report(beside):
        return None
    try:
        story = read_story(beside, n_frames)
    except ReportError as error:
        tell(f"mlmg view: {error}; it is not used")
        return None
    tell(f"mlmg view: {beside}: what plays when is taken from this report")
    return story


def _looks_like_report(path: Path) -> bool:
    import json

    from mlmg_runtime.view.captions import is_report

    try:
        return is_report(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return False


def _show(scenes: list[Scene], arguments: argparse.Namespace) -> None:
    ending, output = _ending(arguments.output), arguments.output
    if output is None:
        _open_player(scenes, browse=not arguments.no_open)
    elif ending == ".html":
        from mlmg_runtime.view.html import write_html

        write_html(scenes, output)
    elif ending == ".png":
        from mlmg_runtime.view.stills import write_png

        write_png(scenes[0], output, _moments(scenes[0], arguments.frames))
    else:
        _write_gif(scenes[0], output, arguments.frames)


def _open_player(scenes: list[Scene], browse: bool) -> None:
    """Write the player to a new place of its own, print its name, and open it in the browser."""
    from mlmg_runtime.view.html import write_html

    name = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in scenes[0].name)
    page = Path(tempfile.mkdtemp(prefix="mlmg-view-")) / f"{name}.html"
    write_html(scenes, page)
    print(page)
    if browse and not (_has_screen() and _browse(page)):
        tell("mlmg view: no browser to open it in was found; open the file above in one")


def _has_screen() -> bool:
    """Return whether windows can open; on a bare terminal a text browser would start, which shows nothing."""
    return sys.platform in ("darwin", "win32") or any(os.environ.get(key) for key in ("DISPLAY", "WAYLAND_DISPLAY"))


def _browse(page: Path) -> bool:
    import webbrowser

    return webbrowser.open(page.as_uri())


def _moments(scene: Scene, frames: Frames | None) -> list[int]:
    """Return the frames of a strip: those listed, or some that are evenly spread."""
    from mlmg_runtime.view.stills import evenly_spread

    if isinstance(frames, tuple):
        beyond = [frame for frame in frames if frame >= scene.n_frames]
        if beyond:
            raise _UsageError(f"frame {beyond[0]}: {scene.name} has the frames 0 to {scene.n_frames - 1}")
        return list(frames)
    part = _part(scene, frames)
    return [part[at] for at in evenly_spread(len(part))]


def _part(scene: Scene, frames: slice | None) -> range:
    part = range(scene.n_frames)[frames or slice(None)]
    if not part:
        raise _UsageError(f"no frame is chosen: {scene.name} has the frames 0 to {scene.n_frames - 1}")
    return part


def _write_gif(scene: Scene, output: Path, frames: slice | None) -> None:
    from mlmg_runtime.view.movie import write_gif

    part = _part(scene, frames)
    progress = ProgressLine()
    try:
        shown = write_gif(scene, output, part, progress)
    finally:
        progress.clear()
    if len(shown) < len(part):
        seconds, whole = len(shown) * scene.frame_time_s, len(part) * scene.frame_time_s
        tell(
            f"mlmg view: {output}: the first {seconds:.2g} s of {whole:.2g} s are shown; "
            f"--frames {shown.stop}:{part.stop} shows the rest"
        )
