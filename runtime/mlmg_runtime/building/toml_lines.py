"""On which line of a TOML file each table and key stands, so that an error can say so."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TypeAlias

KeyPath: TypeAlias = tuple[str | int, ...]

_HEADER = re.compile(r"\s*(\[\[?)(.*?)\]\]?\s*(?:#.*)?$")
_KEY = re.compile(r"""\s*((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*=""")
# What says whether a line goes on with the value of the last: strings, which may hold anything, and brackets.
_TOKEN = re.compile(
    r"""
    "{3} (?: \\. | [^\\] )*? "{3,5} | '{3} .*? '{3,5}     # over several lines
    | " (?: \\. | [^"\\\n] )* " | ' [^'\n]* '
    | \# [^\n]* | [\[\]{}] | \n
    """,
    re.DOTALL | re.VERBOSE,
)
_PART = re.compile(r"""[^\s."']+|"([^"]*)"|'([^']*)'""")


def key_lines(text: str) -> Mapping[KeyPath, int]:
    """Return the line, from 1, of each table and key of a valid TOML text.

    Paths are as the parsed document nests: `("graph", 1, "window")` is the key of the second `[[graph]]`.
    """
    lines: dict[KeyPath, int] = {}
    counts: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for number, line in _first_lines(text):
        if header := _HEADER.match(line):
            name = _parts(header[2])
            table = _inside_arrays(name, counts)
            if header[1] == "[[":
                counts[name] = counts.get(name, 0) + 1
                table = (*name, counts[name] - 1)
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            lines.setdefault((*table, *_parts(key[1])), number)
    return lines


def _first_lines(text: str) -> Iterator[tuple[int, str]]:
    """Yield, with their numbers, the lines that do not go on with a value begun on another."""
    depth, number, firsts = 0, 1, {1}
    for token in _TOKEN.findall(text):
        number += token.count("\n")
        if token in ("[", "{"):
            depth += 1
        elif token in ("]", "}"):
            depth -= 1
        elif token == "\n" and depth == 0:
            firsts.add(number)
    return ((at, line) for at, line in enumerate(text.split("\n"), start=1) if at in firsts)


def _parts(dotted: str) -> KeyPath:
    return tuple(match[1] or match[2] or match[0] for match in _PART.finditer(dotted))


def _inside_arrays(name: KeyPath, counts: Mapping[KeyPath, int]) -> KeyPath:
    """Return the path of a table that may lie inside the last element of an array of tables."""
    for length in range(len(name), 0, -1):
        if name[:length] in counts:
            return (*name[:length], counts[name[:length]] - 1, *name[length:])
    return name
