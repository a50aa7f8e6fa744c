"""Diagnostics -> workflow commands, which GitHub shows beside the lines of a change."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Final

from mlmg_lang.diagnostics import CODES, Diagnostic, Severity
from mlmg_lang.rendering.paths import relative
from mlmg_lang.rendering.wording import Checked, file_of, safe
from mlmg_lang.source import Source

_COMMANDS: Final[Mapping[Severity, str]] = MappingProxyType(
    {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.HINT: "notice"}
)


def render_github(checked: Iterable[Checked]) -> str:
    """Return diagnostics one a line: `::error file=stroll.ms,line=3,endLine=3,col=1,endColumn=5,title=...::...`."""
    return "".join(f"{_command(one, source)}\n" for source, diagnostics in checked for one in diagnostics)


def _command(one: Diagnostic, source: Source) -> str:
    properties = {"file": relative(file_of(source, one.span).name), **_where(one, source)}
    properties["title"] = f"{one.code}: {CODES[one.code].title}"
    told = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items())
    message = safe(one.message) + (f"\nhelp: {safe(one.help)}" if one.help else "")
    return f"::{_COMMANDS[one.severity]} {told}::{_data(message)}"


def _where(one: Diagnostic, source: Source) -> dict[str, object]:
    """Return the place; columns may be given only where a place is within one line."""
    if one.span is None:
        return {}
    line, column, end_line, end_column = source.location(one.span)
    if line != end_line:
        return {"line": line, "endLine": end_line}
    return {"line": line, "endLine": end_line, "col": column, "endColumn": end_column}


def _data(text: str) -> str:
    """Return the message of a command as it has to be written."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    """Return the value of a property as it has to be written."""
    return _data(text).replace(":", "%3A").replace(",", "%2C")
