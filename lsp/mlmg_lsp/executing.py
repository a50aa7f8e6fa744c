"""workspace/executeCommand: work that takes a while, which the person sees going on and can give up."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInvalidParams
from pygls.lsp.server import LanguageServer

from mlmg_lsp.background import Background
from mlmg_lsp.command_arguments import CommandArguments, Refused, arguments_from
from mlmg_lsp.documents import Documents
from mlmg_lsp.features import COMMANDS, answer_named
from mlmg_lsp.open_text import Snapshot, path_of
from mlmg_lsp.pages import Pages
from mlmg_lsp.progress import WorkDoneProgress
from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lsp.features.execute_command import Done

_TITLES: Final = {"mlmg.play": "Playing", "mlmg.explain": "Explaining", "mlmg.candidates": "Looking for candidates"}
_REPLACE: Final = "Replace it"


class Executor:
    """Executes commands for one client."""

    def __init__(
        self,
        server: LanguageServer,
        documents: Documents,
        snapshot: Callable[[str], Awaitable[Snapshot]],
        background: Background,
    ) -> None:
        """Take what speaks to the client, what gives an open text with all that is known, and where it is shown."""
        self._server = server
        self._documents = documents
        self._snapshot = snapshot
        self._background = background
        self._pages = Pages()
        self._written: set[Path] = set()

    async def execute(self, params: types.ExecuteCommandParams) -> Any:
        """Execute a command; return its result, None if the person would rather not.

        Raises
        ------
        JsonRpcException
            That says why it cannot be done.
        """
        if params.command not in COMMANDS:
            raise JsonRpcInvalidParams(f"there is no command {params.command!r}; there are {', '.join(COMMANDS)}")
        asked = arguments_from(params.arguments)
        # What is being imported must not be interrupted.
        do: Callable[..., Done] = await asyncio.shield(off_loop(partial(answer_named, COMMANDS[params.command])))
        if params.command == "mlmg.rule":
            done = do(asked.code)
        else:
            snapshot = await self._snapshot_of(asked)
            plays = params.command == "mlmg.play"
            if plays and not await self._may_write(asked := _with_target(asked)):
                return None
            done = await self._shown(params, partial(do, snapshot, asked))
            if plays and asked.to is not None:
                self._written.add(asked.to)
        if asked.shown:
            self._show(done, asked)
        return done.result

    def end(self) -> None:
        """Leave nothing behind but what was asked for."""
        self._pages.clear()

    async def _snapshot_of(self, asked: CommandArguments) -> Snapshot:
        if self._documents.get(asked.uri) is None:
            raise Refused(f"{asked.uri} is not open in the editor; open it first")
        return await self._snapshot(asked.uri)

    async def _shown(self, params: types.ExecuteCommandParams, work: Callable[[Callable[..., object]], Done]) -> Done:
        """Return what some work comes to, which the person sees going on and can give up."""
        bar = WorkDoneProgress(self._server, self._documents.client.progress, params.work_done_token)
        task = asyncio.ensure_future(off_loop(lambda: work(bar.tell)))
        bar.begin(_TITLES[params.command], task.cancel)
        try:
            return await task
        finally:
            bar.end()

    async def _may_write(self, asked: CommandArguments) -> bool:
        """Return whether a motion may be written: over a file that was there before only if the person says so."""
        path = asked.to
        if path is None or asked.chosen or path in self._written or not path.exists():
            return True
        question = f"{path} is there already."
        answer = await self._server.window_show_message_request_async(
            types.ShowMessageRequestParams(
                types.MessageType.Warning,
                question,
                [types.MessageActionItem(_REPLACE), types.MessageActionItem("Leave it")],
            )
        )
        if answer is not None and answer.title == _REPLACE:
            return True
        self._say(f"{path} was left as it is.")
        return False

    def _show(self, done: Done, asked: CommandArguments) -> None:
        """Show what came of a command; the client may take its time for a page, or never say that it is shown."""
        if done.page is not None:
            path = self._pages.write(asked.uri, *done.page)
            self._background.begin(self._show_page(path, done.said))
        elif done.said:
            self._say(done.said)

    async def _show_page(self, path: Path, said: str) -> None:
        """Show a page in the editor, where that can show one; else tell where it is."""
        if not await self._has_shown(path):
            self._say(f"{said} ({path})" if said else f"written to {path}")

    async def _has_shown(self, path: Path) -> bool:
        if not self._documents.client.shows:
            return False
        try:
            params = types.ShowDocumentParams(path.as_uri(), external=False, take_focus=True)
            answer = await self._server.window_show_document_async(params)
        except JsonRpcException:
            return False
        return answer is not None and answer.success  # an answer may have no result at all

    def _say(self, message: str) -> None:
        self._server.window_show_message(types.ShowMessageParams(types.MessageType.Info, message))


def _with_target(asked: CommandArguments) -> CommandArguments:
    """Return a command with the file to write: beside the script, unless it says where.

    Raises
    ------
    Refused
        If that is the script itself, or no name of a motion.
    """
    script = path_of(asked.uri)
    if asked.to is None:
        asked = asked if script is None else replace(asked, to=script.with_suffix(".bvh"))
    elif asked.to.suffix.lower() != ".bvh":
        raise Refused(f"{asked.to}: a motion is written as BVH; expected a name that ends in .bvh")
    if script is not None and script in (asked.to, asked.report):
        raise Refused(f"{script} is the script; the motion needs another name")
    return asked
