"""Values with places in a text -> the same values, where the text stands elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Final, TypeVar, cast

from mlmg_lang.source import Span

T = TypeVar("T")


def moved(value: T, place: Callable[[Span], Span]) -> T:
    """Return a value of frozen dataclasses and tuples with all its spans put elsewhere.

    Parameters
    ----------
    place : a span -> what it has become.
    """
    return cast("T", _moved(value, place))


def by(distance: int) -> Callable[[Span], Span]:
    """Return what moves every span by the same distance."""
    return lambda span: Span(span.start + distance, span.end + distance)  # it does so with many: `shifted` takes longer


def _moved(value: object, place: Callable[[Span], Span]) -> object:
    if isinstance(value, Span):
        return place(value)
    if isinstance(value, tuple):
        return tuple([_moved(part, place) for part in value])
    kind = type(value)
    names = _fields(cast("Hashable", kind))
    if not names:
        return value
    parts = [getattr(value, name) for name in names]
    return kind(*[part if type(part) in _PLAIN else _moved(part, place) for part in parts])


_PLAIN: Final = frozenset({str, int, float, bool, type(None)})
"""What most parts are, and has no place."""


@cache
def _fields(kind: Hashable) -> tuple[str, ...]:
    """Return the names of what a kind of value is made of; none if it is no dataclass."""
    return tuple(field.name for field in fields(kind)) if isinstance(kind, type) and is_dataclass(kind) else ()
