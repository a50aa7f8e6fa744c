"""Diagnostics -> a JSON list for other programs (docs/diagnostics.md says what is in it)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering.wording import Checked, file_of
from mlmg_lang.source import Source, Span


def render_json(checked: Iterable[Checked]) -> str:
    """Return the diagnostics of several scripts as one JSON list, an entry a line."""
    import json

    entries = [json.dumps(entry) for source, diagnostics in checked for entry in entries_of(source, diagnostics)]
    return "[" + ",".join(f"\n {entry}" for entry in entries) + ("\n]\n" if entries else "]\n")


def entries_of(source: Source, diagnostics: Iterable[Diagnostic]) -> list[dict[str, Any]]:
    """Return the entries of the diagnostics of one text."""
    return [_entry(one, source) for one in diagnostics]


def _entry(one: Diagnostic, source: Source) -> dict[str, Any]:
    return {
        "file": file_of(source, one.span).name,
        "code": one.code,
        "severity": one.severity.value,
        "span": _location(source, one.span),
        "message": one.message,
        "help": one.help,
        "labels": [_elsewhere(source, label.span, label.message) for label in one.labels],
        "notes": [_elsewhere(source, note.span, note.message) for note in one.notes],
        "fixes": [
            {
                "title": fix.title,
                "span": _location(source, fix.span),
                "replacement": fix.replacement,
                "applicability": fix.applicability,
            }
            for fix in one.fixes
        ],
    }


def _elsewhere(source: Source, span: Span | None, message: str) -> dict[str, Any]:
    file = None if span is None else file_of(source, span).name
    return {"file": file, "span": _location(source, span), "message": message}


def _location(source: Source, span: Span | None) -> list[int] | None:
    return None if span is None else list(source.location(span))
