"""What each word of a text is, in numbers, and what has changed of them since they were asked last."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from mlmg_lang.ide.semantics import paint
from mlmg_lsp.features.legend import TOKEN_TYPES
from mlmg_lsp.features.semantic_tokens import delta, edit_between, full, within
from mlmg_lsp.open_text import Snapshot

TEXT = types.TextDocumentIdentifier("untitled:x")
ALL = types.SemanticTokensParams(TEXT)


def since(result: str) -> types.SemanticTokensDeltaParams:
    return types.SemanticTokensDeltaParams(TEXT, result)


def applied(data: list[int], edits: list[dict[str, object]]) -> list[int]:
    """Return numbers after edits, as a client applies them: from the last to the first."""
    for edit in reversed(edits):
        start, n_gone = int(str(edit["start"])), int(str(edit["deleteCount"]))
        data = [*data[:start], *edit["data"], *data[start + n_gone :]]  # type: ignore[misc]
    return data


def plainly(snapshot: Snapshot, position: Callable[..., dict[str, int]]) -> Iterator[int]:
    """Yield the numbers of a text in the plainest way: word after word from its beginning."""
    text, encoding = snapshot.analysis.source.text, snapshot.client.encoding
    line = character = 0
    for mark in paint(snapshot.analysis).marks():
        at = position(text, mark.span.start, encoding)
        own = text[mark.span.start : mark.span.end]
        yield at["line"] - line
        yield at["character"] - (character if at["line"] == line else 0)
        yield position(own.replace("\r", " ").replace("\n", " "), len(own), encoding)["character"]
        yield TOKEN_TYPES.index(mark.kind.value)
        yield int(mark.declaration)
        line, character = at["line"], at["character"]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_after_any_edits_a_client_that_asks_for_what_has_changed_has_what_a_fresh_server_would_tell(
    snapshots, afresh, position, encoding
):
    has: list[int] = []
    result = ""
    for snapshot in snapshots(encoding, 40):
        answer = json.loads((delta(snapshot, since(result)) if result else full(snapshot, ALL)).text)
        has = answer["data"] if "data" in answer else applied(has, answer["edits"])
        result = answer["resultId"]
        assert has == list(plainly(afresh(snapshot), position)), snapshot.analysis.source.text


def test_what_has_changed_is_little_after_an_edit_and_nothing_without_one(snapshots):
    first = next(snapshots("utf-16", 1))
    result = json.loads(full(first, ALL).text)["resultId"]
    answer = json.loads(delta(first, since(result)).text)
    assert answer["edits"] == []
    assert answer["resultId"] != result


def test_who_has_another_answer_than_the_last_is_told_all(snapshots):
    snapshot = next(snapshots("utf-16", 1))
    old = json.loads(full(snapshot, ALL).text)
    json.loads(full(snapshot, ALL).text)
    assert json.loads(delta(snapshot, since(old["resultId"])).text)["data"] == old["data"]


def test_of_a_stretch_the_same_is_told_as_of_all(snapshots):
    for snapshot in snapshots("utf-16", 20):
        data = json.loads(full(snapshot, ALL).text)["data"]
        n_lines = len(snapshot.analysis.source.line_starts)
        place = types.Range(types.Position(0, 0), types.Position(n_lines, 0))
        assert json.loads(within(snapshot, types.SemanticTokensRangeParams(TEXT, place)).text)["data"] == data


@given(st.lists(st.integers(0, 2)), st.lists(st.integers(0, 2)))
def test_the_stretch_that_changes_is_the_smallest(before, after):
    start, n_gone, new = edit_between(before, after)
    assert applied(before, [{"start": start, "deleteCount": n_gone, "data": new}]) == after
    assert before[:start] == after[:start]
    if n_gone and new:
        assert before[start] != after[start]
        assert before[start + n_gone - 1] != new[-1]
