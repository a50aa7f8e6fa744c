"""textDocument/codeLens: what can be done with a script and with each of its commands, shown above them."""

from __future__ import annotations

from lsprotocol import types

from mlmg_lang.ide import lenses
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.memory import undisturbed
from mlmg_lsp.positions import position_from_offset
from mlmg_lsp.written import Json, Written, written


def code_lens(snapshot: Snapshot, _params: types.CodeLensParams) -> Written:
    """Return what can be done; where it is done by `execute_command`."""
    with undisturbed():
        return written([_lens(snapshot, one) for one in lenses.lenses(snapshot.analysis)])


def _lens(snapshot: Snapshot, one: lenses.Lens) -> Json:
    line, character = position_from_offset(snapshot.analysis.source, one.span.start, snapshot.client.encoding)
    at: Json = {"line": line, "character": character}
    about: Json = {"uri": snapshot.uri} if one.about is None else {"uri": snapshot.uri, "position": at}
    command: Json = {"title": one.title, "command": f"mlmg.{one.deed.value}", "arguments": [about]}
    # A lens is shown above a line: where the command ends, which may be lines further on, makes no difference.
    return {"range": {"start": at, "end": at}, "command": command}
