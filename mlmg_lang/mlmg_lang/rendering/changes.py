"""Two versions of a script -> their difference, for a person and for `patch`."""

from __future__ import annotations

from mlmg_lang.rendering.colour import Painter
from mlmg_lang.source import Source


def render_changes(before: Source, after: Source, colour: bool = False) -> str:
    """Return the unified difference of two texts; nothing if they are the same."""
    from difflib import unified_diff

    paint = Painter(colour)
    lines = unified_diff(_lines(before.text), _lines(after.text), before.name, after.name)
    return "".join(_drawn(line, paint) for line in lines)


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their ends; `patch` knows no line end but LF."""
    lines = text.split("\n")
    return [f"{line}\n" for line in lines[:-1]] + [line for line in lines[-1:] if line]


def _drawn(line: str, paint: Painter) -> str:
    styles = {"-": ("31",), "+": ("32",), "@": ("36",)}.get(line[0], ())
    if line.endswith("\n"):
        return f"{paint(line[:-1], *styles)}\n"
    return f"{paint(line, *styles)}\n\\ No newline at end of file\n"
