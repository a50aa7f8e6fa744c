"""The texts that are open in a client, and what is known of each: one analysis after the other, the newest alone."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types

from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.memory import settle, undisturbed, unsettle
from mlmg_lsp.open_text import Beginning, Document, Snapshot, Superseded, path_of
from mlmg_lsp.positions import EditorPosition
from mlmg_lsp.reading import Reader
from mlmg_lsp.texts import edited, lines_of
from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.front_end import Analysis
    from mlmg_lsp.libraries import Shelved

GRACE_S = 1.0
"""So long the first analysis waits for the library, so that a script does not show mistakes which it has not."""


class Documents:
    """All texts that are open in one client."""

    def __init__(
        self,
        files: Callable[[Document, Callable[[str], str | None]], Files],
        told: Callable[[Snapshot], Awaitable[None]],
        get_ready: Callable[[], None],
        get_ahead: Callable[[Snapshot], None],
        is_whole: Callable[[], None],
    ) -> None:
        """Take what is to be asked.

        Parameters
        ----------
        files : says where a text finds the files that it uses; takes also what has the texts of files that are open.
        told : is called with each text that is analysed. get_ready : is called once, before the first.
        get_ahead : is called with a text that has been opened, beside all else.
        is_whole : is called when all of a text is known of which a beginning was told before.
        """
        self.client = Client()
        self._reader = Reader(files, self.text_of, self._tell_beginning)
        self._told = told
        self._get_ready = get_ready
        self._get_ahead = get_ahead
        self._is_whole = is_whole
        self._open: dict[str, Document] = {}
        self._revisions = count(1)
        self._warming: asyncio.Task[None] | None = None

    def all(self) -> list[Document]:
        """Return all open texts."""
        return list(self._open.values())

    def get(self, uri: str) -> Document | None:
        """Return an open text."""
        return self._open.get(uri)

    def opened(self) -> dict[str, tuple[str, int]]:
        """Return the URIs and versions of all open texts, by the names of their files."""
        return {one.name: (one.uri, one.version) for one in self.all()}

    # --- what the client does ---

    def open(self, item: types.TextDocumentItem) -> Document:
        """Take in a text."""
        self.close(item.uri)
        path = path_of(item.uri)
        name = item.uri if path is None else str(path)
        document = Document(item.uri, name, path, item.version, lines_of(item.text))
        self._open[item.uri] = document
        self.analyse(document)
        return document

    def change(self, params: types.DidChangeTextDocumentParams) -> Document | None:
        """Edit a text; of one that is not open, nothing is done."""
        document = self._open.get(params.text_document.uri)
        if document is None:
            return None
        document.version = params.text_document.version
        for change in params.content_changes:
            if isinstance(change, types.TextDocumentContentChangePartial):
                ends = (change.range.start, change.range.end)
                start, end = sorted(EditorPosition(one.line, one.character) for one in ends)
                edited(document.lines, start, end, change.text, self.client.encoding)
            else:
                document.lines = lines_of(change.text)
        document.supersede()
        self.analyse(document)
        return document

    def close(self, uri: str) -> None:
        """Let go of a text."""
        document = self._open.pop(uri, None)
        if document is not None:
            unsettle()
            document.supersede()
            for task in (document.task, document.finding, document.ahead):
                if task is not None:
                    task.cancel()
            document.task = document.finding = document.ahead = None  # they keep it

    def close_all(self) -> None:
        """Let go of all texts."""
        for document in self.all():
            self.close(document.uri)

    # --- what is known of it ---

    async def warm(self) -> None:
        """Get ready, once."""
        if self._warming is None:
            self._warming = asyncio.ensure_future(off_loop(self._get_ready, is_whole=True))
        await asyncio.shield(self._warming)

    async def snapshot(self, uri: str, line: int | None = None) -> Snapshot:
        """Return an open text with its analysis, once there is one.

        Parameters
        ----------
        line : where a beginning of the text will do, a line that it has.

        Raises
        ------
        Superseded
            If the text is edited before that, or is not open.
        """
        document = self._open.get(uri)
        if document is None:
            raise Superseded(f"{uri} is not open")
        ready = document.ready
        while line is not None and not ready.done():
            if document.beginning is not None and line < document.beginning.n_lines:
                return document.beginning.snapshot
            await asyncio.wait((ready, document.longer), return_when=asyncio.FIRST_COMPLETED)
        version = document.version
        analysis = await asyncio.shield(ready)
        if document.version != version:  # edited after that was there, and before it has been waited for
            raise Superseded(f"{uri} has changed")
        return self._snapshot(document, version, analysis)

    def is_current(self, snapshot: Snapshot, with_others: bool = False) -> bool:
        """Return whether a text is still as it was; `with_others`: and so is all else that is open."""
        now, name = self.opened(), snapshot.analysis.source.name
        return now == snapshot.opened if with_others else now.get(name) == snapshot.opened.get(name)

    async def all_read(self) -> None:
        """Wait until all open texts are known, as they are then."""
        while reading := [one.ready for one in self.all() if not one.ready.done()]:
            await asyncio.wait(reading)

    def _snapshot(self, document: Document, version: int, analysis: Analysis) -> Snapshot:
        others = [one for one in self.all() if one is not document]
        read = [one.analysis.source for one in others if one.analysis is not None]
        return Snapshot(
            document.uri,
            version,
            analysis,
            _against(analysis, document.shelved),
            self.client,
            self.opened(),
            tuple(known for one in others if (known := one.known) is not None),
            document.kept,
            document.revision,
            frozenset(file.name for source in read for file in source.used),
        )

    def analyse(self, document: Document, afresh: bool = False) -> None:
        """Begin to analyse a text as it is now; what was begun before stops.

        Parameters
        ----------
        afresh : whether also what has not changed in it may mean something else: by its library, or the files it uses.
        """
        if document.task is not None:
            document.task.cancel()
        document.await_another()
        document.stale |= afresh
        document.task = asyncio.ensure_future(self._analyse(document))

    def reconsider(self, document: Document) -> None:
        """Analyse a text afresh as soon as it is known again which library it has."""
        document.found.clear()
        document.begun = False
        self.analyse(document, afresh=True)

    async def _analyse(self, document: Document) -> None:
        ready = document.ready
        try:
            await self.warm()
            # Not `wait_for`, which may pass over that the task is cancelled.
            with suppress(TimeoutError):  # without its library, then
                async with asyncio.timeout(GRACE_S):
                    await document.found.wait()
            document.begun = True
            analysis = await self._reader.read(document)
        except Exception as error:
            ready.set_exception(error)
            raise
        is_longer, document.beginning = document.beginning is not None, None
        document.revision = next(self._revisions)
        ready.set_result(analysis)
        snapshot = await self.snapshot(document.uri)
        if document.ahead is None:
            document.ahead = asyncio.ensure_future(self._look_ahead(snapshot))
        await self._told(snapshot)
        if is_longer:
            self._is_whole()
        await off_loop(lambda: analysis.ready)

    async def _tell_beginning(self, document: Document, analysis: Analysis, n_lines: int) -> None:
        """Let there be answers of the first lines of a text, and tell what is wrong with them."""
        from mlmg_lang.beginnings import sure

        snapshot = replace(self._snapshot(document, document.version, sure(analysis)), kept={})
        document.take_beginning(Beginning(snapshot, n_lines))
        await self._told(snapshot)

    async def _look_ahead(self, snapshot: Snapshot) -> None:
        """Find out what takes long the first time; later edits leave nearly all of it as it is."""
        await off_loop(undisturbed()(partial(self._get_ahead, snapshot)))
        settle()

    def users_of_changed(self, path: Path) -> list[Document]:
        """Return the open texts that use a file which has changed; those that are being read find out by themselves."""
        for document in self.all():
            if not document.ready.done():
                document.changed.add(os.path.realpath(path))
        return list(dict.fromkeys(user for user, _ in self._uses(path)))

    def outdated_users(self, path: Path) -> list[Document]:
        """Return the open texts that use a file and have read another text of it than the one that is open."""
        text = self.text_of(str(path))
        return list(dict.fromkeys(user for user, file in self._uses(path) if file.text != text))

    def incomplete(self) -> list[Document]:
        """Return the open texts that use a file which was not there, or could not be read."""
        return [one for one in self.all() if one.known is not None and not one.known.made.gathered.used.complete]

    def _uses(self, path: Path) -> Iterator[tuple[Document, Source]]:
        """Yield the open texts that use a file, each with what it has read of it."""
        real = os.path.realpath(path)
        for document in self.all():
            for file in () if document.analysis is None else document.analysis.source.used:
                if os.path.realpath(file.name) == real:
                    yield document, file

    def text_of(self, path: str) -> str | None:
        """Return the text of a file that is open, as it stands in the client."""
        real = os.path.realpath(path)
        for document in self.all():
            if document.path is not None and os.path.realpath(document.path) == real:
                return "".join(document.lines)
        return None


def _against(analysis: Analysis, shelved: Shelved | None) -> Shelved | None:
    """Return the library of a text if it is the one that an analysis is against."""
    return shelved if shelved is not None and shelved.library is analysis.question.catalog else None
