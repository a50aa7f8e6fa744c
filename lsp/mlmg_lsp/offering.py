"""What is offered to a person whose scripts have no library: the demo library, by an `mlmg.toml` that names it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from mlmg_lang.libraries import DEMO, SETTINGS
from mlmg_lsp.work import off_loop

_USE_DEMO: Final = "Use the demo library"


async def offer_demo(server: LanguageServer, message: str, folder: Path) -> bool:
    """Say that there is no library, with a button for the demo library; return whether a folder has that now.

    Raises
    ------
    OSError
        If the file cannot be written, or is there by now.
    """
    actions = [types.MessageActionItem(_USE_DEMO)]
    params = types.ShowMessageRequestParams(types.MessageType.Info, message, actions)
    answer = await server.window_show_message_request_async(params)
    if answer is None or answer.title != _USE_DEMO:
        return False
    await off_loop(lambda: _name_demo(folder / SETTINGS))
    return True


def _name_demo(path: Path) -> None:
    with path.open("x", encoding="utf-8") as settings:
        settings.write(f'library = "{DEMO}"\n')
