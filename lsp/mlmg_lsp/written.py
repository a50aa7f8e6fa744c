"""Answers written out as JSON: large ones take far longer as objects of the protocol's types."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

Json: TypeAlias = "bool | int | float | str | Sequence[Json] | Mapping[str, Json] | None"


@dataclass(frozen=True, slots=True)
class Written:
    """An answer as it is sent."""

    text: str


def written(answer: Json) -> Written:
    """Return an answer as it is sent; nothing in it may contain itself."""
    return Written(json.dumps(answer, check_circular=False, separators=(",", ":")))
