"""The outline of a text."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from lsprotocol import types

from mlmg_lang.ide.symbols import Symbol, document_symbols
from mlmg_lsp.features.outline import document_symbol

PARAMS = types.DocumentSymbolParams(types.TextDocumentIdentifier("untitled:x"))


def plainly(one: Symbol, place: Callable[[int], dict[str, int]]) -> dict[str, Any]:
    """Return a symbol as it is told, but for its kind."""
    detail = {"detail": one.detail} if one.detail else {}
    spans = {"range": one.span, "selectionRange": one.selection}
    ranges = {name: {"start": place(span.start), "end": place(span.end)} for name, span in spans.items()}
    return {"name": one.name, **detail, **ranges, "children": [plainly(child, place) for child in one.children]}


def without_kinds(one: dict[str, Any]) -> dict[str, Any]:
    kept = {name: value for name, value in one.items() if name not in ("kind", "children")}
    return {**kept, "children": [without_kinds(child) for child in one["children"]]}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_after_any_edits_it_is_that_of_a_fresh_server(snapshots, afresh, position, encoding):
    for snapshot in snapshots(encoding, 40):
        text = snapshot.analysis.source.text
        wanted = [
            plainly(one, lambda offset, text=text: position(text, offset, encoding))
            for one in document_symbols(afresh(snapshot).analysis)
        ]
        assert [without_kinds(one) for one in json.loads(document_symbol(snapshot, PARAMS).text)] == wanted, text


def test_each_symbol_has_its_kind(snapshots):
    told = json.loads(document_symbol(next(snapshots("utf-16", 1)), PARAMS).text)
    assert [one["kind"] for one in told][:4] == [
        types.SymbolKind.Function,
        types.SymbolKind.Event,
        types.SymbolKind.Event,
        types.SymbolKind.Event,
    ]
