"""Diagnostics -> text for a person (drawn below the line, or one line each) and JSON for programs."""

from __future__ import annotations

import json
import os
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final, TextIO

from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.source import Source, Span

_TAB = 4
_LONGEST = 120
"""The longest stretch of a line that is drawn, in characters."""
_LONGEST_MESSAGE = 600
_COLOURS: Final[Mapping[Severity, str]] = MappingProxyType(
    {Severity.ERROR: "31", Severity.WARNING: "33", Severity.HINT: "36"}
)
_BLUE, _BOLD = "34", "1"


def render_full(diagnostics: Iterable[Diagnostic], source: Source, colour: bool = False) -> str:
    """Return diagnostics with their lines drawn and underlined, an empty line between them."""
    painter = _Painter(colour)
    return "\n".join("\n".join(_drawn(one, source, painter)) + "\n" for one in diagnostics)


def render_concise(diagnostics: Iterable[Diagnostic], source: Source) -> str:
    """Return diagnostics one a line: `file:line:column: error[MS021]: message`."""
    return "".join(f"{_place(source, one.span)}: {_head(one)}: {_safe(one.message)}\n" for one in diagnostics)


def render_json(analysed: Iterable[tuple[Source, Iterable[Diagnostic]]]) -> str:
    """Return the diagnostics of several scripts as one JSON list."""
    entries = [_entry(one, source) for source, diagnostics in analysed for one in diagnostics]
    return "[" + ",".join(f"\n {json.dumps(entry)}" for entry in entries) + ("\n]\n" if entries else "]\n")


def _entry(one: Diagnostic, source: Source) -> dict[str, Any]:
    return {
        "file": source.name,
        "code": one.code,
        "severity": one.severity.value,
        "span": _location(source, one.span),
        "message": one.message,
        "help": one.help,
        "notes": [{"message": note.message, "span": _location(source, note.span)} for note in one.notes],
        "fixes": [
            {
                "span": _location(source, fix.span),
                "replacement": fix.replacement,
                "applicability": fix.applicability,
            }
            for fix in one.fixes
        ],
    }


def _location(source: Source, span: Span | None) -> list[int] | None:
    return None if span is None else list(source.location(span))


def _head(one: Diagnostic) -> str:
    return f"{one.severity.value}[{one.code}]"


def _place(source: Source, span: Span | None) -> str:
    if span is None:
        return source.name
    line, column = source.position(span.start)
    return f"{source.name}:{line}:{column}"


# --- the drawing -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Painter:
    """Puts colour on text, or leaves it as it is."""

    on: bool

    def __call__(self, text: str, *styles: str) -> str:
        return f"\x1b[{';'.join(styles)}m{text}\x1b[0m" if self.on else text


def _drawn(one: Diagnostic, source: Source, paint: _Painter) -> Iterator[str]:
    """Yield the lines of one diagnostic."""
    colour = _COLOURS[one.severity]
    yield f"{paint(_head(one), _BOLD, colour)}{paint(f': {_safe(one.message)}', _BOLD)}"
    number = "" if one.span is None else str(source.position(one.span.start)[0])
    edge = " " * (len(number) + 2)
    yield f"{edge[1:]}{paint('-->', _BLUE)} {_place(source, one.span)}"
    if one.span is not None:
        text, before, under = _line_drawn(source, one.span)
        yield f"{edge}{paint('|', _BLUE)}"
        yield f" {paint(f'{number} |', _BLUE)} {text}".rstrip()
        yield f"{edge}{paint('|', _BLUE)} {' ' * before}{paint('^' * under, _BOLD, colour)}"
    for note in one.notes:
        place = "" if note.span is None else f" ({_place(source, note.span)})"
        yield f"{edge}{paint('=', _BLUE)} note: {_safe(note.message)}{place}"
    if one.help is not None:
        yield f"{edge}{paint('=', _BLUE)} help: {_safe(one.help)}"


def _line_drawn(source: Source, span: Span) -> tuple[str, int, int]:
    """Return the line in which a span begins, how many columns stand before it and how many it takes.

    A span of no length is drawn one column wide, one that goes on in other lines to the end of its first. Of a
    long line only what is around the span is drawn.
    """
    begin, end = _line_span(source, source.position(span.start)[0])
    first = begin if end - begin <= _LONGEST else max(begin, span.start - _LONGEST // 4)
    last = min(end, first + _LONGEST)
    lead, tail = ("…" if first > begin else ""), ("…" if last < end else "")
    cells = list(_cells(source.text[first:last]))
    before = sum(width for _, width in cells[: span.start - first])
    under = sum(width for _, width in cells[span.start - first : span.end - first])
    return lead + "".join(text for text, _ in cells) + tail, len(lead) + before, max(1, under)


def _line_span(source: Source, row: int) -> tuple[int, int]:
    """Return where a line begins and ends, without its line end."""
    starts = source.line_starts
    begin = starts[row - 1]
    end = starts[row] if row < len(starts) else len(source.text)
    while end > begin and source.text[end - 1] in "\r\n":
        end -= 1
    return begin, end


def _cells(line: str) -> Iterator[tuple[str, int]]:
    """Yield what is drawn for each character of a line, and how many columns of a terminal it takes."""
    column, joined = 0, False
    for character in line:
        if character == "\t":
            text, width = " " * (_TAB - column % _TAB), _TAB - column % _TAB
        elif _is_unsafe(character):
            text, width = "\ufffd", 1
        else:
            text, width = character, 0 if joined else _width(character)
        joined = character == "\u200d"
        column += width
        yield text, width


def _width(character: str) -> int:
    """Return how many columns a printable character takes."""
    point = ord(character)
    if unicodedata.category(character) in ("Mn", "Me", "Cf") or 0x1F3FB <= point <= 0x1F3FF:
        return int(point == 0xFE0F)  # the sign that makes a symbol an emoji makes it two columns wide
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def _is_unsafe(character: str) -> bool:
    """Return whether a terminal could act on a character, or turn the order of the line about."""
    return unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp") or (
        "\u202a" <= character <= "\u202e" or "\u2066" <= character <= "\u2069"
    )


def _safe(text: str) -> str:
    """Return a message, which may quote the script, without what a terminal could act on, and not too long."""
    if len(text) > _LONGEST_MESSAGE:
        text = f"{text[: _LONGEST_MESSAGE // 2]} … {text[-_LONGEST_MESSAGE // 2 :]}"
    return "".join("\ufffd" if _is_unsafe(character) else character for character in text)


def wants_colour(stream: TextIO) -> bool:
    """Return whether to colour what goes to a stream: only on a terminal, and never with `NO_COLOR`."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
