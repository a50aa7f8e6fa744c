"""Diagnostics -> SARIF 2.1.0, the exchange format of tools that analyse code."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix, Severity
from mlmg_lang.rendering.paths import STDIN, relative
from mlmg_lang.rendering.wording import Checked, file_of
from mlmg_lang.source import Source, Span

_SCHEMA: Final = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS: Final[Mapping[Severity, str]] = MappingProxyType(
    {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.HINT: "note"}
)


def render_sarif(checked: Iterable[Checked]) -> str:
    """Return the diagnostics of several scripts as one log with one run."""
    import json

    found = [(source, one) for source, diagnostics in checked for one in diagnostics]
    codes = sorted({one.code for _, one in found})
    run = {
        "tool": {"driver": _driver(codes)},
        "columnKind": "unicodeCodePoints",
        "results": [_result(one, source, codes.index(one.code)) for source, one in found],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=1) + "\n"


def _driver(codes: Iterable[str]) -> dict[str, Any]:
    from importlib.metadata import version

    return {"name": "mlmg", "version": version("mlmg"), "rules": [_rule(code) for code in codes]}


def _rule(code: str) -> dict[str, Any]:
    from mlmg_lang.rules import read_rule

    rule, text = CODES[code], read_rule(code)
    return {
        "id": code,
        "shortDescription": {"text": rule.title},
        "fullDescription": {"text": text.meaning},
        "help": {"text": f"{text.meaning}\n\n{text.why}"},
        "defaultConfiguration": {"level": _LEVELS[rule.severity]},
    }


def _result(one: Diagnostic, source: Source, index: int) -> dict[str, Any]:
    result = {
        "ruleId": one.code,
        "ruleIndex": index,
        "level": _LEVELS[one.severity],
        "message": {"text": one.message + (f"\nhelp: {one.help}" if one.help else "")},
        "locations": [_location(source, one.span)],
    }
    if one.places:
        result["relatedLocations"] = [
            {"id": number, "message": {"text": label.message}, **_location(source, label.span)}
            for number, label in enumerate(one.places)
        ]
    if one.fixes:
        result["fixes"] = [_fix(fix, source) for fix in one.fixes]
    return result


def _fix(fix: Fix, source: Source) -> dict[str, Any]:
    replacement = {"deletedRegion": _region(source, fix.span), "insertedContent": {"text": fix.replacement}}
    change = {"artifactLocation": _artifact(file_of(source, fix.span)), "replacements": [replacement]}
    return {
        "description": {"text": fix.title},
        "artifactChanges": [change],
        "properties": {"applicability": fix.applicability},
    }


def _location(source: Source, span: Span | None) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": _artifact(file_of(source, span))}
    if span is not None:
        place["region"] = _region(source, span)
    return {"physicalLocation": place}


def _region(source: Source, span: Span) -> dict[str, int]:
    line, column, end_line, end_column = source.location(span)
    return {"startLine": line, "startColumn": column, "endLine": end_line, "endColumn": end_column}


def _artifact(file: Source) -> dict[str, str]:
    """Return where a file is: from the root of what is checked out, if it is below the current folder."""
    from urllib.parse import quote

    name = relative(file.name)
    if Path(name).is_absolute():
        return {"uri": Path(name).as_uri()}
    return {"uri": quote(name)} if name == STDIN else {"uri": quote(name), "uriBaseId": "%SRCROOT%"}
