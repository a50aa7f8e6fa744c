"""textDocument/inlayHint: what is taken, when it arrives, and what is meant by what is written."""

from __future__ import annotations

from collections.abc import Collection

from lsprotocol import types

from mlmg_lang.ide.hints import Hint, Kind, Outlook, hints
from mlmg_lang.source import Source
from mlmg_lsp.convert import span_of
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.positions import Encoding, position_from_offset


def inlay_hint(
    snapshot: Snapshot, params: types.InlayHintParams, outlook: Outlook | None, kinds: Collection[str]
) -> list[types.InlayHint]:
    """Return the hints in a stretch of a text.

    Parameters
    ----------
    outlook : how its commands will go, if that is known. kinds : those that are asked for, see `ide.hints.Kind`.
    """
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    wanted = frozenset(map(Kind, kinds))
    found = hints(snapshot.analysis, span_of(source, params.range, encoding), outlook, wanted)
    return [_hint(source, one, encoding) for one in found]


def _hint(source: Source, one: Hint, encoding: Encoding) -> types.InlayHint:
    return types.InlayHint(
        types.Position(*position_from_offset(source, one.offset, encoding)),
        one.label,
        kind=types.InlayHintKind.Parameter if one.kind is Kind.PARAMETERS else types.InlayHintKind.Type,
        tooltip=one.explanation or None,
        padding_left=not one.before,
        padding_right=one.before,
    )
