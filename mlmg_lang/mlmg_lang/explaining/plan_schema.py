"""The explanation's dataclasses -> the JSON Schema of `plan_to_json`; what is said there are their docstrings."""

from __future__ import annotations

import re
import types
from dataclasses import is_dataclass
from inspect import cleandoc
from typing import Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.explaining.plan_json import VERSION
from mlmg_lang.planning.estimate import Estimate

_SIMPLE: Final = {str: "string", int: "integer", float: "number", bool: "boolean", types.NoneType: "null"}
_ATTRIBUTE: Final = re.compile(r"(?:^|(?<=\. ))(\w+(?:, \w+)*) : ")


def plan_schema() -> dict[str, Any]:
    """Return the schema, as JSON data."""
    definitions: dict[str, Any] = {}
    whole = _object(Explanation, definitions)
    whole["properties"] = {"version": {"const": VERSION, "description": "of this format"}, **whole["properties"]}
    whole["required"] = ["version", *whole["required"]]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "What `mlmg explain --format json` prints",
        **whole,
        "$defs": dict(sorted(definitions.items())),
    }


def _object(made: type, definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a dataclass; those of others in it go to `definitions`."""
    said, attributes = _docstring(made)
    hints = get_type_hints(made)
    properties = {}
    for name, hint in sorted(hints.items(), key=lambda one: one[0] != "kind"):
        properties[name] = _schema(hint, definitions)
        if name in attributes:
            properties[name] = {**properties[name], "description": attributes[name]}
    return {
        "description": said,
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _schema(hint: Any, definitions: dict[str, Any]) -> dict[str, Any]:
    if isinstance(hint, type) and is_dataclass(hint):
        return _reference(hint, definitions)
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Literal:
        return {"const": inner[0]}
    if origin in (Union, types.UnionType):
        return {"anyOf": [_schema(one, definitions) for one in inner]}
    if origin is not tuple:
        return {"type": _SIMPLE[hint]}
    if inner[-1] is Ellipsis:
        return {"type": "array", "items": _schema(inner[0], definitions)}
    parts = [_schema(one, definitions) for one in inner]
    return {"type": "array", "prefixItems": parts, "items": False, "minItems": len(parts), "maxItems": len(parts)}


def _reference(made: type, definitions: dict[str, Any]) -> dict[str, Any]:
    """Return a reference to a dataclass, whose schema goes to `definitions`."""
    name = made.__name__
    if made is Estimate:
        numbers = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
        definitions[name] = {"description": "Seconds: on average, at the least, at the most.", **numbers}
    elif name not in definitions:
        # The name is taken before its parts are looked at, which may have it in them again.
        definitions[name] = {}
        definitions[name] = _object(made, definitions)
    return {"$ref": f"#/$defs/{name}"}


def _docstring(made: type) -> tuple[str, dict[str, str]]:
    """Return what a docstring says of a class, and of its attributes by name."""
    said, _, table = cleandoc(made.__doc__ or "").partition("Attributes\n----------\n")
    attributes = {}
    # A description goes on in lines that are set in.
    for line in re.sub(r"\n\s+", " ", table).splitlines():
        found = list(_ATTRIBUTE.finditer(line))
        ends = [other.start() for other in found[1:]] + [len(line)]
        for match, end in zip(found, ends, strict=True):
            attributes.update(dict.fromkeys(match[1].split(", "), line[match.end() : end].strip().rstrip(".")))
    return " ".join(said.split()), attributes
