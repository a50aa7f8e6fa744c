"""What a client is told of files unasked: each file's own diagnostics, and those that its users have in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.work import off_loop


class DiagnosticsPublisher:
    """What is to be told, by the names of files, and what has been."""

    def __init__(self, server: LanguageServer) -> None:
        """Take what speaks to the client."""
        self._server = server
        self._uris: dict[str, str] = {}
        self._own: dict[str, tuple[int | None, Sequence[types.Diagnostic]]] = {}
        self._used: dict[str, Mapping[str, Sequence[types.Diagnostic]]] = {}
        self._told: dict[str, list[types.Diagnostic]] = {}

    def opened(self, name: str, uri: str) -> None:
        """Take what the client itself calls a file."""
        self._uris[name] = uri

    async def tell(self, snapshot: Snapshot) -> None:
        """Tell what there is to say of an open text, if the client does not ask, and of the files that it uses."""
        from mlmg_lsp.convert import diagnostics_of, diagnostics_of_used

        own, used = await off_loop(lambda: (diagnostics_of(snapshot), diagnostics_of_used(snapshot)))
        name, asks = snapshot.analysis.source.name, snapshot.client.pulls
        before, self._used[name] = self._used.get(name, {}), used
        self._own[name] = (snapshot.version, own)
        # What has not changed is told again: it is of another version.
        self._show(name, asks, again=not asks)
        for file in dict.fromkeys((*before, *used)):
            self._show(file, asks)

    def forget(self, name: str, asks: bool) -> None:
        """Take back what is known only by a text that is open no longer.

        Parameters
        ----------
        asks : whether the client asks for what there is to say of an open text by itself.
        """
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
            self._publish(file, shown, None if asks else version)
        self._told[file] = shown
        if not shown:
            del self._told[file]

    def _publish(self, file: str, shown: list[types.Diagnostic], version: int | None) -> None:
        uri = self._uris[file] if file in self._uris else Path(file).as_uri()
        self._server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, shown, version=version))

    def _found_by_users(self, file: str) -> Iterator[types.Diagnostic]:
        return chain.from_iterable(used.get(file, ()) for used in self._used.values())


def _what(one: types.Diagnostic) -> tuple[Any, ...]:
    """Return what tells a diagnostic from others, whoever has found it."""
    start, end = one.range.start, one.range.end
    return one.code, start.line, start.character, end.line, end.character
