"""What a conversation works with: the session, how things are set, what has been saved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from mlmg_lang.script_files import used_files
from mlmg_lang.session.session import Session, Turn

Show: TypeAlias = Callable[[Path, Path], str]
"""Shows a motion with its report in the player, and returns what to say of that."""


@dataclass(slots=True)
class Settings:
    """What `.set` sets: how motion is written, and how the conversation goes.

    Attributes
    ----------
    blend, fps : of what is saved and viewed; None for the library's own.
    feet : whether planted feet are kept from sliding in it.
    keys : `emacs` or `vi`.
    time : whether to say how long each line took.
    """

    blend: str | None = None
    fps: float | None = None
    feet: bool = True
    keys: str = "emacs"
    time: bool = False


@dataclass(slots=True)
class Desk:
    """The session of a conversation, and what belongs to it.

    Attributes
    ----------
    show : what opens the player.
    colour : whether replies are coloured.
    saved : the entries that a file holds.
    allowed : folders from which scripts may use files, besides the current one.
    """

    session: Session
    show: Show
    colour: bool = False
    settings: Settings = field(default_factory=Settings)
    saved: tuple[Turn, ...] = ()
    allowed: tuple[Path, ...] = ()
    _library_file: tuple[int, int, int] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        """Remember the library's file as it is now."""
        self.note_library()

    @property
    def unsaved(self) -> bool:
        """Return whether something has been played that is in no file."""
        return any(turn.done for turn in self.session.turns) and self.session.turns != self.saved

    @property
    def library_changed(self) -> bool:
        """Return whether the library's file is another than when it was last noted."""
        now = _state_of(self.session.library.path)
        return now is not None and now != self._library_file

    def note_library(self) -> None:
        """Take the library's file as it is now for the one that is played on."""
        self._library_file = _state_of(self.session.library.path)

    def allow_files_of(self, script: Path) -> None:
        """Let what is loaded from a script use the files that the script itself may use."""
        self.allowed = tuple(dict.fromkeys((*self.allowed, *used_files(script).folders)))
        self.session.files = used_files("-", self.allowed)

    def replace_session(self, session: Session) -> None:
        """Go on with another session."""
        self.session = session
        self.note_library()


def _state_of(path: Path) -> tuple[int, int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
