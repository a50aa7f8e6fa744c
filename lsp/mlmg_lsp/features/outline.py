"""textDocument/documentSymbol: the outline of a text. What is found for a piece is kept from one answer to the next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, TypeAlias

from lsprotocol import types

from mlmg_lang.blocks import Statement
from mlmg_lang.ide import symbols
from mlmg_lang.source import Source, Span
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.positions import Encoding, range_from_span
from mlmg_lsp.written import Json, Written, written

_KINDS: Final[Mapping[symbols.Kind, int]] = {
    symbols.Kind.DEFINITION: types.SymbolKind.Function.value,
    symbols.Kind.PARAMETER: types.SymbolKind.Variable.value,
    symbols.Kind.FILE: types.SymbolKind.Module.value,
    symbols.Kind.BLOCK: types.SymbolKind.Namespace.value,
    symbols.Kind.BRANCH: types.SymbolKind.Namespace.value,
    symbols.Kind.COMMAND: types.SymbolKind.Event.value,
}
_Range: TypeAlias = tuple[int, int, int, int]
"""Line and character of the beginning, then of the end; pieces begin at the beginning of a line."""


@dataclass(frozen=True, slots=True)
class _Row:
    """A symbol; its lines count from the first of its piece. `says`: its name, its kind and what else is told of it."""

    says: Mapping[str, Json]
    place: _Range
    selection: _Range
    children: tuple[_Row, ...]


@dataclass(frozen=True, slots=True)
class _Outlined:
    """What of an outline is in a piece; `n_lines`: how many lines end in it."""

    piece: Statement
    rows: tuple[_Row, ...]
    n_lines: int


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    _parts(snapshot)


def document_symbol(snapshot: Snapshot, _params: types.DocumentSymbolParams) -> Written:
    """Return the outline of a script."""
    line, found = 0, list[Json]()
    for part in _parts(snapshot):
        found += [_symbol(row, line) for row in part.rows]
        line += part.n_lines
    return written(found)


def _parts(snapshot: Snapshot) -> list[_Outlined]:
    kept = {id(one.piece): one for one in snapshot.kept.get("outline", ())}
    made, encoding = snapshot.analysis.made, snapshot.client.encoding
    pieces = zip(made.pieces, pairwise(made.places.starts), strict=True)
    parts = [kept.get(id(piece)) or _outlined(piece, made.source.text[slice(*at)], encoding) for piece, at in pieces]
    snapshot.kept["outline"] = parts
    return parts


def _outlined(piece: Statement, text: str, encoding: Encoding) -> _Outlined:
    source = Source(text)
    rows = tuple(_row(one, source, encoding) for one in symbols.piece_symbols(piece, text))
    return _Outlined(piece, rows, len(source.line_starts) - 1)


def _row(one: symbols.Symbol, source: Source, encoding: Encoding) -> _Row:
    detail: dict[str, Json] = {"detail": one.detail} if one.detail else {}
    place, selection = (_range(source, span, encoding) for span in (one.span, one.selection))
    children = tuple(_row(child, source, encoding) for child in one.children)
    return _Row({"name": one.name, "kind": _KINDS[one.kind], **detail}, place, selection, children)


def _range(source: Source, span: Span, encoding: Encoding) -> _Range:
    start, end = range_from_span(source, span, encoding)
    return (*start, *end)


def _symbol(row: _Row, line: int) -> Json:
    place = _told(row.place, line)
    selection = place if row.selection == row.place else _told(row.selection, line)
    children = [_symbol(child, line) for child in row.children]
    return {**row.says, "range": place, "selectionRange": selection, "children": children}


def _told(place: _Range, line: int) -> Json:
    first, start, last, end = place
    return {
        "start": {"line": first + line, "character": start},
        "end": {"line": last + line, "character": end},
    }
