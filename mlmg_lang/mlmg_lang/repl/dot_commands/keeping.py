"""Commands that keep what was played: in a file, in the player; and how that is done."""

from __future__ import annotations

import json
import os
import re
import shlex
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mlmg_lang.definitions.gather import Files
from mlmg_lang.libraries import DEMO, is_demo
from mlmg_lang.rendering.wording import safe
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands.dot_command import path_of
from mlmg_lang.repl.reply import Question, Refusal, Reply
from mlmg_lang.script_files import used_files
from mlmg_lang.session.saving import SavedScript, has_played, script_from_session
from mlmg_lang.session.session import Session
from mlmg_runtime.files import atomic_output

if TYPE_CHECKING:
    from mlmg_lang.perform import Performance


_HEADING: Final = re.compile(r"^# mlmgc \S.* -o \S.* --start \S.*\n", re.MULTILINE)
"""What a script begins with that was saved, and loaded since."""


def save(desk: Desk, argument: str) -> Reply:
    """Write what was played as motion (.bvh), or the script that plays it again (.ms), if no file is lost by that."""
    path = _output(desk, argument)
    if desk.may_write(path):
        return save_over(desk, argument)
    there = f"{path} is there already"
    question = Question(f"{there}. Replace it?", f".save! {argument}", f"{path} was left as it is")
    told = f"{there}; `.save! {argument}` replaces it"
    return Reply(f"error: {safe(told)}\n", {"problem": told}, ok=False, question=question)


def save_over(desk: Desk, argument: str) -> Reply:
    """Write what was played, over the file that is there."""
    path = _output(desk, argument)
    reply = _save_motion(desk, path) if path.suffix.lower() == ".bvh" else _save_script(desk, path)
    desk.saved = desk.session.turns
    desk.has_written(path)
    return reply


def _output(desk: Desk, argument: str) -> Path:
    """Return the file that what was played is to be written to.

    Raises
    ------
    Refusal
        If it is none for a motion or a script, or is read, or if nothing has been played.
    """
    path = path_of(argument)
    if path.suffix.lower() not in (".bvh", ".ms"):
        raise Refusal(f"name a file that ends in .bvh or .ms, as in `.save stroll.bvh`, found `{argument}`")
    _refuse_to_write_what_is_read(desk.session, path)
    if not has_played(desk.session):
        raise _nothing_played()
    return path


def _save_motion(desk: Desk, path: Path) -> Reply:
    performance = _perform(desk, _script(desk.session))
    _write(performance, path)
    n_frames = performance.report["n_frames"]
    told = f"{safe(str(path))}: {n_frames} frames, {_seconds_of(performance):.1f} s\n"
    return Reply(told, {"file": str(path), "frames": n_frames})


def _save_script(desk: Desk, path: Path) -> Reply:
    script = _script(desk.session, str(path), used_files(path))
    with atomic_output(path) as temporary:
        temporary.write_text(_headed(script, desk, path), encoding="utf-8")
    return Reply(f"{safe(str(path))}: {_told(script)}\n", {"file": str(path), "as_entered": script.as_entered})


def view(desk: Desk, argument: str) -> Reply:
    """Open what was played in the player."""
    performance = _perform(desk, _script(desk.session))
    folder = Path(tempfile.mkdtemp(prefix="mlmg-repl-"))
    motion, report = folder / "session.bvh", folder / "session.json"
    _write(performance, motion)
    report.write_text(json.dumps(performance.report, ensure_ascii=False), encoding="utf-8")
    told = desk.show(motion, report)
    return Reply(f"{told}\n", {"player": told})


def set_option(desk: Desk, argument: str) -> Reply:
    """Set how motion is written, or how the conversation goes; without words, tell how things are set."""
    name, _, value = argument.partition(" ")
    settings, value = desk.settings, value.strip()
    match name, value:
        case "", _:
            pass
        case "blend", "c1" | "linear" | "library":
            settings.blend = None if value == "library" else value
        case "feet", "on" | "off":
            settings.feet = value == "on"
        case "keys", "emacs" | "vi":
            settings.keys = value
        case "fps", _:
            settings.fps = _rate(value)
        case _:
            raise Refusal("expected `blend c1|linear|library`, `fps N|library`, `feet on|off` or `keys emacs|vi`")
    rows = {
        "blend": settings.blend or "library",
        "fps": settings.fps or "library",
        "feet": "on" if settings.feet else "off",
        "keys": settings.keys,
    }
    return Reply("".join(f"{key} {one}\n" for key, one in rows.items()), rows)


def _rate(value: str) -> float | None:
    if value == "library":
        return None
    try:
        rate = float(value)
    except ValueError:
        rate = 0.0
    if not 0 < rate <= 10000:
        raise Refusal(f"expected frames a second, as in `.set fps 60`, or `library`; found `{value}`")
    return rate


def time(desk: Desk, argument: str) -> Reply:
    """Say how long each line takes, or say it no longer."""
    if argument not in ("", "on", "off"):
        raise Refusal(f"expected `.time on` or `.time off`, found `{argument}`")
    desk.settings.time = not desk.settings.time if not argument else argument == "on"
    return Reply(f"time {'on' if desk.settings.time else 'off'}\n", {"time": desk.settings.time})


def _refuse_to_write_what_is_read(session: Session, path: Path) -> None:
    read = {os.path.realpath(one) for one in (str(session.library.path), *session.files_read)}
    if os.path.realpath(path) in read:
        raise Refusal(f"{path}: this file is read; the output needs another name")


def _script(session: Session, name: str = "<session>", files: Files | None = None) -> SavedScript:
    script = script_from_session(session, name, files)
    if script is None:
        raise _nothing_played()
    return script


def _nothing_played() -> Refusal:
    return Refusal("nothing has been played yet")


def _write(performance: Performance, path: Path) -> None:
    from mlmg_runtime import bvh

    bvh.write(performance.bvh, path)


def _perform(desk: Desk, script: SavedScript) -> Performance:
    from mlmg_lang.perform import perform

    settings, session = desk.settings, desk.session
    return perform(script.plan, session.library, session.seed, settings.fps, settings.blend, settings.feet)


def _seconds_of(performance: Performance) -> float:
    """Return how long a motion is, in seconds."""
    return float(performance.report["n_frames"] / performance.report["frame_rate"])


def _told(script: SavedScript) -> str:
    if script.as_entered:
        return "plays exactly what was played"
    return "plays exactly what was played: with the motions that were taken, as what was entered would not do so"


def _headed(script: SavedScript, desk: Desk, path: Path) -> str:
    """Return a script with a line that says how to play it, from its own folder."""
    session, settings = desk.session, desk.settings
    words = ["mlmgc", path.name, "-o", path.with_suffix(".bvh").name, "--library", _library_from(session, path)]
    words += ["--start", session.starts_in, "--seed", str(session.seed)]
    words += ["--blend", settings.blend] if settings.blend is not None else []
    words += ["--fps", f"{settings.fps:g}"] if settings.fps is not None else []
    words += [] if settings.feet else ["--no-feet"]
    return f"# {shlex.join(words)}\n{_HEADING.sub('', script.text)}"


def _library_from(session: Session, script: Path) -> str:
    """Return what `--library` has to say in the folder of a script."""
    library = session.library.path
    if is_demo(library):
        return DEMO
    try:
        return os.path.relpath(os.path.realpath(library), os.path.realpath(script.parent))
    except ValueError:  # on another drive
        return str(library.absolute())
