"""A text that is open in a client, and what is known of it at one moment."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pygls.uris import to_fs_path

from mlmg_lsp.client import Client

if TYPE_CHECKING:
    from mlmg_lang.front_end import Analysis
    from mlmg_lsp.libraries import Shelved


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
    revision : the number of the analysis among all of the client, so that two can be told apart; 0 if it is that of a
        beginning of the text.
    used : the names of the files that other open texts use, or did before they were edited.
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
    used: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Beginning:
    """What is known of the first lines of a text while it is read for the first time."""

    snapshot: Snapshot
    n_lines: int


def _future() -> asyncio.Future[Any]:
    """Return a future that nobody needs to wait for."""
    future = asyncio.get_running_loop().create_future()
    future.add_done_callback(lambda done: None if done.cancelled() else done.exception() and None)
    return future


@dataclass(eq=False)
class Document:
    """A text that is open.

    Attributes
    ----------
    name : the path of its file, or its URI where it has none.
    lines : see `texts.lines_of`.
    found : set when it is known which library it has.
    ready : done when all of the present text has been analysed.
    analysis : the last that was finished; of the present text once `ready` is done.
    n_read : how many lines the text had of which `analysis` is if it was of a beginning alone; else None.
    beginning : of the present text, while it is read for the first time. longer : done when there is another.
    revision : the number of the last analysis that was of a whole text; 0 before the first.
    begun : whether a first is under way. stale : whether the next has to be made afresh.
    changed : the files that have changed while it was read, and may have been read before that.
    """

    uri: str
    name: str
    path: Path | None
    version: int
    lines: list[str]
    found: asyncio.Event = field(default_factory=asyncio.Event)
    ready: asyncio.Future[Analysis] = field(default_factory=_future)
    shelved: Shelved | None = None
    analysis: Analysis | None = None
    n_read: int | None = None
    beginning: Beginning | None = None
    longer: asyncio.Future[None] = field(default_factory=_future)
    revision: int = 0
    begun: bool = False
    stale: bool = False
    changed: set[str] = field(default_factory=set)
    kept: dict[str, Any] = field(default_factory=dict)
    task: asyncio.Task[None] | None = None
    finding: asyncio.Task[None] | None = None
    ahead: asyncio.Task[None] | None = None

    @property
    def known(self) -> Analysis | None:
        """Return the analysis of the present text, if there is one."""
        is_known = self.ready.done() and self.ready.exception() is None
        return self.analysis if is_known else None

    def await_another(self) -> None:
        """Begin to wait for another analysis than the last."""
        self.beginning = None
        if self.ready.done():
            self.ready = _future()

    def take_beginning(self, beginning: Beginning) -> None:
        """Let those know who wait for no more than a beginning that there is one, or a longer one."""
        self.beginning, found = beginning, self.longer
        self.longer = _future()
        found.set_result(None)

    def supersede(self) -> None:
        """Tell those who wait that what they have asked of the text is not to be had any more."""
        if not self.ready.done():
            self.ready.set_exception(Superseded(f"{self.uri} has changed"))


def path_of(uri: str) -> Path | None:
    """Return the path that a URI stands for; None if it is no file's, or no file could have it."""
    path = to_fs_path(uri) if uri.startswith("file:") else None
    return None if path is None or "\0" in path else Path(path)
