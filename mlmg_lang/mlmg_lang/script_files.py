"""A file, or standard input -> a source, or why its bytes are no text."""

from __future__ import annotations

import sys
from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.source import Source, Span


def read_script(path: str | Path) -> tuple[Source, tuple[Diagnostic, ...]]:
    """Return the text of a script, and a diagnostic if it is not UTF-8; then the text is not to be analysed.

    Parameters
    ----------
    path : of a file; `-` reads standard input. A byte order mark is left out.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    if str(path) == "-":
        return source_from_bytes(sys.stdin.buffer.read(), "<stdin>")
    return source_from_bytes(Path(path).read_bytes(), str(path))


def source_from_bytes(data: bytes, name: str) -> tuple[Source, tuple[Diagnostic, ...]]:
    """Return the text of some bytes, and a diagnostic if they are not UTF-8."""
    body = data.removeprefix(BOM_UTF8)
    try:
        return Source(body.decode("utf-8"), name), ()
    except UnicodeDecodeError as error:
        at = len(body[: error.start].decode("utf-8"))
        return Source(body.decode("utf-8", errors="replace"), name), (_not_utf8(body, error.start, at),)


def _not_utf8(data: bytes, first: int, at: int) -> Diagnostic:
    message = f"this file is not UTF-8: byte 0x{data[first]:02X} cannot stand here"
    utf16 = data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))
    advice = "it looks like UTF-16; save it as UTF-8" if utf16 else "save it as UTF-8"
    return Diagnostic("MS001", message, Span(at, at + 1), advice)
