"""textDocument/codeLens: what can be done with a script and with each of its commands, shown above them."""

from __future__ import annotations

from typing import Any

from lsprotocol import types

from mlmg_lang.ide import lenses
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.positions import position_from_offset


def code_lens(snapshot: Snapshot, _params: types.CodeLensParams) -> list[types.CodeLens]:
    """Return what can be done; where it is done by `execute_command`."""
    return [_lens(snapshot, one) for one in lenses.lenses(snapshot.analysis)]


def _lens(snapshot: Snapshot, one: lenses.Lens) -> types.CodeLens:
    at = types.Position(*position_from_offset(snapshot.analysis.source, one.span.start, snapshot.client.encoding))
    about: dict[str, Any] = {"uri": snapshot.uri}
    if one.about is not None:
        about["position"] = {"line": at.line, "character": at.character}
    # A lens is shown above a line: where the command ends, which may be lines further on, makes no difference.
    return types.CodeLens(
        types.Range(at, at), types.Command(one.title, command=f"mlmg.{one.deed.value}", arguments=[about])
    )
