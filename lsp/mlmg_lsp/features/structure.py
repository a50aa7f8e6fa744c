"""What a text consists of: its outline, what can be folded and selected, what each word is, small hints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from lsprotocol import types

from mlmg_lang.ide import folding, hints, selection, semantics, symbols
from mlmg_lang.source import Source, Span
from mlmg_lsp.convert import offset_of, range_of, span_of
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.features import DECLARATION, TOKEN_TYPES
from mlmg_lsp.positions import EditorPosition, Encoding, position_from_offset, units_in

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


# --- what each word is ---


def semantic_tokens(snapshot: Snapshot, _params: types.SemanticTokensParams) -> types.SemanticTokens:
    """Return what each word of a script is."""
    marks = _painting(snapshot).marks()
    return types.SemanticTokens(list(_encoded(snapshot.analysis.source, marks, snapshot.client.encoding)))


def semantic_tokens_range(snapshot: Snapshot, params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
    """Return what each word in a stretch of a script is."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    within = span_of(source, params.range, encoding)
    marks = (
        mark for mark in _painting(snapshot).marks() if mark.span.end > within.start and mark.span.start < within.end
    )
    return types.SemanticTokens(list(_encoded(source, marks, encoding)))


def _painting(snapshot: Snapshot) -> semantics.Painting:
    """Return the marks of a text; what an edit has left alone is taken from the last."""
    painting = semantics.paint(snapshot.analysis, snapshot.kept.get("painting"))
    snapshot.kept["painting"] = painting
    return painting


def _encoded(source: Source, marks: Iterable[semantics.Mark], encoding: Encoding) -> Iterator[int]:
    """Yield five numbers for each mark, counted from the one before it, as the protocol has it."""
    starts, line, before = (*source.line_starts, len(source.text) + 1), 0, EditorPosition(0, 0)
    plain = source.text.isascii()
    for mark in marks:
        while starts[line + 1] <= mark.span.start:
            line += 1
        lead, word = source.text[starts[line] : mark.span.start], source.text[mark.span.start : mark.span.end]
        character = len(lead) if plain else units_in(lead, encoding)
        yield line - before.line
        yield character - before.character if line == before.line else character
        yield len(word) if plain else units_in(word, encoding)
        yield TOKEN_TYPES.index(mark.kind.value)
        yield DECLARATION if mark.declaration else 0
        before = EditorPosition(line, character)
