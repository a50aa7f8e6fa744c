"""What is playing when: the commands and the tracks of a run's report."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mlmg_runtime.errors import FileError


class ReportError(FileError):
    """A file that is no report of a run, or the report of another one."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command: its text, from when it is under way, has arrived, and when the next begins; in frames."""

    text: str
    begin: int
    arrive: int
    end: int


@dataclass(frozen=True, slots=True)
class Stretch:
    """What one graph plays in the frames [begin, end): `kind` is "clip", "transition" or "blend"."""

    begin: int
    end: int
    text: str
    kind: str


@dataclass(frozen=True, slots=True)
class Track:
    """What one graph plays, in the order of time; where it has no stretch, the part follows its parent."""

    graph: str
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True)
class Story:
    """All that a report tells about a motion.

    Attributes
    ----------
    commands : in the order in which they were executed.
    tracks : one a graph, the root graph first.
    joints : the names of the joints that each graph moves, for the graphs of which the report says so.
    up : the vertical axis of the motion, "y" or "z", or None where the report does not say.
    """

    commands: tuple[Command, ...] = ()
    tracks: tuple[Track, ...] = ()
    joints: tuple[tuple[str, tuple[str, ...]], ...] = ()
    up: str | None = None

    def command_at(self, frame: int) -> Command | None:
        """Return the command under way: the last that has begun."""
        begun = [command for command in self.commands if command.begin <= frame]
        return begun[-1] if begun else None

    def playing_at(self, frame: int) -> tuple[tuple[str, Stretch], ...]:
        """Return what each graph that runs plays, the root graph first."""
        return tuple(
            (track.graph, stretch)
            for track in self.tracks
            for stretch in track.stretches
            if stretch.begin <= frame < stretch.end
        )

    def texts(self) -> Iterator[str]:
        """Yield all that may be written about the motion."""
        yield from (command.text for command in self.commands)
        for track in self.tracks:
            yield track.graph
            yield from (stretch.text for stretch in track.stretches)

    def within(self, frames: range) -> Story:
        """Return what is told of some frames of the motion, which are then counted from 0."""

        def at(frame: int) -> int:
            return min(max(-((frames.start - frame) // frames.step), 0), len(frames))

        commands = (
            replace(command, begin=at(command.begin), arrive=at(command.arrive), end=at(command.end))
            for command in self.commands
            if command.begin < frames.stop and max(command.end, command.begin + 1) > frames.start
        )
        tracks = (
            replace(
                track,
                stretches=tuple(
                    replace(stretch, begin=at(stretch.begin), end=at(stretch.end))
                    for stretch in track.stretches
                    if at(stretch.begin) < at(stretch.end)
                ),
            )
            for track in self.tracks
        )
        return replace(self, commands=tuple(commands), tracks=tuple(tracks))


def is_report(content: object) -> bool:
    """Return whether a JSON document looks like the report of a run."""
    return isinstance(content, Mapping) and {"commands", "tracks", "n_frames"} <= content.keys()


def read_story(path: str | Path, n_frames: int) -> Story:
    """Return what the report in a file tells about a motion of `n_frames` frames.

    Raises
    ------
    OSError
        If the file cannot be opened.
    ReportError
        If it is no report, or one of a motion of another length.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        line = getattr(error, "lineno", None)
        raise ReportError(path, line, "expected the report of a run as JSON, found text that is none") from error
    if not is_report(content):
        raise ReportError(path, None, 'expected the report of a run, with "n_frames", "commands" and "tracks"')
    if content["n_frames"] != n_frames:
        message = f"expected the report of a motion of {n_frames} frames, found one of {content['n_frames']}"
        raise ReportError(path, None, message)
    try:
        return story_from_report(content)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise ReportError(path, None, f"the report cannot be understood: {_what_failed(error)}") from error


def story_from_report(report: Mapping[str, Any]) -> Story:
    """Return the story that a report tells.

    An additional key "joints", {graph: [joint name, ...]}, lets the figure show which part each graph moves.
    """
    commands = tuple(
        Command(str(entry["text"]), int(entry["begin"]), int(entry["arrive"]), int(entry["end"]))
        for entry in report["commands"]
    )
    tracks = tuple(
        Track(str(graph), tuple(_stretch(entry) for entry in entries)) for graph, entries in report["tracks"].items()
    )
    joints = tuple((str(graph), tuple(map(str, names))) for graph, names in report.get("joints", {}).items())
    up = report.get("up")
    return Story(commands, tracks, joints, up if up in ("y", "z") else None)


def _stretch(entry: Mapping[str, Any]) -> Stretch:
    return Stretch(int(entry["begin"]), int(entry["end"]), _text(entry), str(entry["kind"]))


def _text(entry: Mapping[str, Any]) -> str:
    """Return what to call an entry of a track: a motion, or from where to where it leads."""
    if entry["kind"] == "clip":
        speed = float(entry.get("speed", 1.0))
        return str(entry["motion"]) if abs(speed - 1.0) < 0.005 else f"{entry['motion']} ×{speed:.2g}"
    if not entry.get("from"):
        return str(entry.get("motion", entry["kind"]))
    before, after = str(entry["from"][0]), str(entry["to"][0]) if entry.get("to") else "parent"
    return f"{before} ↺" if before == after else f"{before} → {after}"


def _what_failed(error: Exception) -> str:
    return f"no key {error}" if isinstance(error, KeyError) else str(error)
