"""What all formats say alike: what a diagnostic is called, and where it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeAlias

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering.cells import UNSEEN, is_unsafe
from mlmg_lang.source import Source, Span

Checked: TypeAlias = tuple[Source, Sequence[Diagnostic]]
"""A script with what is to be said of it."""
_LONGEST_MESSAGE: Final = 600


def head(one: Diagnostic) -> str:
    """Return the severity and the code: `error[MS021]`."""
    return f"{one.severity.value}[{one.code}]"


def place(source: Source, span: Span | None) -> str:
    """Return where something is: `stroll.ms:3:1`."""
    if span is None:
        return safe(source.name)
    file, _ = source.file(span.start)
    line, column = source.position(span.start)
    return f"{safe(file.name)}:{line}:{column}"


def file_of(source: Source, span: Span | None) -> Source:
    """Return the file that a span is in: the script, or one that it uses."""
    return source if span is None else source.file(span.start)[0]


def safe(text: str) -> str:
    """Return a message, which may quote the script, without what a terminal could act on, and not too long."""
    if len(text) > _LONGEST_MESSAGE:
        text = f"{text[: _LONGEST_MESSAGE // 2]} … {text[-_LONGEST_MESSAGE // 2 :]}"
    return harmless(text)


def harmless(text: str) -> str:
    """Return a text, of one line, without what a terminal could act on."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(UNSEEN if is_unsafe(one) and one not in "\u200c\u200d" else one for one in text)
