"""Durations: what the units are called, and how long they last."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from mlmg_lang.parsing.syntax import Quantity

UNITS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "sec": "sec",
        "s": "sec",
        "second": "sec",
        "seconds": "sec",
        "ms": "ms",
        "min": "min",
        "minute": "min",
        "minutes": "min",
        "frames": "frames",
        "frame": "frames",
        "cycles": "cycles",
        "cycle": "cycles",
    }
)
"""Every accepted spelling of a unit, with the one that it is formatted to."""

SECONDS: Final[Mapping[str, float]] = MappingProxyType({"sec": 1.0, "ms": 0.001, "min": 60.0})


def unit_of(quantity: Quantity) -> str:
    """Return the unit of a quantity in its one spelling."""
    return UNITS[quantity.unit]


def seconds_from_quantity(quantity: Quantity, frame_rate: float | None) -> float | None:
    """Return how long a quantity lasts in seconds, infinite if it is too large for a number.

    None for cycles, whose length depends on the motion, and for frames where the frame rate is not known.
    """
    unit = unit_of(quantity)
    if unit in SECONDS:
        return float(quantity.number) * SECONDS[unit]
    if unit == "frames" and frame_rate is not None:
        return float(quantity.number) / frame_rate
    return None


def spelled(seconds: float) -> str:
    """Return a number of seconds as digits that the language can read, without needless zeros."""
    return f"{seconds:.6f}".rstrip("0").rstrip(".")
