"""An explanation -> JSON, and back. What is in it says `plan.schema.json`, in this folder."""

from __future__ import annotations

import types
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.planning.estimate import Estimate

VERSION: Final = 1
"""Of the format; it changes when something in it gets another meaning or goes away."""


def plan_to_json(explanation: Explanation) -> str:
    """Return an explanation as JSON text; equal explanations give equal text."""
    import json

    return json.dumps(plan_data(explanation), ensure_ascii=False, indent=1) + "\n"


def plan_data(explanation: Explanation) -> dict[str, Any]:
    """Return an explanation as what JSON is made of."""
    return {"version": VERSION, **_plain(explanation)}


def plan_from_json(text: str) -> Explanation:
    """Return the explanation that `plan_to_json` made a text of.

    Raises
    ------
    ValueError
        If the text is not JSON, of another version, or lacks something; with what was found and expected.
    """
    import json

    value = json.loads(text)
    if not isinstance(value, dict) or value.get("version") != VERSION:
        found = value.get("version") if isinstance(value, dict) else value
        raise ValueError(f"expected a plan of version {VERSION}, found {found!r}")
    explanation = _read(Explanation, {key: one for key, one in value.items() if key != "version"}, "plan")
    assert isinstance(explanation, Explanation)
    return explanation


def _plain(value: Any) -> Any:
    """Return frozen dataclasses and tuples as dictionaries and lists; estimates as lists of three numbers."""
    if isinstance(value, Estimate):
        return [value.mean, value.least, value.most]
    if is_dataclass(value):
        named = [one.name for one in fields(value)]
        order = sorted(named, key=lambda name: name != "kind")
        return {name: _plain(getattr(value, name)) for name in order}
    return [_plain(one) for one in value] if isinstance(value, tuple) else value


@cache
def _hints(made: type) -> dict[str, Any]:
    return get_type_hints(made)


def _read(hint: Any, value: Any, where: str) -> Any:
    """Return a value of a type from plain JSON data."""
    if hint is Estimate:
        return Estimate(*_many([float] * 3, value, where))
    if isinstance(hint, type) and is_dataclass(hint):
        return _object(hint, _checked(dict, value, where), where)
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return _either(inner, value, where)
    if origin is tuple:
        if inner[-1] is Ellipsis:
            inner = (inner[0],) * len(_checked(list, value, where))
        return _many(inner, value, where)
    if hint is float:
        return float(_checked((int, float), value, where))
    return _checked(hint, value, where)


def _many(hints: Sequence[Any], value: Any, where: str) -> tuple[Any, ...]:
    """Return values of some types from a list of as many."""
    many = _checked(list, value, where)
    if len(many) != len(hints):
        raise ValueError(f"{where}: expected {len(hints)} values, found {len(many)}")
    return tuple(_read(hint, one, f"{where}[{at}]") for at, (hint, one) in enumerate(zip(hints, many, strict=True)))


def _either(hints: tuple[Any, ...], value: Any, where: str) -> Any:
    """Return a value of one of several types, told apart by `kind`."""
    if value is None and types.NoneType in hints:
        return None
    known = [one for one in hints if one is not types.NoneType]
    if len(known) == 1:
        return _read(known[0], value, where)
    kind = _checked(dict, value, where).get("kind")
    by = {get_args(_hints(one)["kind"])[0]: one for one in known}
    if kind not in by:
        raise ValueError(f"{where}: expected a kind among {', '.join(by)}, found {kind!r}")
    return _read(by[kind], value, where)


def _object(made: type, value: dict[str, Any], where: str) -> Any:
    hints = _hints(made)
    given = {name: hint for name, hint in hints.items() if get_origin(hint) is not Literal}
    missing = [name for name in given if name not in value]
    if missing:
        raise ValueError(f"{where}: {', '.join(missing)} missing")
    return made(**{name: _read(hint, value[name], f"{where}.{name}") for name, hint in given.items()})


def _checked(expected: Any, value: Any, where: str) -> Any:
    if not isinstance(value, expected) or isinstance(value, bool) is not (expected is bool):
        raise ValueError(f"{where}: expected {expected}, found {value!r}")
    return value
