"""What a conversation works with: the session, how things are set, what has been saved."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from mlmg_lang.script_files import used_files
from mlmg_lang.session.session import Session, Turn

_FileState: TypeAlias = tuple[int, int, int] | None
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


@dataclass(frozen=True, slots=True)
class _Replacement:
    """A session that another has taken the place of, with the entries of both then, and their library's files.

    Attributes
    ----------
    said : the line that asked for it.
    """

    said: str
    old: Session
    new: Session
    old_turns: tuple[Turn, ...]
    new_turns: tuple[Turn, ...]
    old_file: _FileState
    new_file: _FileState


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
    _library_file: _FileState = field(default=None, init=False)
    _told_file: _FileState = field(default=None, init=False)
    _written: dict[str, _FileState] = field(default_factory=dict, init=False)
    _replaced: list[_Replacement] = field(default_factory=list, init=False)
    _taken_back: list[_Replacement] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        """Remember the library's file as it is now."""
        self._library_file = _state_of(self.session.library.path)

    @property
    def unsaved(self) -> bool:
        """Return whether something has been played that is in no file."""
        return any(turn.done for turn in self.session.turns) and self.session.turns != self.saved

    @property
    def library_changed(self) -> bool:
        """Return whether the library's file is another than when it was read."""
        now = _state_of(self.session.library.path)
        return now is not None and now != self._library_file

    def has_to_tell_of_change(self) -> bool:
        """Return whether the library's file has changed since it was read, and since this was last asked."""
        now = _state_of(self.session.library.path)
        news = self.library_changed and now != self._told_file
        self._told_file = now
        return news

    def has_written(self, path: Path) -> None:
        """Remember a file as this conversation has just written it."""
        self._written[os.path.realpath(path)] = _state_of(path)

    def may_write(self, path: Path) -> bool:
        """Return whether nothing is lost if a file is written: it is not there, or as this conversation wrote it."""
        return not path.is_file() or self._written.get(os.path.realpath(path)) == _state_of(path)

    def allow_files_of(self, script: Path) -> None:
        """Let what is loaded from a script use the files that the script itself may use."""
        self.allowed = tuple(dict.fromkeys((*self.allowed, *used_files(script).folders)))
        self.session.files = used_files("-", self.allowed)

    def replace_session(self, session: Session, said: str) -> None:
        """Go on with another session, because of a line that was said."""
        old, file = self.session, _state_of(session.library.path)
        change = _Replacement(said, old, session, old.turns, session.turns, self._library_file, file)
        self._replaced.append(change)
        self._taken_back.clear()
        self.session, self._library_file = session, file

    def undo_replacement(self) -> str | None:
        """Go back to the session before, if this one is as it was then; return what had been said, or None."""
        if not self._replaced or self.session.turns != self._replaced[-1].new_turns:
            return None
        change = self._replaced.pop()
        self._taken_back.append(change)
        self.session, self._library_file = change.old, change.old_file
        return change.said

    def redo_replacement(self) -> str | None:
        """Go on again with the session that was gone back from, if this one is as it was then."""
        if not self._taken_back or self.session.turns != self._taken_back[-1].old_turns:
            return None
        change = self._taken_back.pop()
        self._replaced.append(change)
        self.session, self._library_file = change.new, change.new_file
        return change.said


def _state_of(path: Path) -> _FileState:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
