"""What of a text can be folded and selected."""

from __future__ import annotations

from collections.abc import Iterable

from lsprotocol import types

from mlmg_lang.ide import folding, selection
from mlmg_lang.source import Span
from mlmg_lsp.convert import offset_of, range_of
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import position_from_offset


def folding_range(snapshot: Snapshot, _params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    """Return what of a script can be folded."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    comment = types.FoldingRangeKind.Comment
    return [
        types.FoldingRange(
            position_from_offset(source, one.span.start, encoding).line,
            position_from_offset(source, one.span.end, encoding).line,
            kind=comment if one.is_comment else None,
        )
        for one in folding.folds(snapshot.analysis, snapshot.client.folds_lines)
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
