"""What changes while something else is still being worked out."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from lsprotocol import types

from mlmg_lang.definitions.gather import Files
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.script_files import used_files
from mlmg_lang.source import Source
from mlmg_lsp.documents import Documents
from mlmg_lsp.open_text import Document, Snapshot
from mlmg_lsp.reading import OpenFiles

WAIT_S = 60.0
CONTENT_MODIFIED = -32801
URI = "untitled:long"
HERE = {"textDocument": {"uri": URI}}
FORMAT = {**HERE, "options": {"tabSize": 4, "insertSpaces": True}}
TOP = {"line": 0, "character": 0}
ALL = {"start": TOP, "end": {"line": 3000, "character": 0}}
AT_THE_TOP = {"range": {"start": TOP, "end": TOP}, "text": "IDLE\n"}
REFRESHED = {"workspace": {"inlayHint": {"refreshSupport": True}}}
LONG = "WALK   for 3 sec\nIDLE for 2000 ms\nWALK with Upper-Body TALK for 3 sec\n" * 1_000
DEFINING = "let stroll = WALK for 3 sec\n"


async def nothing(_snapshot: Snapshot) -> None:
    pass


def item(path: Path, text: str) -> types.TextDocumentItem:
    return types.TextDocumentItem(path.as_uri(), "motion-script", 1, text)


def lets_of_user(folder: Path, meanwhile: Callable[[Documents, Path], object], opened: str | None = None) -> list[str]:
    """Return what a text uses that is read for the first time, and what happens once the used file has been read.

    Parameters
    ----------
    opened : the text of the used file in the client, if it is open there.
    """
    user, used = folder / "user.ms", folder / "used.ms"

    @dataclass
    class Finding:
        """Finds files, and lets something happen as soon as one has been read."""

        files: Files
        then: Callable[[], object]

        def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
            found = self.files.find(path, user)
            self.then()
            return found

    async def read() -> list[str]:
        loop, left = asyncio.get_running_loop(), [meanwhile]

        async def happen() -> None:
            while left:
                left.pop()(documents, used)

        def files(_document: Document, text_of: Callable[[str], str | None]) -> Files:
            found = OpenFiles(used_files(user), text_of)
            return Finding(found, lambda: asyncio.run_coroutine_threadsafe(happen(), loop).result())

        documents = Documents(files, nothing, lambda: None, lambda _: None, lambda: None)
        if opened is not None:
            documents.open(item(used, opened)).found.set()
        documents.open(item(user, 'use "used.ms"\nstroll\n')).found.set()
        async with asyncio.timeout(WAIT_S):
            snapshot = await documents.snapshot(user.as_uri())
        documents.close_all()
        return list(snapshot.analysis.definitions.lets)

    return asyncio.run(read())


@pytest.mark.parametrize("before", ["", None], ids=["changed", "made"])
def test_a_used_file_that_is_written_while_its_user_is_read_counts_as_it_is_then(tmp_path, before):
    def write(documents: Documents, used: Path) -> None:
        used.write_text(DEFINING, encoding="utf-8")
        assert documents.users_of_changed(used) == []

    if before is not None:
        (tmp_path / "used.ms").write_text(before, encoding="utf-8")
    assert lets_of_user(tmp_path, write) == ["stroll"]


def test_a_used_file_that_is_opened_while_its_user_is_read_counts_as_it_stands_there(tmp_path):
    def open_it(documents: Documents, used: Path) -> None:
        documents.open(item(used, DEFINING)).found.set()

    (tmp_path / "used.ms").write_text("", encoding="utf-8")
    assert lets_of_user(tmp_path, open_it) == ["stroll"]


def test_a_used_file_that_is_closed_unsaved_while_its_user_is_read_counts_as_it_is_on_disk(tmp_path):
    def close(documents: Documents, used: Path) -> None:
        documents.close(used.as_uri())
        documents.users_of_changed(used)

    (tmp_path / "used.ms").write_text(DEFINING, encoding="utf-8")
    assert lets_of_user(tmp_path, close, opened="") == ["stroll"]


def test_where_nothing_can_be_got_ready_who_asks_is_told(tmp_path):
    def get_ready() -> None:
        raise MemoryError

    async def ask() -> None:
        documents = Documents(lambda _, __: used_files(tmp_path), nothing, get_ready, lambda _: None, lambda: None)
        document = documents.open(item(tmp_path / "a.ms", "WALK\n"))
        document.found.set()
        async with asyncio.timeout(WAIT_S):
            with pytest.raises(MemoryError):
                await documents.snapshot(document.uri)
        assert document.known is None

    asyncio.run(ask())


def begun(start, text: str, capabilities=None):
    client = start()
    client.initialize(capabilities)
    client.open(URI, text)
    return client


@pytest.mark.parametrize(("method", "more"), [("formatting", {}), ("rangeFormatting", {"range": ALL})])
def test_edits_to_a_text_that_is_edited_before_they_are_there_are_refused(start, method, more):
    client = begun(start, LONG)
    client.ask("textDocument/documentSymbol", HERE)
    number = client.begin(f"textDocument/{method}", {**FORMAT, **more})
    client.edit(URI, 2, AT_THE_TOP)
    assert client.outcome(number)["error"]["code"] == CONTENT_MODIFIED


def test_what_is_foreseen_of_a_text_is_told_though_another_is_opened_meanwhile(start):
    client = begun(start, LONG, REFRESHED)
    client.ask("textDocument/documentSymbol", HERE)
    stretch = {"start": {"line": 0, "character": 0}, "end": {"line": 10, "character": 0}}
    number = client.begin("textDocument/inlayHint", {**HERE, "range": stretch})
    client.open("untitled:other", "IDLE\n")
    hints = client.result(number)
    if not any("Walk_0" in one["label"] for one in hints):
        client.wait_for("workspace/inlayHint/refresh")
        hints = client.ask("textDocument/inlayHint", {**HERE, "range": stretch})
    assert any("Walk_0" in one["label"] for one in hints)


def test_what_is_to_be_known_of_a_completion_does_not_wait_for_all_of_a_text(start):
    client = begun(start, LONG)
    (first, *_) = client.ask_at("completion", URI, 0, 1)["items"]
    resolving = client.begin("completionItem/resolve", first)
    client.edit(URI, 2, AT_THE_TOP)  # what waits for all is refused then
    assert client.result(resolving)["documentation"]


def test_a_library_that_no_file_can_be_is_told_and_keeps_nobody_waiting(start):
    client = start("--stdio")
    client.initialize(initializationOptions={"library": "a\0b.mlmg"})
    client.open(URI, "WALK for\n")
    assert "cannot be used" in client.wait_for("window/showMessage")["message"]
    assert client.diagnostics(URI)
