"""textDocument/documentSymbol: the outline of a text. What is found for a piece is kept from one answer to the next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate, pairwise
from operator import attrgetter
from typing import Final

from lsprotocol import types

from mlmg_lang.blocks import Statement
from mlmg_lang.ide import symbols
from mlmg_lang.source import Source, Span
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import Encoding, range_from_span
from mlmg_lsp.written import Json, Lined, Written, joined, lined

_KINDS: Final[Mapping[symbols.Kind, int]] = {
    symbols.Kind.DEFINITION: types.SymbolKind.Function.value,
    symbols.Kind.PARAMETER: types.SymbolKind.Variable.value,
    symbols.Kind.FILE: types.SymbolKind.Module.value,
    symbols.Kind.BLOCK: types.SymbolKind.Namespace.value,
    symbols.Kind.BRANCH: types.SymbolKind.Namespace.value,
    symbols.Kind.COMMAND: types.SymbolKind.Event.value,
}


@dataclass(frozen=True, slots=True)
class _Outlined:
    """What of an outline is in a piece; `n_lines`: how many lines end in it."""

    piece: Statement
    rows: Lined
    n_lines: int


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    _parts(snapshot)


def document_symbol(snapshot: Snapshot, _params: types.DocumentSymbolParams) -> Written:
    """Return the outline of a script."""
    parts = _parts(snapshot)
    lines = accumulate(map(attrgetter("n_lines"), parts), initial=0)
    return joined(zip(map(attrgetter("rows"), parts), lines, strict=False))


def _parts(snapshot: Snapshot) -> list[_Outlined]:
    kept = {id(one.piece): one for one in snapshot.kept.get("outline", ())}
    made, encoding = snapshot.analysis.made, snapshot.client.encoding
    pieces = zip(made.pieces, pairwise(made.places.starts), strict=True)
    parts = [kept.get(id(piece)) or _outlined(piece, made.source.text[slice(*at)], encoding) for piece, at in pieces]
    snapshot.kept["outline"] = parts
    return parts


def _outlined(piece: Statement, text: str, encoding: Encoding) -> _Outlined:
    source = Source(text)
    rows = lined([_row(one, source, encoding) for one in symbols.piece_symbols(piece, text)])
    return _Outlined(piece, rows, len(source.line_starts) - 1)


def _row(one: symbols.Symbol, source: Source, encoding: Encoding) -> Json:
    detail: dict[str, Json] = {"detail": one.detail} if one.detail else {}
    place = _range(source, one.span, encoding)
    selection = place if one.selection == one.span else _range(source, one.selection, encoding)
    children = [_row(child, source, encoding) for child in one.children]
    said = {"name": one.name, "kind": _KINDS[one.kind], **detail}
    return {**said, "range": place, "selectionRange": selection, "children": children}


def _range(source: Source, span: Span, encoding: Encoding) -> Json:
    start, end = range_from_span(source, span, encoding)
    return {"start": start._asdict(), "end": end._asdict()}
