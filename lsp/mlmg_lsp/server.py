"""The server of one client: how its messages come in and go out, how it begins and ends."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcInternalError
from pygls.lsp.server import LanguageServer

from mlmg_lsp.features import COMMANDS
from mlmg_lsp.handlers import register
from mlmg_lsp.libraries import Shelf
from mlmg_lsp.presence import watch
from mlmg_lsp.protocol import Protocol
from mlmg_lsp.session import ClientSession
from mlmg_lsp.workspace import Settings


class MotionScriptServer(LanguageServer):
    """Serves one client.

    Attributes
    ----------
    encoding : what the client counts characters in, if it does not say so.
    ended : set when the client has ended it, or is no longer there. orderly : whether it has said that it would.
    session : what is open in the client.
    """

    protocol: Protocol

    def __init__(self, settings: Settings, shelf: Shelf) -> None:
        """Take the settings of the command, and the libraries that are open in this process."""
        super().__init__("mlmg lsp", version("mlmg"), protocol_cls=Protocol)
        self.encoding = settings.encoding
        self.ended = asyncio.Event()
        self.orderly = False
        self.session = ClientSession(self, settings, shelf)
        self.feature(types.INITIALIZE)(partial(self.begin))
        register(self, self.session)

    # --- as a transport sees it ---

    def connect(self, send: Callable[[bytes], object], headers: bool) -> None:
        """Take what sends a message."""
        self.protocol.connect(send, headers)

    def receive(self, body: bytes | str) -> None:
        """Take a message; one that is not well-formed is passed over."""
        self.protocol.receive(body)

    def leave(self) -> None:
        """Let go of all."""
        self.session.end()

    # --- as the protocol sees it ---

    def begin(self, params: types.InitializeParams) -> None:
        """Take in what the client says of itself; end when its process is no longer there, if it says which that is."""
        self.session.begin(params)
        if params.process_id is not None:
            self.session.background.begin(watch(params.process_id, self.ended))

    def fit(self, capabilities: types.ServerCapabilities) -> None:
        """Tell of commands; and not of answering for diagnostics where a client is told of them unasked."""
        capabilities.execute_command_provider = types.ExecuteCommandOptions(list(COMMANDS), work_done_progress=True)
        if not self.session.documents.client.pulls:
            capabilities.diagnostic_provider = None

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Write a failure of our own into the client's log; what a client asks for in vain is no failure."""
        if isinstance(error, JsonRpcInternalError):
            self.window_log_message(types.LogMessageParams(types.MessageType.Error, f"{error.message}\n{error.data}"))
