"""textDocument/inlayHint: what is taken, when it arrives, and what is meant by what is written.

What is found for a piece is kept from one answer to the next, as long as its commands go the same way.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass

from lsprotocol import types

from mlmg_lang.blocks import Statement
from mlmg_lang.ide.hints import Going, Hint, Kind, Meanings, Outlook, goings, has_arguments, piece_hints
from mlmg_lang.ide.touching import pieces_touching
from mlmg_lang.source import Source, Span
from mlmg_lsp.convert import span_of
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import Encoding, position_from_offset
from mlmg_lsp.written import Json, Lined, Written, joined, lined


@dataclass(frozen=True, slots=True)
class _Hinted:
    """The hints of a piece, with places counted from its beginning.

    Attributes
    ----------
    meanings : what they depend on. uses : whether on definitions too.
    n_lines : how many lines end in the piece.
    """

    piece: Statement
    meanings: Meanings
    uses: bool
    going: Sequence[Going | None]
    kinds: frozenset[Kind]
    hints: Sequence[Hint]
    rows: Lined
    n_lines: int

    def is_still(self, meanings: Meanings, going: Sequence[Going | None], kinds: frozenset[Kind]) -> bool:
        """Return whether they would be the same now."""
        if self.meanings.catalog is not meanings.catalog or self.kinds != kinds or self.going != going:
            return False
        return not self.uses or self.meanings.definitions is meanings.definitions


def get_ahead(snapshot: Snapshot, outlook: Outlook | None = None, kinds: Collection[str] = tuple(Kind)) -> None:
    """Find out what takes long of a text the first time."""
    _hinted(snapshot, Span(0, len(snapshot.analysis.source.text)), outlook, frozenset(map(Kind, kinds)))


def inlay_hint(
    snapshot: Snapshot, params: types.InlayHintParams, outlook: Outlook | None, kinds: Collection[str]
) -> Written:
    """Return the hints in a stretch of a text.

    Parameters
    ----------
    outlook : how its commands will go, if that is known. kinds : those that are asked for, see `ide.hints.Kind`.
    """
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    within = span_of(source, params.range, encoding)
    return joined(_told(snapshot, within, _hinted(snapshot, within, outlook, frozenset(map(Kind, kinds)))))


def _hinted(snapshot: Snapshot, within: Span, outlook: Outlook | None, kinds: frozenset[Kind]) -> list[_Hinted]:
    """Return the hints of the pieces that a stretch touches; of others, what is known is kept."""
    analysis, kept = snapshot.analysis, snapshot.kept.get("hints", {})
    meanings = Meanings.of(analysis)
    found = []
    for piece, further in pieces_touching(analysis, within):
        start = piece.address + further
        going, known = goings(piece, start, outlook), kept.get(id(piece))
        if known is None or not known.is_still(meanings, going, kinds):
            text = analysis.source.text[start : start + piece.size]
            known = _of_piece(piece, text, meanings, going, kinds, snapshot.client.encoding)
        found.append(known)
    others = kept if len(kept) <= 2 * len(analysis.made.pieces) else {}
    snapshot.kept["hints"] = {**others, **{id(one.piece): one for one in found}}
    return found


def _of_piece(
    piece: Statement,
    text: str,
    meanings: Meanings,
    going: Sequence[Going | None],
    kinds: frozenset[Kind],
    encoding: Encoding,
) -> _Hinted:
    source = Source(text)
    found = piece_hints(piece, text, meanings, going, kinds)
    rows = lined([_row(source, one, encoding) for one in found])
    n_lines = len(source.line_starts) - 1
    return _Hinted(piece, meanings, has_arguments(piece), going, kinds, found, rows, n_lines)


def _told(snapshot: Snapshot, within: Span, found: Iterable[_Hinted]) -> Iterator[tuple[Lined, int]]:
    """Yield the hints of pieces that lie in a stretch, each with the line that its piece begins on."""
    source, starts = snapshot.analysis.source, pieces_touching(snapshot.analysis, within)
    line = -1
    for one, (piece, further) in zip(found, starts, strict=True):
        start = piece.address + further
        line = source.position(start)[0] - 1 if line < 0 else line
        if within.start <= start and start + piece.size <= within.end:
            yield one.rows, line
        else:
            inside = [hint for hint in one.hints if within.start <= hint.offset + start <= within.end]
            own = Source(source.text[start : start + piece.size])
            yield lined([_row(own, hint, snapshot.client.encoding) for hint in inside]), line
        line += one.n_lines


def _row(source: Source, one: Hint, encoding: Encoding) -> Json:
    kind = types.InlayHintKind.Parameter if one.kind is Kind.PARAMETERS else types.InlayHintKind.Type
    return {
        "position": position_from_offset(source, one.offset, encoding)._asdict(),
        "label": one.label,
        "kind": kind.value,
        **({"tooltip": one.explanation} if one.explanation else {}),
        "paddingLeft": not one.before,
        "paddingRight": one.before,
    }
