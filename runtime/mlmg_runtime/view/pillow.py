"""Whether Pillow, which only pictures need, is there."""

from __future__ import annotations

from importlib.util import find_spec

from mlmg_runtime.errors import MlmgError


class PillowMissingError(MlmgError):
    """Pictures were asked for, and the library that writes them is not installed."""


def need_pillow() -> None:
    """Raise `PillowMissingError`, which says how to install it, unless Pillow is there."""
    if find_spec("PIL") is None:
        raise PillowMissingError('PNG and GIF need Pillow: pip install "mlmg[view]"')
