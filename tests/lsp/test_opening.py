"""Of a long text there are answers before all of it has been read, and none that is taken back later."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

URI = "untitled:long"
HERE = {"textDocument": {"uri": URI}}
PUSHED = {"textDocument": {"publishDiagnostics": {}}}
PULLED = {
    "textDocument": {"diagnostic": {"dynamicRegistration": False}},
    "workspace": {name: {"refreshSupport": True} for name in ("diagnostics", "semanticTokens", "codeLens")},
}
EARLY = ("diagnostic", "semanticTokens/full", "codeLens")
"""What a client is answered by a beginning that can be told to ask again."""
FIRST_LINES = {"start": {"line": 0, "character": 0}, "end": {"line": 5, "character": 0}}
LINES = (
    "WALK with Upper-Body TALK for 3 sec\n",
    "IDLE for 2 sec\n",
    "WLAK for 3 sec\n",
    "(WALK or\n    IDLE) for 1 sec\n",
)
LONG = "".join(LINES) * 300


def place(line: int) -> dict[str, Any]:
    return {**HERE, "position": {"line": line, "character": 2}}


def told_until(client, number: int) -> list[list[Any]]:
    """Return what has been told of the text, up to the answer to a request."""
    found = []
    while True:
        message = client.wait(lambda one: "method" not in one or one["method"] == "textDocument/publishDiagnostics")
        if message.get("id") == number:
            return found
        if message.get("method") is not None and message["params"]["uri"] == URI:
            found.append(message["params"]["diagnostics"])


def what(diagnostics: list[Any]) -> list[tuple[Any, ...]]:
    return [(one["code"], one["range"]["start"]["line"], one["message"]) for one in diagnostics]


@pytest.fixture(scope="module")
def pushed(start_for_all):
    """Return a client that is told of mistakes, of a server that is ready."""
    client = start_for_all()
    client.initialize(PUSHED)
    client.open("untitled:first", "WALK\n")
    client.diagnostics("untitled:first")
    return client


@pytest.fixture
def client(pushed):
    yield pushed
    pushed.close_text(URI)


def test_mistakes_are_told_ever_further_and_none_is_taken_back(client):
    client.open(URI, LONG)
    told = told_until(client, client.begin("textDocument/documentSymbol", HERE))
    told.append(client.diagnostics(URI) if not told or len(told[-1]) < 200 else told[-1])
    assert len(told) > 2
    assert 0 < len(told[0]) < 100
    for before, after in pairwise(told):
        assert what(before) == what(after)[: len(before)]


def test_what_is_asked_of_the_first_lines_is_answered_before_what_is_asked_of_all(client):
    client.open(URI, LONG)
    order = [
        client.begin("textDocument/documentSymbol", HERE),
        client.begin("textDocument/hover", place(1400)),
        client.begin("textDocument/hover", place(1)),
        client.begin("textDocument/completion", place(5)),
        client.begin("textDocument/semanticTokens/range", {**HERE, "range": FIRST_LINES}),
    ]
    answered = [client.wait(lambda one: one.get("id") in order) for _ in order]
    assert all(one["result"] for one in answered)
    assert {one["id"] for one in answered[:3]} == set(order[2:])


def test_what_changes_all_is_answered_of_all(client):
    client.open(URI, "let B = WALK or TALK\n" + "B for 1 sec\n" * 800)
    at = {"line": 0, "character": 4}
    context = {"diagnostics": [], "only": ["refactor.inline"]}
    actions = client.ask("textDocument/codeAction", {**HERE, "range": {"start": at, "end": at}, "context": context})
    edits = [one for action in actions for change in action["edit"]["changes"].values() for one in change]
    assert len(edits) > 800


def test_after_an_edit_that_moves_all_lines_nothing_is_told_that_is_taken_back(client):
    client.open(URI, "(WALK or\n    TALK or\n    IDLE or\n    Idle_01) for 1 sec\n" * 300)
    assert client.diagnostics(URI, 1) == []
    start = {"line": 0, "character": 0}
    client.edit(URI, 2, {"range": {"start": start, "end": start}, "text": "\n"})
    told = told_until(client, client.begin("textDocument/documentSymbol", HERE))
    assert not any(told)


@pytest.mark.parametrize("last", ["let wlak = WALK\n", "let WLAK = WALK\n"])
def test_of_a_text_that_may_define_at_its_end_what_it_uses_nothing_is_told_before(client, last):
    client.open(URI, LONG + last)
    told = told_until(client, client.begin("textDocument/documentSymbol", HERE)) or [client.diagnostics(URI)]
    assert len(told) == 1


def test_after_edits_while_it_is_read_all_is_known_as_if_there_had_been_none(client):
    lines = LONG.splitlines(keepends=True)
    client.open(URI, LONG)
    client.diagnostics(URI, 1)
    for version, (line, new) in enumerate([(0, "WALK for\n"), (1200, "WLAK\n"), (3, ""), (10, "IDLE\n" * 400)], 2):
        ends = ({"line": line, "character": 0}, {"line": line + 1, "character": 0})
        client.edit(URI, version, {"range": dict(zip(("start", "end"), ends, strict=True)), "text": new})
        lines[line : line + 1] = new.splitlines(keepends=True)
        if version % 2:
            client.diagnostics(URI, version)
    symbols = client.ask("textDocument/documentSymbol", HERE)
    tokens = client.ask("textDocument/semanticTokens/full", HERE)
    client.forget()
    client.edit(
        URI, 6, {"range": {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}}, "text": ""}
    )
    told = client.diagnostics(URI, 6)
    client.close_text(URI)
    client.open(URI, "".join(lines))
    assert client.ask("textDocument/documentSymbol", HERE) == symbols
    assert client.ask("textDocument/semanticTokens/full", HERE)["data"] == tokens["data"]
    client.forget()
    client.edit(
        URI, 2, {"range": {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}}, "text": ""}
    )
    assert client.diagnostics(URI, 2) == told


def test_after_an_edit_what_has_been_read_is_not_read_again_before_there_are_answers(client):
    client.open(URI, LONG)
    client.diagnostics(URI, 1)
    start = {"line": 0, "character": 0}
    client.edit(URI, 2, {"range": {"start": start, "end": start}, "text": "Talk_01 once\n"})
    hovered = client.ask("textDocument/hover", place(0))
    assert "Talk_01" in hovered["contents"]["value"]
    first = client.diagnostics(URI, 2)
    assert [one["range"]["start"]["line"] for one in first[:2]] == [3, 8]
    assert len(first) < 200


def early(client) -> tuple[list[Any], list[Any]]:
    """Return what is answered of a long text at once, in their order, and whatever else was answered before."""
    client.open(URI, LONG)
    whole = client.begin("textDocument/documentSymbol", HERE)
    asked = [client.begin(f"textDocument/{name}", HERE) for name in EARLY]
    answered = [client.wait(lambda one: one.get("id") in (whole, *asked) and "method" not in one) for _ in range(4)]
    found = {one["id"]: one["result"] for one in answered}
    return [found[number] for number in asked], [one["id"] for one in answered[: [*found].index(whole)]]


def test_a_client_that_can_be_told_to_ask_again_is_answered_early(start):
    client = start()
    client.initialize(PULLED)
    client.open("untitled:first", "WALK\n")
    client.ask("textDocument/diagnostic", {"textDocument": {"uri": "untitled:first"}})
    (told, tokens, lenses), before = early(client)
    assert len(before) == len(EARLY)
    assert 0 < len(told["items"]) < 100
    assert "resultId" not in told
    for name in ("diagnostic", "semanticTokens", "codeLens"):
        client.wait_for(f"workspace/{name}/refresh")
    again, delta, more = (
        client.ask("textDocument/diagnostic", HERE),
        client.ask("textDocument/semanticTokens/full/delta", {**HERE, "previousResultId": tokens["resultId"]}),
        client.ask("textDocument/codeLens", HERE),
    )
    assert what(told["items"]) == what(again["items"])[: len(told["items"])]
    assert len(again["items"]) > 200
    assert again["resultId"]
    assert len(delta["data"]) > 10 * len(tokens["data"])
    assert tokens["data"] == delta["data"][: len(tokens["data"])]
    assert len(more) > 5 * len(lenses) > 100
    assert client.leave() == 0


def test_a_client_that_cannot_be_told_to_ask_again_is_answered_of_all(client):
    (_, tokens, lenses), _ = early(client)
    assert tokens["data"] == client.ask("textDocument/semanticTokens/full", HERE)["data"]
    assert lenses == client.ask("textDocument/codeLens", HERE)
