"""The runtime of Motion Script: clips, motion graphs, libraries, playing, BVH. It knows no language."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mlmg_runtime import bvh
    from mlmg_runtime.library import Library, open_library

__all__ = ["Library", "bvh", "open_library"]


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for: a command that reads no library starts without numpy."""
    if name == "bvh":
        return import_module("mlmg_runtime.bvh")
    if name in __all__:
        return getattr(import_module("mlmg_runtime.library"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
