"""Whether the process of a client is still there; one that has crashed says nothing, and may leave its pipes open."""

from __future__ import annotations

import asyncio
import os
import sys
from typing import Final

_LOOKED_FOR_S: Final = 3.0
"""So often it is looked whether it is still there."""


async def watch(process: int, ended: asyncio.Event) -> None:
    """Set `ended` when a process is no longer there; on Windows, where that cannot be asked like this, never."""
    while sys.platform != "win32" and not ended.is_set():
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            ended.set()
        except PermissionError:
            pass  # it is there, and another user's
        await asyncio.sleep(_LOOKED_FOR_S)
