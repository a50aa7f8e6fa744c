"""What a client is asked for, if it can be: to tell of files, to tell its settings, to ask again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from mlmg_lang.libraries import SETTINGS
from mlmg_lsp.background import Background
from mlmg_lsp.documents import Documents

_SECTION: Final = "mlmg"
_WATCHED: Final = ("**/*.ms", "**/*.mlmg", "**/library.toml", f"**/{SETTINGS}")


class ClientRequests:
    """Asks one client; nothing waits for what it answers."""

    def __init__(self, server: LanguageServer, documents: Documents, background: Background) -> None:
        """Take what speaks to the client, what knows what it can do, and where it is waited for."""
        self._server = server
        self._documents = documents
        self._background = background

    def watch_files(self) -> None:
        """Let it tell of files that change."""
        if self._documents.client.watches:
            watchers = [types.FileSystemWatcher(pattern) for pattern in _WATCHED]
            options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
            watching = types.Registration("watched", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
            asked = self._server.client_register_capability_async(types.RegistrationParams([watching]))
            self._background.begin(asked)

    def tell_settings(self, take: Callable[[Any], object]) -> None:
        """Let it tell its settings; what takes them is called if there are any."""
        if self._documents.client.configuration:
            self._background.begin(self._take_settings(take))

    def refresh(self, *names: str) -> None:
        """Let it ask again for what it has asked for before, of all texts: for these, or all that there is."""
        asking = {
            "diagnostics": self._server.workspace_diagnostic_refresh_async,
            "code_lens": self._server.workspace_code_lens_refresh_async,
            "inlay_hint": self._server.workspace_inlay_hint_refresh_async,
            "semantic_tokens": self._server.workspace_semantic_tokens_refresh_async,
        }
        for name, ask in asking.items():
            if name in self._documents.client.refreshed and (not names or name in names):
                self._background.begin(ask(None))

    async def _take_settings(self, take: Callable[[Any], object]) -> None:
        items = [types.ConfigurationItem(section=_SECTION)]
        found = await self._server.workspace_configuration_async(types.ConfigurationParams(items))
        if found and found[0] is not None:
            take(found[0])
