"""Shows a motion: a player that is one HTML file, a strip of moments (PNG), a small movie (GIF).

examples:
  mlmg view stroll.bvh                                  in the browser
  mlmg view stroll.bvh -o stroll.html                   a page to keep or to send
  mlmg view before.bvh after.bvh                        side by side
  mlmg view stroll.bvh --report stroll.json -o stroll.png
  mlmg view stroll.bvh -o step.png --frames 10,25,40    these moments
  mlmg view stroll.bvh -o step.gif --frames 90:240      the frames from 90 up to, without, 240
  mlmg view day.bvh --frames 600s:660s --fps 10         a minute of a long motion, in fewer frames
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
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mlmg_lang.commands.console import DONE, ProgressLine, UsageError, frame_rate, refuse_unwritable, tell
from mlmg_lang.commands.view_frames import Frames, Part, at_most_fps, frames_at, parse_frames, thinned

if TYPE_CHECKING:
    from mlmg_runtime.bvh import Bvh
    from mlmg_runtime.view.captions import Story
    from mlmg_runtime.view.scene import Scene

_ENDINGS = (".html", ".png", ".gif")
_STANDARD_INPUT, _PIPED = "-", "standard input"

_MOST_LETTERS = 12
# What nobody means as a frame time; the camera, which moves smoothly in time, would not get through it either.
_SHORTEST_FRAME_S = 1e-5
_LONGEST_FRAME_S = 1e3


@dataclass(frozen=True, slots=True, eq=False)
class _Motion:
    """A motion that is to be shown, with what its report tells; `path` is as it was typed."""

    path: str
    name: str
    bvh: Bvh
    up: str
    story: Story

    @property
    def n_frames(self) -> int:
        return len(self.bvh.frames)

    def part(self, frames: Frames | None) -> range:
        """Return the frames of the part that is asked for; of the whole motion if none is."""
        part = frames if isinstance(frames, Part) else Part()
        return part.of(self.name, self.n_frames, self.bvh.frame_time_s)

    def scene(self, frames: range) -> Scene:
        """Return some frames, ready to be drawn."""
        from mlmg_runtime.view.scene import scene_from_bvh

        return scene_from_bvh(self.bvh, self.name, up=self.up, story=self.story, frames=frames)


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
        type=parse_frames,
        help="a part (90:240, or 3s:8s in seconds); for a PNG also moments (10,25,40)",
    )
    parser.add_argument(
        "--fps",
        metavar="N",
        type=frame_rate,
        help="the most frames a second: of a player the motion's, of a GIF 15",
    )
    parser.add_argument("--no-open", action="store_true", help="write the player, print where it is, open no browser")


def run(arguments: argparse.Namespace) -> int:
    """Show motions, or write pictures of them."""
    _check(arguments)
    refuse_unwritable([arguments.output])
    progress = ProgressLine()
    try:
        motions = _motions(arguments, progress)
        ending, output = _ending(arguments.output), arguments.output
        if ending == ".html":
            _show_player(motions, arguments)
        elif ending == ".png":
            _write_png(motions[0], output, arguments.frames, progress)
        else:
            _write_gif(motions[0], output, arguments, progress)
    finally:
        progress.clear()
    return DONE


def _check(arguments: argparse.Namespace) -> None:
    """Raise `UsageError` for what can be known to be wrong before a file is opened."""
    ending = _ending(arguments.output)
    if ending not in _ENDINGS:
        raise UsageError(
            f"{arguments.output}: expected a name that ends in {_listed(_ENDINGS)}, found {ending or 'none'}"
        )
    n_motions, n_reports = len(arguments.motions), len(arguments.report)
    if ending != ".html" and n_motions > 1:
        raise UsageError(f"{arguments.output}: a {ending} shows one motion, found {n_motions}; .html shows several")
    if n_reports not in (0, n_motions):
        raise UsageError(f"expected a --report for each of {n_motions} motions, found {n_reports}")
    if ending != ".png" and isinstance(arguments.frames, tuple):
        shows = "a .gif" if ending == ".gif" else "the player"
        raise UsageError(f"{shows} shows the frames between two: --frames 90:240")
    if ending == ".png" and arguments.fps is not None:
        raise UsageError("--fps is for the player and for .gif; a .png shows moments: --frames 10,25,40")
    if arguments.motions.count(_STANDARD_INPUT) > 1:
        raise UsageError("standard input holds one motion; - stands there twice")
    if ending != ".html":
        from mlmg_runtime.view.pillow import need_pillow

        need_pillow()


def _ending(output: Path | None) -> str:
    return ".html" if output is None else output.suffix.lower()


def _listed(words: Sequence[str]) -> str:
    return f"{', '.join(words[:-1])} or {words[-1]}"


def _motions(arguments: argparse.Namespace, progress: ProgressLine) -> list[_Motion]:
    from mlmg_runtime.view.captions import Story

    paths = arguments.motions
    stems = Counter(_letters(Path(path).stem) for path in paths)
    motions = []
    for index, path in enumerate(paths):
        stem = _letters(Path(path).stem)
        name = _PIPED if path == _STANDARD_INPUT else stem if stems[stem] == 1 else _letters(path)
        progress("reading", index, len(paths))
        bvh = _read(path)
        progress.clear()
        for warning in bvh.warnings:
            tell(f"mlmg view: warning: {_PIPED if path == _STANDARD_INPUT else path}: {warning}")
        story = _story(path, arguments.report[index] if arguments.report else None, len(bvh.frames))
        told = story.up if story is not None else None
        motions.append(_Motion(path, name, bvh, arguments.up or told or "y", story or Story()))
    return motions


def _letters(name: str) -> str:
    """Return the name of a file as text; bytes that are none become question marks."""
    return name.encode("utf-8", "replace").decode("utf-8")


def _read(path: str) -> Bvh:
    from mlmg_runtime.bvh import read, read_bytes
    from mlmg_runtime.errors import BvhError

    bvh = read_bytes(sys.stdin.buffer.read(), _PIPED) if path == _STANDARD_INPUT else read(path)
    name = _PIPED if path == _STANDARD_INPUT else path
    if not len(bvh.frames):
        raise BvhError(name, None, "expected a motion of at least one frame, found none")
    if not _SHORTEST_FRAME_S <= bvh.frame_time_s <= _LONGEST_FRAME_S:
        times = f"from {_SHORTEST_FRAME_S:g} to {_LONGEST_FRAME_S:g} s"
        raise BvhError(name, None, f"expected a frame time {times}, found {bvh.frame_time_s:g}")
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


def _show_player(motions: list[_Motion], arguments: argparse.Namespace) -> None:
    from mlmg_runtime.view.html import most_frames, write_html

    scenes = []
    for motion in motions:
        frame_time_s = motion.bvh.frame_time_s
        wanted = at_most_fps(motion.part(arguments.frames), arguments.fps, frame_time_s)
        frames = thinned(wanted, most_frames(motion.bvh.joints) // len(motions), motion.name, frame_time_s)
        if frames.step > wanted.step:
            fps = 1.0 / (frames.step * frame_time_s)
            tell(f"mlmg view: {motion.name}: {len(frames)} of its {len(wanted)} frames are shown, {fps:.3g} a second")
        scenes.append(motion.scene(frames))
    if arguments.output is None:
        _open_player(scenes, browse=not arguments.no_open)
    else:
        write_html(scenes, arguments.output)


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


def _tell_of_letters(scene: Scene) -> None:
    """Say which letters of the captions are spelt out, if any are."""
    from mlmg_runtime.view.lettering import letters_without_font

    letters = letters_without_font(scene.story.texts())
    if letters:
        spelt = letters[0].encode("unicode_escape").decode("ascii")
        more = "..." if len(letters) > _MOST_LETTERS else ""
        tell(
            f"mlmg view: no font was found that has {letters[:_MOST_LETTERS]}{more}: spelt out as in {spelt}; "
            "install one, such as Noto Sans (CJK)"
        )


def _write_png(motion: _Motion, output: Path, asked: Frames | None, progress: ProgressLine) -> None:
    from mlmg_runtime.view.stills import moments, write_png
    from mlmg_runtime.view.studio import CAMERA_SMOOTHING_S

    frame_time_s = motion.bvh.frame_time_s
    if isinstance(asked, tuple):
        chosen = frames_at(asked, motion.name, motion.n_frames, frame_time_s)
    else:
        chosen = moments(motion.story, motion.part(asked))
    reach = round(CAMERA_SMOOTHING_S / frame_time_s)
    around = range(motion.n_frames)[max(min(chosen) - reach, 0) : max(chosen) + reach + 1]
    scene = motion.scene(around)
    _tell_of_letters(scene)
    write_png(scene, output, [frame - around.start for frame in chosen], progress)


def _write_gif(motion: _Motion, output: Path, arguments: argparse.Namespace, progress: ProgressLine) -> None:
    from mlmg_runtime.view.movie import RATE, shown_of, write_gif

    part = motion.part(arguments.frames)
    frame_time_s = motion.bvh.frame_time_s
    shown = shown_of(part, frame_time_s)
    scene = motion.scene(shown)
    _tell_of_letters(scene)
    write_gif(scene, output, progress=progress, fps=arguments.fps or RATE)
    progress.clear()
    if len(shown) < len(part):
        seconds, whole = len(shown) * frame_time_s, len(part) * frame_time_s
        tell(
            f"mlmg view: {output}: the first {seconds:.2g} s of {whole:.2g} s are shown; "
            f"--frames {shown.stop}:{part.stop} shows the rest"
        )
