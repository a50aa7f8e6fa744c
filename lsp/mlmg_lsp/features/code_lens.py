"""textDocument/codeLens: what can be done with a script and with each of its commands, shown above them.

What is found for a piece is kept from one answer to the next, until it plays something else.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate, pairwise
from operator import attrgetter
from typing import TYPE_CHECKING

from lsprotocol import types

from mlmg_lang.blocks import Statement
from mlmg_lang.ide import lenses
from mlmg_lang.source import Source
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import position_from_offset
from mlmg_lsp.written import NO_ANSWER, Json, Lined, Written, joined, lined, written

if TYPE_CHECKING:
    from mlmg_lang.planning.resolve_again import Played


@dataclass(frozen=True, slots=True)
class _Offered:
    """The lenses of a piece, by what it plays; `n_lines`: how many lines end in it."""

    piece: Statement
    played: Played
    rows: Lined
    n_lines: int


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    _parts(snapshot)


def code_lens(snapshot: Snapshot, _params: types.CodeLensParams) -> Written:
    """Return what can be done; where it is done by `execute_command`."""
    parts = _parts(snapshot)
    rows = list(map(attrgetter("rows"), parts))
    if all(one is NO_ANSWER for one in rows):
        return written([])
    top = lined([_lens(snapshot.uri, one, {"line": 0, "character": 0}) for one in lenses.of_script()])
    lines = accumulate(map(attrgetter("n_lines"), parts), initial=0)
    return joined(((top, 0), *zip(rows, lines, strict=False)))


def _parts(snapshot: Snapshot) -> list[_Offered]:
    kept = {(id(one.piece), id(one.played)): one for one in snapshot.kept.get("lenses", ())}
    made = snapshot.analysis.ready
    pieces = zip(made.pieces, made.played, pairwise(made.places.starts), strict=False)  # without a library, none plays
    parts = [
        kept.get((id(piece), id(played))) or _offered(snapshot, piece, played, made.source.text[slice(*at)])
        for piece, played, at in pieces
    ]
    snapshot.kept["lenses"] = parts
    return parts


def _offered(snapshot: Snapshot, piece: Statement, played: Played, text: str) -> _Offered:
    source, encoding = Source(text), snapshot.client.encoding
    found = lenses.piece_lenses(piece, played.statements)
    places = (position_from_offset(source, one.span.start, encoding) for one in found)
    rows = lined([_lens(snapshot.uri, one, at._asdict()) for one, at in zip(found, places, strict=True)])
    return _Offered(piece, played, rows, len(source.line_starts) - 1)


def _lens(uri: str, one: lenses.Lens, at: Json) -> Json:
    about: Json = {"uri": uri} if one.about is None else {"uri": uri, "position": at}
    command: Json = {"title": one.title, "command": f"mlmg.{one.deed.value}", "arguments": [about]}
    # A lens is shown above a line: where the command ends, which may be lines further on, makes no difference.
    return {"range": {"start": at, "end": at}, "command": command}
