"""Answers written out as JSON: large ones take far longer as objects of the protocol's types."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

Json: TypeAlias = "bool | int | float | str | Sequence[Json] | Mapping[str, Json] | None"


@dataclass(frozen=True, slots=True)
class Written:
    """An answer as it is sent."""

    text: str


def written(answer: Json) -> Written:
    """Return an answer as it is sent; nothing in it may contain itself."""
    return Written(_dumped(answer))


@dataclass(frozen=True, slots=True)
class Lined:
    """Some of a list of answers as it is sent, but for where it stands: its lines count from one not known yet.

    Attributes
    ----------
    parts : what stands between the numbers of lines. lines : these; none if all are 0.
    """

    parts: Sequence[str]
    lines: Sequence[int]

    def at(self, line: int) -> str:
        """Return it as it is sent where it stands at a line."""
        if not self.lines:
            return str(line).join(self.parts)
        numbers = (str(one + line) for one in self.lines)
        return "".join(part for pair in zip(self.parts, (*numbers, ""), strict=True) for part in pair)


NO_ANSWER: Final = Lined(("",), ())
_LINE: Final = re.compile(r'(?<="line":)(\d+)')
"""In a string each quote is behind a backslash, so that what looks like this is always the number of a line."""


def lined(answers: Sequence[Json]) -> Lined:
    """Return some of a list of answers as it is sent, but for where it stands."""
    if not answers:
        return NO_ANSWER
    parts = _LINE.split(_dumped(answers)[1:-1])
    lines = tuple(map(int, parts[1::2]))
    return Lined(tuple(parts[::2]), lines if any(lines) else ())


def joined(found: Iterable[tuple[Lined, int]]) -> Written:
    """Return a list of answers as it is sent, put together of such parts and the lines that they stand at."""
    return Written(f"[{','.join([part.at(line) for part, line in found if part is not NO_ANSWER])}]")


def _dumped(answer: Json) -> str:
    return json.dumps(answer, check_circular=False, separators=(",", ":"))
