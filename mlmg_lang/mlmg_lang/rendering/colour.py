"""Colour on a terminal, and none elsewhere."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TextIO

from mlmg_lang.diagnostics import Severity

BLUE: Final = "34"
BOLD: Final = "1"
DIM: Final = "2"
GREEN: Final = "32"
SEVERITIES: Final[Mapping[Severity, str]] = MappingProxyType(
    {Severity.ERROR: "31", Severity.WARNING: "33", Severity.HINT: "36"}
)


@dataclass(frozen=True, slots=True)
class Painter:
    """Puts colour on text, or leaves it as it is."""

    on: bool

    def __call__(self, text: str, *styles: str) -> str:
        """Return a text in some styles, each the number of an ANSI escape."""
        return f"\x1b[{';'.join(styles)}m{text}\x1b[0m" if self.on and styles else text


def wants_colour(stream: TextIO) -> bool:
    """Return whether to colour what goes to a stream: only on a terminal, and never with `NO_COLOR`."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
