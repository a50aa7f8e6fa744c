"""The texts that are open in a client, and what is known of each: one analysis after the other, the newest alone."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.uris import to_fs_path

from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.memory import clear_out, settle, undisturbed, unsettle
from mlmg_lsp.positions import EditorPosition
from mlmg_lsp.texts import edited, lines_of
from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.front_end import Analysis
    from mlmg_lsp.libraries import Shelved

GRACE_S = 1.0
"""So long the first analysis waits for the library, so that a script does not show mistakes which it has not."""


class Superseded(Exception):
    """The text has changed before what was asked of it could be answered."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A text at one moment, and all that can be asked of it.

    Attributes
    ----------
    version : as the client counts; None for a text that is not open.
    shelved : its library; None without one.
    opened : all open texts, with their versions, by the names of their files.
    others : what is known of those that are not this one.
    kept : what features keep of a text from one answer to the next, by their names.
    revision : the number of the analysis among all of the client, so that two can be told apart.
    """

    uri: str
    version: int | None
    analysis: Analysis
    shelved: Shelved | None
    client: Client
    opened: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    others: tuple[Analysis, ...] = ()
    kept: dict[str, Any] = field(default_factory=dict)
    revision: int = 0


@dataclass(eq=False)
class Document:
    """A text that is open.

    Attributes
    ----------
    name : the path of its file, or its URI where it has none.
    lines : see `texts.lines_of`.
    found : set when it is known which library it has.
    analysis : the last that was finished; of the present text once `ready` is done. revision : its number.
    begun : whether a first is under way. stale : whether the next has to be made afresh.
    """

    uri: str
    name: str
    path: Path | None
    version: int
    lines: list[str]
    ready: asyncio.Future[Analysis]
    found: asyncio.Event = field(default_factory=asyncio.Event)
    shelved: Shelved | None = None
    analysis: Analysis | None = None
    revision: int = 0
    begun: bool = False
    stale: bool = False
    kept: dict[str, Any] = field(default_factory=dict)
    task: asyncio.Task[None] | None = None
    finding: asyncio.Task[None] | None = None
    ahead: asyncio.Task[None] | None = None

    @property
    def source(self) -> Source:
        """Return its text as it is now."""
        return Source("".join(self.lines), self.name)


def path_of(uri: str) -> Path | None:
    """Return the path that a URI stands for; None if it is no file's, or no file could have it."""
    path = to_fs_path(uri) if uri.startswith("file:") else None
    return None if path is None or "\0" in path else Path(path)


class Documents:
    """All texts that are open in one client."""

    def __init__(
        self,
        files: Callable[[Document, Callable[[str], str | None]], Files],
        told: Callable[[Snapshot], Awaitable[None]],
        get_ready: Callable[[], None],
        get_ahead: Callable[[Snapshot], None],
    ) -> None:
        """Take what is to be asked.

        Parameters
        ----------
        files : says where a text finds the files that it uses; takes also what has the texts of files that are open.
        told : is called with each text that is analysed. get_ready : is called once, before the first.
        get_ahead : is called with a text that has been opened, beside all else.
        """
        self.client = Client()
        self._files = files
        self._told = told
        self._get_ready = get_ready
        self._get_ahead = get_ahead
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
        document = Document(item.uri, name, path, item.version, lines_of(item.text), _future())
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
        _supersede(document)
        self.analyse(document)
        return document

    def close(self, uri: str) -> None:
        """Let go of a text."""
        document = self._open.pop(uri, None)
        if document is not None:
            unsettle()
            _supersede(document)
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

    async def snapshot(self, uri: str) -> Snapshot:
        """Return an open text with its analysis, once there is one.

        Raises
        ------
        Superseded
            If the text is edited before that, or is not open.
        """
        document = self._open.get(uri)
        if document is None:
            raise Superseded(f"{uri} is not open")
        version = document.version
        analysis = await asyncio.shield(document.ready)
        others = [one for one in self.all() if one is not document]
        return Snapshot(
            uri,
            version,
            analysis,
            _against(analysis, document.shelved),
            self.client,
            self.opened(),
            tuple(one.analysis for one in others if one.analysis is not None and one.ready.done()),
            document.kept,
            document.revision,
        )

    def analyse(self, document: Document, afresh: bool = False) -> None:
        """Begin to analyse a text as it is now; what was begun before stops.

        Parameters
        ----------
        afresh : whether also what has not changed in it may mean something else: by its library, or the files it uses.
        """
        if document.task is not None:
            document.task.cancel()
        if document.ready.done():
            document.ready = _future()
        document.stale |= afresh
        document.task = asyncio.ensure_future(self._analyse(document))

    def reconsider(self, document: Document) -> None:
        """Analyse a text afresh as soon as it is known again which library it has."""
        document.found.clear()
        document.begun = False
        self.analyse(document, afresh=True)

    async def _analyse(self, document: Document) -> None:
        ready = document.ready
        await self.warm()
        # Not `wait_for`, which may pass over that the task is cancelled.
        with suppress(TimeoutError):  # without its library, then
            async with asyncio.timeout(GRACE_S):
                await document.found.wait()
        document.begun = True
        try:
            analysis = await off_loop(self._work(document))
        except Exception as error:
            ready.set_exception(error)
            raise
        if document.analysis is not None and document.analysis.question.catalog is not analysis.question.catalog:
            document.analysis = None
            clear_out()
        document.analysis, document.stale, document.revision = analysis, False, next(self._revisions)
        ready.set_result(analysis)
        if analysis.made.serial == 0:  # made afresh, so that nearly all of it will stay
            settle()
        snapshot = await self.snapshot(document.uri)
        if document.ahead is None:
            document.ahead = asyncio.ensure_future(self._look_ahead(snapshot))
        await self._told(snapshot)
        await off_loop(lambda: analysis.ready)

    async def _look_ahead(self, snapshot: Snapshot) -> None:
        """Find out what takes long the first time; later edits leave nearly all of it as it is."""

        def work() -> None:
            with undisturbed():
                self._get_ahead(snapshot)

        await off_loop(work)
        settle()

    def _work(self, document: Document) -> Callable[[], Analysis]:
        """Return what is to be done, with all that it needs at hand: what it would ask may change meanwhile."""
        from mlmg_lang.front_end import Question, analyse_again, analyse_for

        source, shelved, before = document.source, document.shelved, document.analysis
        catalog, names = (None, None) if shelved is None else (shelved.library, shelved.names)
        if not document.stale and before is not None and before.question.catalog is catalog:
            return partial(analyse_again, before, source)
        question = Question(catalog, names, None, self._files(document, self.text_of))

        def afresh() -> Analysis:
            with undisturbed():
                return analyse_for(source, question)

        return afresh

    def users(self, path: Path) -> Iterator[Document]:
        """Yield the open texts that use a file."""
        real = os.path.realpath(path)
        for document in self.all():
            used = () if document.analysis is None else document.analysis.source.used
            if any(os.path.realpath(file.name) == real for file in used):
                yield document

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


def _supersede(document: Document) -> None:
    """Tell those who wait that what they have asked of a text is not to be had any more."""
    if not document.ready.done():
        document.ready.set_exception(Superseded(f"{document.uri} has changed"))


def _future() -> asyncio.Future[Analysis]:
    """Return a future that nobody needs to wait for."""
    future: asyncio.Future[Analysis] = asyncio.get_running_loop().create_future()
    future.add_done_callback(lambda done: None if done.cancelled() else done.exception() and None)
    return future


@dataclass(frozen=True, slots=True)
class OpenFiles:
    """Finds the files that a text uses, as they stand in the client where they are open there."""

    files: Files
    text_of: Callable[[str], str | None]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file and what is wrong with its bytes; or, in words, why it cannot be used."""
        found = self.files.find(path, user)
        if isinstance(found, str):
            return found
        text = self.text_of(found[0].name)
        return found if text is None else (Source(text, found[0].name), ())
