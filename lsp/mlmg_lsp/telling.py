"""What a client is told of files unasked: each file's own diagnostics, and those that its users have in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

from lsprotocol import types


class Telling:
    """What is to be told, by the names of files, and what has been."""

    def __init__(self, tell: Callable[[str, list[types.Diagnostic], int | None], object]) -> None:
        """Take what tells the client of a file: by its name all there is to say of it, and the version that is open."""
        self._tell = tell
        self._own: dict[str, tuple[int, Sequence[types.Diagnostic]]] = {}
        self._used: dict[str, Mapping[str, Sequence[types.Diagnostic]]] = {}
        self._told: dict[str, list[types.Diagnostic]] = {}

    def take(
        self,
        name: str,
        version: int,
        own: Sequence[types.Diagnostic],
        used: Mapping[str, Sequence[types.Diagnostic]],
        asks: bool,
    ) -> None:
        """Take what there is to say of an open text and of the files that it uses, and tell the client.

        Parameters
        ----------
        asks : whether the client asks for what there is to say of an open text by itself.
        """
        before, self._used[name] = self._used.get(name, {}), used
        self._own[name] = (version, own)
        # What has not changed is told again: it is of another version.
        self._show(name, asks, again=not asks)
        for file in dict.fromkeys((*before, *used)):
            self._show(file, asks)

    def forget(self, name: str, asks: bool) -> None:
        """Take back what is known only by a text that is open no longer."""
        self._own.pop(name, None)
        used = self._used.pop(name, {})
        self._show(name, asks, again=not asks)
        for file in used:
            self._show(file, asks)

    def _show(self, file: str, asks: bool, again: bool = False) -> None:
        version, own = self._own.get(file, (None, ()))
        known = {_what(one) for one in own}
        further: dict[tuple[Any, ...], types.Diagnostic] = {}
        for one in self._found_by_users(file):
            if _what(one) not in known:
                further.setdefault(_what(one), one)
        shown = [*(() if asks else own), *further.values()]
        if again or shown != self._told.get(file, []):
            self._tell(file, shown, None if asks else version)
        self._told[file] = shown
        if not shown:
            del self._told[file]

    def _found_by_users(self, file: str) -> Iterator[types.Diagnostic]:
        return chain.from_iterable(used.get(file, ()) for used in self._used.values())


def _what(one: types.Diagnostic) -> tuple[Any, ...]:
    """Return what tells a diagnostic from others, whoever has found it."""
    start, end = one.range.start, one.range.end
    return one.code, start.line, start.character, end.line, end.character
