"""The protocol as pygls has it, but for texts, which are kept by `documents`, for commands, and for how it ends."""

from __future__ import annotations

import asyncio
import json
import logging
import typing
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any, Final, cast

from lsprotocol import types
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcInvalidRequest,
    JsonRpcServerNotInitialized,
)
from pygls.protocol import LanguageServerProtocol, lsp_method

from mlmg_lsp.memory import forget_way
from mlmg_lsp.positions import Encoding
from mlmg_lsp.written import Written

if TYPE_CHECKING:
    from cattrs import Converter
    from pygls.lsp.server import LanguageServer

_log = logging.getLogger(__name__)

_HANDED_ON: Final = (
    types.TEXT_DOCUMENT_DID_OPEN,
    types.TEXT_DOCUMENT_DID_CHANGE,
    types.TEXT_DOCUMENT_DID_CLOSE,
    types.WORKSPACE_EXECUTE_COMMAND,
)
"""What pygls would do with these is left out: in its copies of texts, Unicode's line ends would put edits elsewhere."""


class Host(typing.Protocol):
    """The server, as the protocol sees it.

    Attributes
    ----------
    encoding : what a client counts characters in that does not say so.
    ended : is set at the end. orderly : whether that was announced.
    """

    encoding: Encoding
    orderly: bool
    ended: asyncio.Event

    def fit(self, capabilities: types.ServerCapabilities) -> None:
        """Leave out of what the client is told that can be done what it had better not ask for; add what it may."""


class Protocol(LanguageServerProtocol):
    """Hands messages on."""

    def __init__(self, server: LanguageServer, converter: Converter) -> None:
        """Take to whom they are handed, and what makes them of JSON."""
        super().__init__(server, converter)
        for method in _HANDED_ON:
            del self.fm.builtin_features[method]

    def connect(self, send: Callable[[bytes], object], headers: bool) -> None:
        """Take what sends a message."""
        self.set_writer(_Writer(send), headers)

    def receive(self, body: bytes | str) -> None:
        """Handle a message. One that cannot be understood is passed over; if it asks for an answer, it is told so."""
        try:
            raw = json.loads(body)
        except (ValueError, RecursionError) as error:
            _log.warning("a message that is no JSON, or too deep, was passed over: %s", error)
            return
        if not isinstance(raw, dict):
            _log.warning("a message that is no object was passed over")
            return
        if raw.get("error", ...) is None:  # as some clients say that there is none
            del raw["error"]
        if "method" in raw:
            raw.setdefault("params", None)  # pygls expects it
        number = raw.get("id")
        if self._shutdown and raw.get("method") not in (None, types.EXIT):
            self._refuse(number, JsonRpcInvalidRequest("`shutdown` has come before"))
            return
        try:
            self.handle_message(self.structure_message(raw))
        except Exception as error:
            _log.warning("a message that is not as it should be was passed over: %s", error)
            if raw.get("method") is None:
                self._give_up(number)
            else:
                self._refuse(number, error)

    def _give_up(self, number: Any) -> None:
        """Let who waits for an answer of the client know that it cannot be understood."""
        future = self._request_futures.pop(number, None) if isinstance(number, int | str) else None
        if future is not None and not future.done():
            future.set_exception(JsonRpcInvalidParams("the answer is not as it should be"))

    def _refuse(self, number: Any, error: Exception) -> None:
        if isinstance(number, int | str):
            known = error if isinstance(error, JsonRpcException) else JsonRpcInvalidParams(str(error))
            self._send_response(number, None, known.to_response_error())

    def _handle_request(self, msg_id: Any, method_name: str, params: Any) -> None:
        if self._workspace is None and method_name != types.INITIALIZE:
            error: JsonRpcException = JsonRpcServerNotInitialized("`initialize` comes first")
        elif self._workspace is not None and method_name == types.INITIALIZE:
            error = JsonRpcInvalidRequest("`initialize` has come before")
        else:
            super()._handle_request(msg_id, method_name, params)
            return
        self._send_response(msg_id, None, error.to_response_error())

    def _send_handler_result(self, future: Any, *, msg_id: Any) -> None:
        super()._send_handler_result(future, msg_id=msg_id)
        if not future.cancelled():
            forget_way(future.exception())

    def _handle_response(self, msg_id: Any, result: Any = None, error: Any = None) -> None:
        """Take an answer of the client, if somebody still waits for it."""
        future = self._request_futures.get(msg_id)
        if future is not None and future.cancelled():
            del self._request_futures[msg_id]
        else:
            super()._handle_response(msg_id, result, error)

    def _send_response(self, msg_id: Any, result: Any = None, error: Any = None) -> None:
        if error is None and isinstance(result, Written):
            self._result_types.pop(msg_id, None)
            self._write(f'{{"id":{json.dumps(msg_id)},"jsonrpc":"{self.VERSION}","result":{result.text}}}')
        else:
            super()._send_response(msg_id, result, error)

    def _write(self, body: str) -> None:
        """Send a message as it is; all in it is ASCII."""
        if self.writer is not None:
            head = f"Content-Length: {len(body)}\r\n\r\n" if self._include_headers else ""
            self.writer.write((head + body).encode("ascii"))

    def _handle_cancel_notification(self, msg_id: Any) -> None:
        future = self._request_futures.pop(msg_id, None)
        if future is not None:
            future.cancel()

    @property
    def _host(self) -> Host:
        return cast("Host", self._server)

    @lsp_method(types.INITIALIZE)
    def lsp_initialize(self, params: types.InitializeParams) -> Generator[Any, Any, types.InitializeResult]:
        """Answer with what can be done for the client; what it counts characters in is filled in if it does not say."""
        general = params.capabilities.general or types.GeneralClientCapabilities()
        general.position_encodings = general.position_encodings or [self._host.encoding]
        params.capabilities.general = general
        result = yield from super().lsp_initialize(params)
        self._host.fit(result.capabilities)
        return result

    @lsp_method(types.EXIT)
    def lsp_exit(self, *_: object) -> None:  # type: ignore[override]
        """End; in order, if `shutdown` has come before."""
        self._host.orderly = self._shutdown
        self._host.ended.set()


class _Writer:
    """What pygls sends by."""

    def __init__(self, send: Callable[[bytes], object]) -> None:
        self._send = send

    def write(self, data: bytes | str) -> None:
        self._send(data.encode("utf-8") if isinstance(data, str) else data)

    def close(self) -> None:
        """Do nothing: transports close what they have opened."""
