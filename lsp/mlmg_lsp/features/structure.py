"""What a text consists of: its outline, what can be folded and selected, small hints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from lsprotocol import types

from mlmg_lang.ide import folding, hints, selection, symbols
from mlmg_lang.source import Span
from mlmg_lsp.convert import offset_of, range_of, span_of
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.positions import position_from_offset

_SYMBOLS: Final[Mapping[symbols.Kind, types.SymbolKind]] = {
    symbols.Kind.DEFINITION: types.SymbolKind.Function,
    symbols.Kind.PARAMETER: types.SymbolKind.Variable,
    symbols.Kind.FILE: types.SymbolKind.Module,
    symbols.Kind.BLOCK: types.SymbolKind.Namespace,
    symbols.Kind.BRANCH: types.SymbolKind.Namespace,
    symbols.Kind.COMMAND: types.SymbolKind.Event,
}


def document_symbol(snapshot: Snapshot, _params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
    """Return the outline of a script."""
    return [_symbol(snapshot, one) for one in symbols.document_symbols(snapshot.analysis)]


def _symbol(snapshot: Snapshot, one: symbols.Symbol) -> types.DocumentSymbol:
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    return types.DocumentSymbol(
        name=one.name,
        kind=_SYMBOLS[one.kind],
        range=range_of(source, one.span, encoding),
        selection_range=range_of(source, one.selection, encoding),
        detail=one.detail or None,
        children=[_symbol(snapshot, child) for child in one.children],
    )


def folding_range(snapshot: Snapshot, _params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    """Return what of a script can be folded."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    comment = types.FoldingRangeKind.Comment
    return [
        types.FoldingRange(
            position_from_offset(source, one.span.start, encoding).line,
            position_from_offset(source, one.span.end, encoding).line,
            kind=comment if one.kind is folding.Kind.COMMENT else None,
        )
        for one in folding.folds(snapshot.analysis)
    ]


def selection_range(snapshot: Snapshot, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
    """Return ever larger stretches around some places."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    offsets = (offset_of(source, position, encoding) for position in params.positions)
    return [_nested(snapshot, selection.selection(snapshot.analysis, offset)) for offset in offsets]


def _nested(snapshot: Snapshot, spans: Iterable[Span]) -> types.SelectionRange:
    outer: types.SelectionRange | None = None
    for span in reversed(list(spans)):
        outer = types.SelectionRange(range_of(snapshot.analysis.source, span, snapshot.client.encoding), outer)
    assert outer is not None, "there is always the whole file"
    return outer


def inlay_hint(snapshot: Snapshot, params: types.InlayHintParams) -> list[types.InlayHint]:
    """Return the units and the names of parameters that are not written, in a stretch of a text."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    return [
        types.InlayHint(
            types.Position(*position_from_offset(source, one.offset, encoding)),
            one.label,
            kind=types.InlayHintKind.Parameter if one.kind is hints.Kind.PARAMETER else types.InlayHintKind.Type,
            tooltip=one.explanation or None,
            padding_left=not one.before,
            padding_right=one.before,
        )
        for one in hints.hints(snapshot.analysis, span_of(source, params.range, encoding))
    ]
