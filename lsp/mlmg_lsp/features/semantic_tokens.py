"""textDocument/semanticTokens: full, delta and range.

Pieces begin at the beginning of a line, so that the numbers of one are the same wherever it stands, but for how many
lines its first token is behind the last one before. They are kept from one answer to the next.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from uuid import uuid4

from lsprotocol import types

from mlmg_lang.common_ends import common_ends
from mlmg_lang.ide import semantics
from mlmg_lang.source import Source
from mlmg_lsp.convert import span_of
from mlmg_lsp.features.legend import DECLARATION, TOKEN_TYPES
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import EditorPosition, Encoding, units_in
from mlmg_lsp.written import Json, Written, written

_TYPES = {kind: TOKEN_TYPES.index(kind.value) for kind in semantics.Kind}


@dataclass(frozen=True, slots=True)
class _Numbers:
    """The tokens of a piece, five numbers each.

    Attributes
    ----------
    last : the line of the last token. n_lines : how many lines end in the piece.
    """

    part: semantics.Painted
    numbers: tuple[int, ...]
    last: int
    n_lines: int


@dataclass(frozen=True, slots=True)
class _Sent:
    """What the client has, by the name that it knows it by."""

    result: str
    data: list[int]


def get_ahead(snapshot: Snapshot) -> None:
    """Find out what takes long of a text the first time."""
    _parts(snapshot)


def full(snapshot: Snapshot, _params: types.SemanticTokensParams) -> Written:
    """Return what each word of a script is."""
    sent = _now(snapshot)
    return written({"resultId": sent.result, "data": sent.data})


def delta(snapshot: Snapshot, params: types.SemanticTokensDeltaParams) -> Written:
    """Return what has changed of that since it was asked last; all, if that was another answer than the client has."""
    before = snapshot.kept.get("sent tokens")
    sent = _now(snapshot)
    if not isinstance(before, _Sent) or before.result != params.previous_result_id:
        return written({"resultId": sent.result, "data": sent.data})
    start, n_gone, new = edit_between(before.data, sent.data)
    edit: Json = {"start": start, "deleteCount": n_gone, "data": new}
    return written({"resultId": sent.result, "edits": [edit] if n_gone or new else []})


def within(snapshot: Snapshot, params: types.SemanticTokensRangeParams) -> Written:
    """Return what each word in a stretch of a script is."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    marks = _painting(snapshot).within(span_of(source, params.range, encoding))
    return written({"data": list(_encoded(source, marks, encoding))})


def _now(snapshot: Snapshot) -> _Sent:
    """Return the tokens of a text under a name that no other answer has."""
    sent = _Sent(uuid4().hex, _joined(_parts(snapshot)))
    snapshot.kept["sent tokens"] = sent
    return sent


def _parts(snapshot: Snapshot) -> list[_Numbers]:
    kept = {id(one.part): one for one in snapshot.kept.get("token numbers", ())}
    encoding = snapshot.client.encoding
    numbers = [kept.get(id(part)) or _numbers(part, encoding) for part in _painting(snapshot).parts]
    snapshot.kept["token numbers"] = numbers
    return numbers


def _painting(snapshot: Snapshot) -> semantics.Painting:
    """Return the marks of a text; what an edit has left alone is taken from the last."""
    painting = semantics.paint(snapshot.analysis, snapshot.kept.get("painting"))
    snapshot.kept["painting"] = painting
    return painting


def _numbers(part: semantics.Painted, encoding: Encoding) -> _Numbers:
    source = Source(part.text)
    numbers = tuple(_encoded(source, part.marks, encoding))
    return _Numbers(part, numbers, sum(numbers[::5]), len(source.line_starts) - 1)


def _joined(parts: Iterable[_Numbers]) -> list[int]:
    """Return the numbers of pieces one after the other."""
    data: list[int] = []
    gap = 0
    for part in parts:
        if part.numbers:
            at = len(data)
            data += part.numbers
            data[at] += gap
            gap = -part.last
        gap += part.n_lines
    return data


def _encoded(source: Source, marks: Iterable[semantics.Mark], encoding: Encoding) -> Iterator[int]:
    """Yield five numbers for each mark, counted from the one before it, as the protocol has it."""
    starts, before = source.line_starts, EditorPosition(0, 0)
    plain = source.text.isascii()
    for mark in marks:
        line = bisect_right(starts, mark.span.start) - 1
        lead, word = source.text[starts[line] : mark.span.start], source.text[mark.span.start : mark.span.end]
        character = len(lead) if plain else units_in(lead, encoding)
        yield line - before.line
        yield character - before.character if line == before.line else character
        yield len(word) if plain else units_in(word, encoding)
        yield _TYPES[mark.kind]
        yield DECLARATION if mark.declaration else 0
        before = EditorPosition(line, character)


def edit_between(before: Sequence[int], after: Sequence[int]) -> tuple[int, int, Sequence[int]]:
    """Return the smallest stretch that makes other numbers of some: where it begins, how many go, and which come."""
    head, tail = common_ends(before, after)
    return head, len(before) - head - tail, after[head : len(after) - tail]
