"""What is left out of the search for garbage, and what goes without it."""

import asyncio
import gc
import os
import shutil
from pathlib import Path
from weakref import ref

import pytest
from lsprotocol import types

from mlmg_lsp.features import answer_named
from mlmg_lsp.libraries import Shelf
from mlmg_lsp.memory import forget_way, settle, undisturbed, unsettle
from mlmg_lsp.server import MotionScriptServer
from mlmg_lsp.session import ClientSession
from mlmg_lsp.workspace import Settings
from mlmg_runtime.library import Library

URI = "untitled:memory.ms"
TEXT = "WALK for 3 sec\nIDLE with Upper-Body TALK for 2 sec\n"


def test_what_is_there_is_left_out_until_it_is_taken_back() -> None:
    kept = [[n] for n in range(1000)]
    settle()
    assert gc.get_freeze_count() >= len(kept)
    unsettle()
    assert gc.get_freeze_count() == 0


def test_nothing_is_searched_meanwhile_and_all_as_before_afterwards_whatever_happens() -> None:
    def failing() -> None:
        with undisturbed():
            found.append(gc.isenabled())
            raise ValueError("oh")

    found: list[bool] = []
    with pytest.raises(ValueError, match="oh"):
        failing()
    assert found == [False]
    assert gc.isenabled()


class Large:
    """Something that is to go."""


def test_an_error_that_has_been_told_keeps_nothing_of_where_it_was() -> None:
    def failing() -> None:
        large = Large()
        kept.append(ref(large))
        raise ValueError("oh")

    def tried() -> Exception:
        try:
            try:
                failing()
            finally:
                raise KeyError("ah")
        except KeyError as error:
            return error

    kept: list[ref[Large]] = []
    with undisturbed():
        error = tried()
        assert kept[0]() is not None
        forget_way(error)
        assert kept[0]() is None


def test_a_library_that_is_replaced_goes_at_once_with_all_that_was_worked_out_of_it(
    tmp_path: Path, demo_library: Library
) -> None:
    path = Path(shutil.copy(demo_library.path, tmp_path / "demo.mlmg"))

    async def replaced() -> None:
        session = MotionScriptServer(Settings(str(path)), Shelf()).session
        session.opened(types.DidOpenTextDocumentParams(types.TextDocumentItem(URI, "motion-script", 1, TEXT)))
        document = session.documents.get(URI)
        assert document is not None
        await asked(session)
        assert document.shelved is not None
        before, names = ref(document.shelved.library), ref(document.shelved.names)
        os.utime(path, (1, 1))
        session.saved(types.DidSaveTextDocumentParams(types.TextDocumentIdentifier(URI)))
        assert document.finding is not None
        await document.finding
        await session.snapshot(URI)
        assert before() is None
        assert names() is None
        session.documents.close_all()

    with undisturbed():
        asyncio.run(replaced())


def test_a_library_that_no_text_has_goes_unless_it_was_the_last(demo_library: Library, tmp_path: Path) -> None:
    async def opened() -> list[bool]:
        shelf = Shelf()
        paths = [Path(shutil.copy(demo_library.path, tmp_path / f"{name}.mlmg")) for name in "ab"]
        known = [ref(await shelf.get(path)) for path in paths]
        gc.collect()
        return [one() is not None for one in known] + [shelf.has(path) for path in paths]

    assert asyncio.run(opened()) == [False, True] * 2


async def asked(session: ClientSession) -> None:
    """Ask for what is kept from one answer to the next, and for what cannot be had."""
    snapshot = await session.snapshot(URI)
    document = types.TextDocumentIdentifier(URI)
    for module in ("semantic_tokens", "outline", "code_lens", "formatting"):
        answer_named(f"{module}.get_ahead")(snapshot)
    assert await session.foresight.of(snapshot) is not None
    position = types.Position(0, 0)
    assert answer_named("completion.completion")(snapshot, types.CompletionParams(document, position))
